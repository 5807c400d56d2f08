/** What a slider is for, which decides about its range. */
export interface Slid {
  kind: "parameter" | "state" | "duration";
  period?: number | null; // of a cyclic state
}

const share = 0.5; // of a value to both sides of it

/** A range that shows what is near a value, or all that it usually can be. */
export function rangeAround(value: number, { kind, period }: Slid): [number, number] {
  if (period) return [Math.min(0, value), Math.max(period, value)];
  if (kind === "duration") return [0.02 * value, 2 * value];
  if (value === 0) return [-1, 1];
  if (kind === "state") return [value - Math.max(1, Math.abs(value)), value + Math.max(1, Math.abs(value))];
  if (value > 0.2 && value < 1) return [0, 1]; // a share of something, perhaps
  return [value - share * Math.abs(value), value + share * Math.abs(value)];
}

/** Whether a slider has reached an end of its range, so that it needs another one. */
export function isAtEnd(value: number, [least, greatest]: [number, number]): boolean {
  const slack = 0.005 * (greatest - least);
  return value <= least + slack || value >= greatest - slack;
}
