import type { Num } from "./contract.js";

/** A number with so many significant digits, without trailing zeros. */
export function shown(value: Num | undefined, digits = 6): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${withoutZeros(mantissa)}e${Number(exponent)}`.replace("-", "−").replace("e-", "e−");
  }
  const text = value.toPrecision(digits); // with an exponent if there are more digits before the point
  return withoutZeros(text.includes("e") ? String(Number(text)) : text).replace("-", "−");
}

export function withoutZeros(text: string): string {
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

export function withUnit(value: Num | undefined, unit: string, digits = 6): string {
  return unit && unit !== "1" ? `${shown(value, digits)} ${unit}` : shown(value, digits);
}

/** What is given in this unit, as at an axis and over a column. */
export function perUnit(name: string, unit: string): string {
  return unit && unit !== "1" ? `${name} / ${unit}` : name;
}

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** An exponent, such as "-3", in raised letters. */
export function raised(text: string): string {
  return [...text].map((letter) => (letter === "-" ? "⁻" : superscripts[Number(letter)])).join("");
}

const lowered = "₀₁₂₃₄₅₆₇₈₉";

/** A name such as x3 with its number as an index; others unchanged. */
export function symbolOf(name: string): string {
  const parts = /^([A-Za-z])_?(\d{1,2})$/.exec(name);
  return parts ? parts[1] + [...parts[2]].map((digit) => lowered[Number(digit)]).join("") : name;
}

/** The digits that tell apart numbers this far from each other. */
export function decimalsFor(step: number): number {
  return Math.max(0, Math.min(15, -Math.floor(Math.log10(step) + 1e-9)));
}
