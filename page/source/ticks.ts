import { decimalsFor, raised, withoutZeros } from "./numbers.js";

export interface Ticks {
  values: number[];
  texts: string[];
}

/** A round number near this one: 1, 2 or 5 times a power of ten. */
function roundStep(rough: number): number {
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const part = rough / power;
  return (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10) * power;
}

function linearTicks(low: number, high: number, wanted: number): Ticks {
  const step = roundStep((high - low) / Math.max(1, wanted));
  const values: number[] = [];
  const first = Math.ceil(low / step - 1e-9),
    last = Math.floor(high / step + 1e-9);
  for (let i = first; i <= last && values.length < 100; ++i) values.push(i * step);
  return { values, texts: textsOf(values, step) };
}

function textsOf(values: number[], step: number): string[] {
  const greatest = Math.max(...values.map(Math.abs), step);
  if (greatest >= 1e5 || greatest < 1e-3) {
    const digits = Math.max(0, Math.round(Math.log10(greatest / step)));
    return values.map((value) => (value === 0 ? "0" : powerText(value, digits)));
  }
  const decimals = decimalsFor(step);
  return values.map((value) => value.toFixed(decimals).replace("-", "−"));
}

function powerText(value: number, digits: number): string {
  const [mantissa, exponent] = value.toExponential(Math.min(digits, 8)).split("e");
  return `${withoutZeros(mantissa).replace("-", "−")}·10${raised(String(Number(exponent)))}`;
}

function logarithmicTicks(low: number, high: number, wanted: number): Ticks {
  const decades = Math.log10(high / low);
  if (decades < 1) return linearTicks(low, high, wanted);
  const stride = Math.max(1, Math.round(decades / Math.max(1, wanted)));
  const parts = decades < wanted / 3 ? [1, 2, 5] : [1];
  const values: number[] = [],
    texts: string[] = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high) + 1; ++power)
    for (const part of parts) {
      const value = part * Math.pow(10, power);
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9) || power % stride !== 0) continue;
      values.push(value);
      const plain = power >= -3 && power <= 4;
      texts.push(
        plain ? String(Number(value.toPrecision(3))) : part === 1 ? `10${raised(String(power))}` : powerText(value, 0),
      );
    }
  return { values, texts };
}

/** Round numbers along an axis, about as many as wanted. */
export function ticksOf(low: number, high: number, logarithmic: boolean, wanted: number): Ticks {
  if (!(high > low)) return { values: [low], texts: [String(low)] };
  return logarithmic && low > 0 ? logarithmicTicks(low, high, wanted) : linearTicks(low, high, wanted);
}
