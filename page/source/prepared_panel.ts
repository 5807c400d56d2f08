import type { Axis, Label, Num, Panel, Series } from "./contract.js";
import type { Range, View } from "./frame.js";
import { smoothed, type DrawnLine } from "./smoothing.js";

/** A series in arrays of numbers, in which NaN stands for null. */
export interface PreparedSeries {
  series: Series;
  x: Float64Array;
  y: Float64Array;
  order: 1 | -1 | 0; // x rises, falls, or neither
  line: DrawnLine; // the same points, and those that make a line smooth; in the same order
}

/** The styles of lines, with their dashes. */
export const lineDashes: Record<string, number[]> = { line: [], dashed: [6, 3.5], dotted: [1.6, 2.6] };

/** A panel as it is drawn, searched and exported. */
export class PreparedPanel {
  readonly drawn: PreparedSeries[];
  readonly labels: Label[];

  constructor(
    readonly panel: Panel,
    readonly logarithmicX: boolean,
    readonly logarithmicY: boolean,
  ) {
    this.drawn = panel.series.filter((one) => !one.only_in_legend).map(prepared);
    this.labels = panel.labels;
  }

  get points(): number {
    return this.drawn.reduce((sum, one) => sum + one.x.length, 0);
  }

  /** The view that shows everything, or the ranges that the panel asks for. */
  wholeView(): View {
    const x = new Extent(this.logarithmicX),
      y = new Extent(this.logarithmicY);
    for (const one of this.drawn) {
      x.includeAll(one.x);
      y.includeAll(one.y);
      for (const [left, right, low, high] of one.series.cells ?? []) {
        x.include(left);
        x.include(right);
        y.include(low);
        y.include(high);
      }
      if (one.series.style === "impulses") y.include(0);
    }
    const cells = this.drawn.some((one) => one.series.style === "cells");
    // A logarithmic axis cannot show what is asked for if that has values that are not positive.
    const possible = ({ range }: Axis, logarithmic: boolean) => (range && logarithmic && range[0] <= 0 ? null : range);
    const xRange = possible(this.panel.x, this.logarithmicX),
      yRange = possible(this.panel.y, this.logarithmicY);
    return {
      x: xRange ? { low: xRange[0], high: xRange[1] } : x.range(cells ? 0 : 0.03),
      y: yRange ? { low: yRange[0], high: yRange[1] } : y.range(cells ? 0 : 0.07),
    };
  }
}

/** What a logarithmic axis does not show; empty: nothing. */
export function hiddenPoints(prepared: PreparedPanel): string {
  const tell = (axis: Axis, logarithmic: boolean, of: (one: PreparedSeries) => Float64Array) => {
    if (!logarithmic) return "";
    let hidden = 0,
      all = 0;
    for (const one of prepared.drawn)
      for (const value of of(one)) {
        if (Number.isFinite(value)) ++all;
        if (value <= 0) ++hidden;
      }
    const name = axis.label || axis.words;
    if (hidden === 0) return "";
    if (hidden === all) return `Nothing is shown: ${name} is nowhere positive, and its axis is logarithmic.`;
    return `${hidden} of ${all} points are not shown: there ${name} is not positive, and its axis is logarithmic.`;
  };
  const { panel, logarithmicX, logarithmicY } = prepared;
  return [tell(panel.x, logarithmicX, ({ x }) => x), tell(panel.y, logarithmicY, ({ y }) => y)]
    .filter((text) => text !== "")
    .join(" ");
}

function numbersOf(values: Num[]): Float64Array {
  const result = new Float64Array(values.length);
  for (let i = 0; i < values.length; ++i) {
    const value = values[i];
    result[i] = value === null || value === undefined ? NaN : value;
  }
  return result;
}

function prepared(series: Series): PreparedSeries {
  const x = numbersOf(series.x ?? []),
    y = numbersOf(series.y ?? []);
  let rises = true,
    falls = true;
  for (let i = 1; i < x.length && (rises || falls); ++i) {
    if (!(x[i] >= x[i - 1])) rises = false; // NaN is in no order
    if (!(x[i] <= x[i - 1])) falls = false;
  }
  const along = series.along && series.along.length === x.length ? numbersOf(series.along) : null;
  const line = along ? smoothed(x, y, along, series.corners ?? []) : { x, y };
  return { series, x, y, order: x.length < 2 ? 0 : rises ? 1 : falls ? -1 : 0, line };
}

class Extent {
  private least = Infinity;
  private greatest = -Infinity;

  constructor(private readonly logarithmic: boolean) {}

  include(value: number): void {
    if (!Number.isFinite(value) || (this.logarithmic && value <= 0)) return;
    if (value < this.least) this.least = value;
    if (value > this.greatest) this.greatest = value;
  }

  includeAll(values: Float64Array): void {
    for (let i = 0; i < values.length; ++i) this.include(values[i]);
  }

  range(margin: number): Range {
    if (this.least > this.greatest) return this.logarithmic ? { low: 0.1, high: 10 } : { low: 0, high: 1 };
    if (this.logarithmic) {
      const part = this.least === this.greatest ? 0.5 : Math.max(margin, 0.01) * Math.log10(this.greatest / this.least);
      return { low: this.least / Math.pow(10, part), high: this.greatest * Math.pow(10, part) };
    }
    const size = Math.max(Math.abs(this.least), Math.abs(this.greatest));
    const span = this.greatest - this.least;
    if (span <= 1e-12 * size || span === 0) {
      const half = size === 0 ? 1 : 0.1 * size; // a constant: the axis tells its size
      return { low: this.least - half, high: this.greatest + half };
    }
    return { low: this.least - margin * span, high: this.greatest + margin * span };
  }
}

/** The indices [first, last) between which x of an ordered series lies within the range; otherwise all. */
export function indicesWithin(one: Pick<PreparedSeries, "x" | "order">, range: Range): [number, number] {
  if (one.order === 0) return [0, one.x.length];
  const low = one.order > 0 ? range.low : range.high,
    high = one.order > 0 ? range.high : range.low;
  const before = (value: number, limit: number) => (one.order > 0 ? value < limit : value > limit);
  const after = (value: number, limit: number) => (one.order > 0 ? value > limit : value < limit);
  return [partition(one.x, (value) => before(value, low)), partition(one.x, (value) => !after(value, high))];
}

/** The same for a line, with the piece that enters the range, and the one that leaves it. */
export function piecesWithin(one: Pick<PreparedSeries, "x" | "order">, range: Range): [number, number] {
  const [first, last] = indicesWithin(one, range);
  return [Math.max(0, first - 1), Math.min(one.x.length, last + 1)];
}

/** The number of leading values for which the condition holds. */
function partition(values: Float64Array, holds: (value: number) => boolean): number {
  let low = 0,
    high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(values[middle])) low = middle + 1;
    else high = middle;
  }
  return low;
}
