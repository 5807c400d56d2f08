import type { Series } from "./contract.js";
import type { DotBuffer } from "./dot_buffer.js";
import type { Frame } from "./frame.js";
import { placeLabels } from "./label_places.js";
import { colourNumber, colourText, hex, letterColour, type Look } from "./palette.js";
import { indicesWithin, lineDashes, piecesWithin, type PreparedPanel, type PreparedSeries } from "./prepared_panel.js";
import { drawGlyph, glyphOf, glyphStamp, typeIn } from "./symbols.js";

export interface DrawingStyle {
  look: Look;
  scale: number; // pixels of the canvas for a unit of length
  font: string; // of labels, with its size in pixels of the canvas
  fontSize: number;
  /** The type of the special point that a symbol marks; empty if unknown. */
  typeOf(run: string | null | undefined, number: number | null | undefined): string;
}

const manyDots = 50000;

/** Radius of dots, which shrinks as they become many. */
export function dotRadius(points: number): number {
  return points > manyDots ? 0.75 : points > 5000 ? 0.9 : points > 800 ? 1.2 : 1.7;
}

export function drawPanel(
  context: CanvasRenderingContext2D,
  prepared: PreparedPanel,
  frame: Frame,
  style: DrawingStyle,
  dots: DotBuffer,
): void {
  context.save();
  context.beginPath();
  context.rect(frame.left, frame.top, frame.width, frame.height);
  context.clip();
  for (const one of prepared.drawn) if (one.series.style === "cells") drawCells(context, one.series, frame, style);
  drawMarks(context, prepared, frame, style);
  drawDots(context, prepared, frame, style, dots);
  for (const one of prepared.drawn)
    if (one.series.style in lineDashes) drawLine(context, one, frame, style);
    else if (one.series.style === "impulses") drawImpulses(context, one, frame, style);
  for (const one of prepared.drawn)
    if (one.series.style === "symbols" || one.series.style === "circles") drawSymbols(context, one, frame, style);
  drawLabels(context, prepared, frame, style);
  context.restore();
}

function drawCells(context: CanvasRenderingContext2D, series: Series, frame: Frame, style: DrawingStyle): void {
  context.fillStyle = series.hatch
    ? hatching(context, series.hatch, colourText(series.colour, style.look), style.scale)
    : colourText(series.colour, style.look);
  context.globalAlpha = 0.9;
  for (const [left, right, low, high] of series.cells ?? []) {
    const x0 = frame.x(left),
      x1 = frame.x(right),
      y0 = frame.y(high),
      y1 = frame.y(low);
    if (x1 < frame.left || x0 > frame.left + frame.width || y1 < frame.top || y0 > frame.top + frame.height) continue;
    // Rounded, so that neighbours neither overlap nor leave a seam.
    const px = Math.round(x0),
      py = Math.round(y0);
    context.fillRect(px, py, Math.max(1, Math.round(x1) - px), Math.max(1, Math.round(y1) - py));
  }
  context.globalAlpha = 1;
}

function hatching(
  context: CanvasRenderingContext2D,
  hatch: number,
  colour: string,
  scale: number,
): CanvasPattern | string {
  const size = Math.round(6 * scale);
  const tile = document.createElement("canvas");
  tile.width = tile.height = size;
  const own = tile.getContext("2d");
  if (!own) return colour;
  own.strokeStyle = colour;
  own.lineWidth = scale;
  const rising = hatch % 2 === 1;
  for (const shift of [-size, 0, size]) {
    own.moveTo(shift, rising ? size : 0);
    own.lineTo(shift + size, rising ? 0 : size);
  }
  own.stroke();
  return context.createPattern(tile, "repeat") ?? colour;
}

function drawMarks(
  context: CanvasRenderingContext2D,
  prepared: PreparedPanel,
  frame: Frame,
  style: DrawingStyle,
): void {
  context.strokeStyle = colourText("grey", style.look);
  context.lineWidth = style.scale;
  context.setLineDash([]);
  context.beginPath();
  for (const mark of prepared.panel.marks ?? []) {
    if (mark === null) continue;
    const x = Math.round(frame.x(mark)) + 0.5;
    context.moveTo(x, frame.top);
    context.lineTo(x, frame.top + frame.height);
  }
  context.stroke();
}

function drawDots(
  context: CanvasRenderingContext2D,
  prepared: PreparedPanel,
  frame: Frame,
  style: DrawingStyle,
  dots: DotBuffer,
): void {
  const series = prepared.drawn.filter((one) => one.series.style === "dots" && one.x.length > 0);
  if (series.length === 0) return;
  const count = series.reduce((sum, one) => sum + one.x.length, 0);
  // On screens with fine pixels, very many dots are drawn as coarse as on others, to stay fluid.
  dots.begin(frame.width, frame.height, count > manyDots ? Math.max(1, Math.round(devicePixelRatio)) : 1);
  for (const one of series)
    dots.add(one, frame, colourNumber(one.series.colour, style.look), dotRadius(count) * style.scale, 0.9);
  dots.draw(context, frame);
}

function drawLine(context: CanvasRenderingContext2D, one: PreparedSeries, frame: Frame, style: DrawingStyle): void {
  const { series, order } = one;
  const { x, y } = one.line;
  context.strokeStyle = colourText(series.colour, style.look);
  context.lineWidth = 1.8 * style.scale;
  context.lineJoin = "round";
  context.setLineDash(lineDashes[series.style].map((length) => length * style.scale));
  const [first, last] = piecesWithin({ x, order }, frame.view.x);
  context.beginPath();
  let open = false,
    lastX = 0,
    lastY = 0;
  for (let i = first; i < last; ++i) {
    const px = clamped(frame.x(x[i])),
      py = clamped(frame.y(y[i]));
    if (px !== px || py !== py) {
      open = false;
      continue;
    }
    if (!open) context.moveTo(px, py);
    // Points within a fraction of a pixel of the last one add nothing to the line but time.
    else if (i + 1 < last && Math.abs(px - lastX) < 0.4 && Math.abs(py - lastY) < 0.4) continue;
    else context.lineTo(px, py);
    open = true;
    lastX = px;
    lastY = py;
  }
  context.stroke();
  context.setLineDash([]);
}

/** Canvases draw nothing, or hang in dashes, at coordinates far outside. What has no logarithm has no place. */
function clamped(pixel: number): number {
  if (!Number.isFinite(pixel)) return NaN;
  return pixel > 20000 ? 20000 : pixel < -20000 ? -20000 : pixel;
}

function drawImpulses(context: CanvasRenderingContext2D, one: PreparedSeries, frame: Frame, style: DrawingStyle): void {
  context.strokeStyle = colourText(one.series.colour, style.look);
  context.lineWidth = 1.2 * style.scale;
  const ground = frame.logarithmicY ? frame.top + frame.height : frame.y(0);
  context.beginPath();
  const [first, last] = indicesWithin(one, frame.view.x);
  for (let i = first; i < last; ++i) {
    const px = frame.x(one.x[i]),
      py = clamped(frame.y(one.y[i]));
    if (!Number.isFinite(px) || !Number.isFinite(py)) continue;
    context.moveTo(px, clamped(ground));
    context.lineTo(px, py);
  }
  context.stroke();
}

function drawSymbols(context: CanvasRenderingContext2D, one: PreparedSeries, frame: Frame, style: DrawingStyle): void {
  const { x, y, series } = one;
  const colour = colourText(series.colour, style.look),
    ground = hex(style.look.ground);
  const size = symbolSize(series) * style.scale,
    many = x.length > manySymbols;
  const glyphAt = (i: number) =>
    series.style === "circles" ? glyphOf(6) : glyphOf(series.symbol, symbolType(series, i, style));
  const stamp = many ? glyphStamp(glyphAt(0), size, colour, ground) : null;
  for (let i = 0; i < x.length; ++i) {
    const px = frame.x(x[i]),
      py = frame.y(y[i]);
    if (!frame.has(px, py, size)) continue;
    if (stamp) context.drawImage(stamp, Math.round(px - stamp.width / 2), Math.round(py - stamp.height / 2));
    else drawGlyph(context, glyphAt(i), px, py, size, colour, ground);
  }
}

/** More symbols in a series mark no special points: they are smaller, and stamped, which is faster. */
const manySymbols = 150;

export function symbolSize(series: Series): number {
  const many = series.x.length > manySymbols;
  return series.style === "circles" ? (many ? 2 : 3) : many ? 2.5 : 5;
}

export function symbolType(series: Series, index: number, style: Pick<DrawingStyle, "typeOf">): string {
  return style.typeOf(series.run, series.numbers?.[index]) || typeIn(series.title);
}

function drawLabels(
  context: CanvasRenderingContext2D,
  prepared: PreparedPanel,
  frame: Frame,
  style: DrawingStyle,
): void {
  if (prepared.labels.length === 0) return;
  context.font = style.font;
  context.textBaseline = "middle";
  context.textAlign = "left";
  context.lineJoin = "round";
  const width = (text: string) => context.measureText(text).width;
  for (const place of placeLabels(prepared, frame, style.fontSize, style.scale, width)) {
    const colour = letterColour(place.colour, style.look);
    if (place.leader) {
      context.strokeStyle = colour;
      context.lineWidth = 0.8 * style.scale;
      context.beginPath();
      context.moveTo(place.anchorX, place.anchorY);
      context.lineTo(place.leader.x, place.leader.y);
      context.stroke();
    }
    // A seam of the ground colour keeps letters readable over lines.
    context.strokeStyle = hex(style.look.ground);
    context.lineWidth = 3 * style.scale;
    context.strokeText(place.text, place.x, place.y);
    context.fillStyle = colour;
    context.fillText(place.text, place.x, place.y);
  }
}
