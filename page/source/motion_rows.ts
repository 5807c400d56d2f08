import type { Motion, Num, Panel, Series } from "./contract.js";

/** The arc to which a row belongs: `begins` has the first rows of all arcs but perhaps the first one. */
export function arcOf(motion: Motion, row: number): number {
  let arc = 0;
  for (const first of motion.begins) if (first > 0 && first <= row) ++arc;
  return arc;
}

export function columnIndex(motion: Motion, name: string): number {
  return motion.columns.findIndex((column) => column.name === name);
}

/** A line through the rows, interrupted where an arc begins and where a phase begins its next period. */
function lineOf(motion: Motion, x: number, y: number, colour: number): Series {
  const begins = new Set(motion.begins);
  const xs: (number | null)[] = [],
    ys: (number | null)[] = [];
  const wraps = (column: number, row: number) => {
    const period = motion.columns[column].period,
      values = motion.values[column];
    return (
      period !== null && period !== undefined && Math.abs((values[row] ?? 0) - (values[row - 1] ?? 0)) > period / 2
    );
  };
  const rows = motion.values[0].length;
  for (let row = 0; row < rows; ++row) {
    if (row > 0 && (begins.has(row) || wraps(x, row) || wraps(y, row))) {
      xs.push(null);
      ys.push(null);
    }
    xs.push(motion.values[x][row]);
    ys.push(motion.values[y][row]);
  }
  return { title: "", style: "line", colour, x: xs, y: ys };
}

function contactsOf(motion: Motion, x: number, y: number): Series {
  const at = (column: number) => motion.contacts.map((row) => motion.values[column][row] ?? null);
  return { title: "contacts", style: "circles", colour: 1, x: at(x), y: at(y) };
}

function restOf(motion: Motion, x: number, y: number): Series {
  return { title: "equilibrium", style: "symbols", symbol: 7, colour: 0, x: motion.values[x], y: motion.values[y] };
}

/** A panel of one column over another one, with the contacts marked. */
export function motionPanel(motion: Motion, x: number, y: number): Panel {
  const axis = (column: number) => ({
    label: motion.columns[column].name,
    unit: motion.columns[column].unit,
    words: motion.columns[column].name === "t" ? "time" : (motion.columns[column].words ?? ""),
    logarithmic: false,
    range: null,
  });
  return {
    title: "",
    x: axis(x),
    y: axis(y),
    marks: [],
    marks_title: "",
    notes: [],
    labels: [],
    series: motion.at_rest ? [restOf(motion, x, y)] : [lineOf(motion, x, y, 0), contactsOf(motion, x, y)],
  };
}

/** The values of all columns at a time, between rows of the same arc linearly; and the row before. */
export function valuesAt(motion: Motion, time: number): { row: number; values: number[] } {
  const times = motion.values[0];
  let low = 0,
    high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((times[middle] ?? 0) <= time) low = middle;
    else high = middle - 1;
  }
  const next = Math.min(low + 1, times.length - 1),
    t0 = times[low] ?? 0,
    t1 = times[next] ?? t0;
  const part = t1 > t0 && !motion.begins.includes(next) ? Math.max(0, Math.min(1, (time - t0) / (t1 - t0))) : 0;
  const values = motion.values.map((column, index) => {
    const one = column[low] ?? NaN,
      other = column[next] ?? NaN,
      period = motion.columns[index].period;
    if (period && Math.abs(other - one) > period / 2) return one; // the phase begins again
    return one + part * (other - one);
  });
  return { row: low, values };
}

/** How often a value rises through its mean: about the number of cycles of a motion. */
export function cyclesOf(values: Num[]): number {
  const known = values.filter((value): value is number => value !== null);
  const mean = known.reduce((sum, value) => sum + value, 0) / Math.max(1, known.length);
  let count = 0;
  for (let i = 1; i < known.length; ++i) if (known[i - 1] < mean && known[i] >= mean) ++count;
  return count;
}

/** Whether two columns are on a straight line, but for noise that nobody sees. */
export function areProportional(one: Num[], other: Num[]): boolean {
  const pairs: [number, number][] = [];
  for (let i = 0; i < one.length; ++i) {
    const a = one[i],
      b = other[i];
    if (a !== null && a !== undefined && b !== null && b !== undefined) pairs.push([a, b]);
  }
  const mean = (of: (pair: [number, number]) => number) =>
    pairs.reduce((sum, pair) => sum + of(pair), 0) / Math.max(1, pairs.length);
  const a0 = mean(([a]) => a),
    b0 = mean(([, b]) => b);
  const aa = mean(([a]) => (a - a0) ** 2),
    bb = mean(([, b]) => (b - b0) ** 2),
    ab = mean(([a, b]) => (a - a0) * (b - b0));
  return aa > 0 && bb > 0 && ab * ab > (1 - 1e-6) * aa * bb;
}

/** The columns that are no constants, the time left out. */
export function movingColumns(motion: Motion): number[] {
  const moving = motion.columns
    .map((_, index) => index)
    .slice(1)
    .filter((index) => {
      const values = motion.values[index],
        first = values[0] ?? 0;
      return values.some((value) => Math.abs((value ?? 0) - first) > 1e-12 * (1 + Math.abs(first)));
    });
  return moving.length > 0 ? moving : motion.columns.map((_, index) => index).slice(1);
}
