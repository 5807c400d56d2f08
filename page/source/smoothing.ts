/** A line as it is drawn. */
export interface DrawnLine {
  x: Float64Array;
  y: Float64Array;
}

const parts = 8; // of each interval

/** Slope of the cubics at a point between two intervals with these lengths and slopes; zero at extrema. */
function slopeBetween(length: number, slope: number, nextLength: number, nextSlope: number): number {
  if (slope * nextSlope <= 0) return 0;
  const one = 2 * nextLength + length;
  const other = nextLength + 2 * length;
  return (one + other) / (one / slope + other / nextSlope);
}

/** Slope at an end: that of the parabola through three points, limited so that the cubic is monotone. */
function slopeAtEnd(length: number, slope: number, nextLength: number, nextSlope: number): number {
  const parabola = ((2 * length + nextLength) * slope - length * nextSlope) / (length + nextLength);
  if (parabola * slope <= 0) return 0;
  return slope * nextSlope < 0 && Math.abs(parabola) > 3 * Math.abs(slope) ? 3 * slope : parabola;
}

/** Slopes of one coordinate at the points first ... last, between which there are no corners. */
function slopesOf(values: Float64Array, along: Float64Array, first: number, last: number): number[] {
  const chord = (i: number) => (values[i + 1] - values[i]) / (along[i + 1] - along[i]);
  const length = (i: number) => along[i + 1] - along[i];
  if (last - first < 2) return [chord(first), chord(first)];
  const slopes = [slopeAtEnd(length(first), chord(first), length(first + 1), chord(first + 1))];
  for (let i = first + 1; i < last; ++i) slopes.push(slopeBetween(length(i - 1), chord(i - 1), length(i), chord(i)));
  slopes.push(slopeAtEnd(length(last - 1), chord(last - 1), length(last - 2), chord(last - 2)));
  return slopes;
}

/**
 * The line with points added along monotone cubics (Fritsch and Butland 1984), as printed pictures have it: it does not
 * overshoot, and begins anew at corners.
 * @param along arclength of each point
 */
export function smoothed(x: Float64Array, y: Float64Array, along: Float64Array, corners: number[]): DrawnLine {
  const isWhole = (i: number) => Number.isFinite(x[i] + y[i] + x[i + 1] + y[i + 1]) && along[i + 1] > along[i];
  const breaks = new Set(corners);
  const [xs, ys] = [[x[0]], [y[0]]];
  for (let first = 0; first + 1 < x.length; ) {
    let last = first + 1;
    if (isWhole(first)) while (last + 1 < x.length && isWhole(last) && !breaks.has(last)) ++last;
    if (isWhole(first)) {
      add(xs, x, along, first, last);
      add(ys, y, along, first, last);
    } else {
      xs.push(x[last]);
      ys.push(y[last]);
    }
    first = last;
  }
  return { x: Float64Array.from(xs), y: Float64Array.from(ys) };
}

function add(result: number[], values: Float64Array, along: Float64Array, first: number, last: number): void {
  const slopes = slopesOf(values, along, first, last);
  for (let i = first; i < last; ++i) {
    const length = along[i + 1] - along[i];
    const [from, to] = [slopes[i - first], slopes[i - first + 1]];
    for (let part = 1; part < parts; ++part) {
      const t = part / parts;
      const u = 1 - t;
      const ends = u * u * (1 + 2 * t) * values[i] + t * t * (1 + 2 * u) * values[i + 1];
      result.push(ends + length * t * u * (u * from - t * to));
    }
    result.push(values[i + 1]);
  }
}
