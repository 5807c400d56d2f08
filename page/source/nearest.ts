import type { Label } from "./contract.js";
import type { Frame } from "./frame.js";
import { indicesWithin, lineDashes, piecesWithin, type PreparedPanel, type PreparedSeries } from "./prepared_panel.js";

/** A drawn point near the pointer. */
export interface Hit {
  one: PreparedSeries;
  index: number;
  x: number;
  y: number;
  run: string | null;
  number: number | null;
  label: Label | null;
  distance: number;
}

/**
 * The drawn point nearest to a place on the canvas: special points are preferred to others. Looking at each point takes
 * one millisecond for two hundred thousand of them, so that an index would save nothing.
 */
export function nearestPoint(prepared: PreparedPanel, frame: Frame, px: number, py: number, reach: number): Hit | null {
  let best: Hit | null = null;
  let bestCost = Infinity;
  for (const one of prepared.drawn) {
    const { series } = one;
    const bonus = series.style === "symbols" ? reach / 2 : 0;
    const found =
      series.style in lineDashes ? nearestOnLine(one, frame, px, py, reach) : nearestDot(one, frame, px, py, reach);
    if (!found) continue;
    const cost = found.distance - bonus;
    if (cost >= bestCost) continue;
    bestCost = cost;
    best = hitAt(prepared, one, found.index, found.distance);
  }
  return best ?? cellAt(prepared, frame, px, py);
}

export function hitAt(prepared: PreparedPanel, one: PreparedSeries, index: number, distance = 0): Hit {
  const run = one.series.run ?? null,
    number = one.series.numbers?.[index] ?? null;
  const label =
    run === null || number === null
      ? null
      : (prepared.labels.find((candidate) => candidate.run === run && candidate.number === number) ?? null);
  return { one, index, x: one.x[index], y: one.y[index], run, number, label, distance };
}

interface Found {
  index: number;
  distance: number;
}

function nearestDot(one: PreparedSeries, frame: Frame, px: number, py: number, reach: number): Found | null {
  const { x, y } = one;
  const [first, last] = indicesWithin(one, frame.view.x);
  let least = reach * reach,
    index = -1;
  for (let i = first; i < last; ++i) {
    const dx = frame.x(x[i]) - px,
      dy = frame.y(y[i]) - py;
    const square = dx * dx + dy * dy;
    if (square < least) {
      least = square;
      index = i;
    }
  }
  return index < 0 ? null : { index, distance: Math.sqrt(least) };
}

/** A line can be touched between its points, too; the nearer end of the touched piece is found then. */
function nearestOnLine(one: PreparedSeries, frame: Frame, px: number, py: number, reach: number): Found | null {
  const { x, y } = one;
  const [first, last] = piecesWithin(one, frame.view.x);
  let least = reach * reach,
    index = -1;
  let x0 = NaN,
    y0 = NaN;
  for (let i = first; i < last; ++i) {
    const x1 = frame.x(x[i]),
      y1 = frame.y(y[i]);
    const dx = x1 - x0,
      dy = y1 - y0,
      length = dx * dx + dy * dy;
    const part = length > 0 ? Math.max(0, Math.min(1, ((px - x0) * dx + (py - y0) * dy) / length)) : 1;
    const fromX = x0 === x0 ? x0 + part * dx - px : x1 - px,
      fromY = y0 === y0 ? y0 + part * dy - py : y1 - py;
    const square = fromX * fromX + fromY * fromY;
    if (square < least) {
      least = square;
      index = part < 0.5 && x0 === x0 ? i - 1 : i;
    }
    x0 = x1;
    y0 = y1;
  }
  return index < 0 ? null : { index, distance: Math.sqrt(least) };
}

function cellAt(prepared: PreparedPanel, frame: Frame, px: number, py: number): Hit | null {
  for (const one of prepared.drawn) {
    const cells = one.series.cells ?? [];
    for (let i = 0; i < cells.length; ++i) {
      const [left, right, low, high] = cells[i];
      if (frame.x(left) > px || frame.x(right) < px || frame.y(high) > py || frame.y(low) < py) continue;
      const run = one.series.run ?? null,
        number = one.series.numbers?.[i] ?? null;
      return { one, index: i, x: (left + right) / 2, y: (low + high) / 2, run, number, label: null, distance: 0 };
    }
  }
  return null;
}

/** The place of a stored point in a panel; null if it is not drawn there. */
export function placeOf(prepared: PreparedPanel, run: string, number: number): Hit | null {
  for (const one of prepared.drawn) {
    if (one.series.run !== run) continue;
    const index = one.series.numbers?.indexOf(number) ?? -1;
    if (index < 0) continue;
    const cell = one.series.cells?.[index];
    const hit = hitAt(prepared, one, index);
    return cell ? { ...hit, x: (cell[0] + cell[1]) / 2, y: (cell[2] + cell[3]) / 2 } : hit;
  }
  return null;
}
