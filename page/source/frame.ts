/** Where a panel lies on the canvas, and which part of the plane it shows. */
export interface Range {
  low: number;
  high: number;
}

export interface View {
  x: Range;
  y: Range;
}

export class Frame {
  private readonly ax: number;
  private readonly bx: number;
  private readonly ay: number;
  private readonly by: number;

  constructor(
    readonly left: number,
    readonly top: number,
    readonly width: number,
    readonly height: number,
    readonly view: View,
    readonly logarithmicX: boolean,
    readonly logarithmicY: boolean,
  ) {
    const along = (value: number, logarithmic: boolean) => (logarithmic ? Math.log10(value) : value);
    const x0 = along(view.x.low, logarithmicX),
      x1 = along(view.x.high, logarithmicX);
    const y0 = along(view.y.low, logarithmicY),
      y1 = along(view.y.high, logarithmicY);
    this.bx = width / (x1 - x0);
    this.ax = left - this.bx * x0;
    this.by = -height / (y1 - y0);
    this.ay = top + height - this.by * y0;
  }

  x(value: number): number {
    return this.ax + this.bx * (this.logarithmicX ? Math.log10(value) : value);
  }

  y(value: number): number {
    return this.ay + this.by * (this.logarithmicY ? Math.log10(value) : value);
  }

  has(x: number, y: number, margin = 0): boolean {
    return (
      x >= this.left - margin &&
      x <= this.left + this.width + margin &&
      y >= this.top - margin &&
      y <= this.top + this.height + margin
    );
  }
}

/** The range after its ends moved: `part` of the way along the axis is where `factor` leaves values in place. */
export function scaled(range: Range, factor: number, part: number, logarithmic: boolean): Range {
  const [low, high] = logarithmic ? [Math.log10(range.low), Math.log10(range.high)] : [range.low, range.high];
  const fixed = low + part * (high - low);
  return bounded(fixed + (low - fixed) * factor, fixed + (high - fixed) * factor, logarithmic, range);
}

export function shifted(range: Range, part: number, logarithmic: boolean): Range {
  const [low, high] = logarithmic ? [Math.log10(range.low), Math.log10(range.high)] : [range.low, range.high];
  const shift = part * (high - low);
  return bounded(low + shift, high + shift, logarithmic, range);
}

/** Refuses ranges in which neighbouring numbers can no longer be told apart. */
function bounded(low: number, high: number, logarithmic: boolean, before: Range): Range {
  const size = Math.max(Math.abs(low), Math.abs(high), Number.MIN_VALUE);
  if (!Number.isFinite(low) || !Number.isFinite(high) || high - low < 1e-13 * size || size > 1e300) return before;
  if (!logarithmic) return { low, high };
  return low < -300 || high > 300 ? before : { low: Math.pow(10, low), high: Math.pow(10, high) };
}

export function sameView(one: View, other: View): boolean {
  return (
    one.x.low === other.x.low && one.x.high === other.x.high && one.y.low === other.y.low && one.y.high === other.y.high
  );
}
