import type { Axis } from "./contract.js";
import { perUnit, raised, symbolOf } from "./numbers.js";

/** The title of an axis: its words, its name, and its unit; without words if it has more letters than there is room for. */
export function axisTitle(axis: Axis, room = Infinity): string {
  const full = fullTitle(axis);
  return full.length > room && axis.words && axis.label ? fullTitle({ ...axis, words: "" }) : full;
}

function fullTitle(axis: Axis): string {
  const name = withSymbols(axis.label ?? "");
  // A long name says what the words say; a short one is the symbol in equations.
  const both = axis.words && axis.label && axis.label.length <= 4 && axis.words !== axis.label;
  const words = withSymbols(axis.words ?? "");
  const text = both ? `${words} ${name}` : words || name;
  return perUnit(text, unitText(axis.unit));
}

/** Names such as x3 within a text with their numbers as indices. */
function withSymbols(text: string): string {
  return text.replace(/\b[A-Za-z]_?\d{1,2}\b/g, symbolOf);
}

function unitText(unit: string): string {
  return unit.replace(/\^(-?\d+)/g, (_, exponent: string) => raised(exponent));
}
