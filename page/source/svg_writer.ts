import { appearance } from "./appearance.js";
import { axisTitle } from "./axis_text.js";
import type { Series } from "./contract.js";
import type { Diagram } from "./diagram.js";
import type { ExportLayout, PlacedDiagram } from "./export_layout.js";
import { Frame } from "./frame.js";
import { placeLabels } from "./label_places.js";
import { legendSample } from "./legend.js";
import { colourText, hex, letterColour, type Look } from "./palette.js";
import { dotRadius, symbolSize, symbolType } from "./panel_drawing.js";
import { indicesWithin, lineDashes, piecesWithin, type PreparedSeries } from "./prepared_panel.js";
import { glyphOf } from "./symbols.js";
import { ticksOf } from "./ticks.js";

/** A text in an SVG file; characters that XML does not know are left out. */
function escaped(text: string): string {
  const known = text.replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f\ufffe\uffff]/g, "");
  return known.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");
}

function textAt(x: number, y: number, text: string, more = ""): string {
  return `<text x="${round(x)}" y="${round(y)}" ${more}>${escaped(text)}</text>`;
}

function round(value: number): number {
  return Math.round(value * 100) / 100;
}

/** The picture as lines, symbols and letters that can be edited. @param look of a page; the light one is for papers */
export function svgOf(layout: ExportLayout, look: Look): string {
  const ink = hex(look.ink);
  const parts: string[] = [
    `<svg xmlns="http://www.w3.org/2000/svg" width="${layout.width}" height="${layout.height}" ` +
      `viewBox="0 0 ${layout.width} ${layout.height}" font-family="DejaVu Sans, sans-serif" ` +
      `font-size="${layout.font}" fill="${ink}">`,
    `<title>${escaped(layout.title)}</title>`,
    `<rect width="100%" height="100%" fill="${hex(look.ground)}"/>`,
    textAt(layout.width / 2, 1.5 * layout.font, layout.title, `text-anchor="middle" font-size="${1.2 * layout.font}"`),
  ];
  layout.diagrams.forEach((placed, index) => parts.push(diagramSvg(placed, layout.font, `frame${index}`, look)));
  for (const { entry, left, middle } of layout.legend) {
    const sample = new XMLSerializer().serializeToString(legendSample(entry, look));
    parts.push(`<g transform="translate(${round(left)} ${round(middle - 7)})">${sample}</g>`);
    parts.push(textAt(left + 32, middle + 0.35 * layout.font, entry.title));
  }
  parts.push("</svg>\n");
  return parts.join("\n");
}

/** The frame in units of the screen; on the canvas it is in pixels. */
function frameOf(placed: PlacedDiagram): Frame | null {
  const frame = placed.diagram.frame(),
    canvas = placed.diagram.canvas;
  if (!frame || !canvas) return null;
  const ratio = canvas.width / placed.width;
  return new Frame(
    placed.left + frame.left / ratio,
    placed.top + frame.top / ratio,
    frame.width / ratio,
    frame.height / ratio,
    frame.view,
    frame.logarithmicX,
    frame.logarithmicY,
  );
}

function diagramSvg(placed: PlacedDiagram, font: number, clip: string, look: Look): string {
  const frame = frameOf(placed);
  if (!frame) return "";
  const { diagram } = placed,
    { left, top, width, height } = frame;
  const box = `x="${round(left)}" y="${round(top)}" width="${round(width)}" height="${round(height)}"`;
  return [
    `<clipPath id="${clip}"><rect ${box}/></clipPath>`,
    placed.title
      ? textAt(placed.left + placed.width / 2, placed.top - 0.4 * font, placed.title, 'text-anchor="middle"')
      : "",
    axesSvg(diagram, frame, placed, font, look),
    `<g clip-path="url(#${clip})">`,
    ...[...diagram.data.drawn].sort(byDepth).map((one) => seriesSvg(one, diagram, frame, look)),
    "</g>",
    labelsSvg(diagram, frame, font, look),
    `<rect ${box} fill="none" stroke="${hex(look.ink)}"/>`,
  ].join("\n");
}

/** The order in which the page draws: cells, dots, lines, symbols. */
function byDepth(one: PreparedSeries, other: PreparedSeries): number {
  const depth = ({ series: { style } }: PreparedSeries) =>
    style === "cells" ? 0 : style === "dots" ? 1 : style === "symbols" || style === "circles" ? 3 : 2;
  return depth(one) - depth(other);
}

function axesSvg(diagram: Diagram, frame: Frame, placed: PlacedDiagram, font: number, look: Look): string {
  const ink = hex(look.ink);
  const { panel } = diagram,
    { left, top, width, height, view } = frame;
  const parts: string[] = [];
  const x = ticksOf(view.x.low, view.x.high, frame.logarithmicX, Math.max(3, Math.min(10, width / 75)));
  const y = ticksOf(view.y.low, view.y.high, frame.logarithmicY, Math.max(3, Math.min(10, height / 50)));
  const bottom = top + height;
  let lines = "";
  x.values.forEach((value, i) => {
    lines += `M${round(frame.x(value))} ${round(bottom)}v5`;
    parts.push(textAt(frame.x(value), bottom + 5 + 1.1 * font, x.texts[i], 'text-anchor="middle"'));
  });
  y.values.forEach((value, i) => {
    lines += `M${round(left)} ${round(frame.y(value))}h-5`;
    parts.push(textAt(left - 8, frame.y(value) + 0.35 * font, y.texts[i], 'text-anchor="end"'));
  });
  let marks = "";
  for (const mark of panel.marks ?? [])
    if (mark !== null && mark >= view.x.low && mark <= view.x.high)
      marks += `M${round(frame.x(mark))} ${round(top)}v${round(height)}`;
  parts.push(`<path d="${marks}" stroke="${hex(look.grey)}" fill="none"/>`);
  parts.push(`<path d="${lines}" stroke="${ink}" fill="none"/>`);
  parts.push(
    textAt(
      left + width / 2,
      bottom + 5 + 2.6 * font,
      axisTitle(panel.x, width / (0.58 * font)),
      'text-anchor="middle"',
    ),
  );
  const side = placed.left + font;
  const turn = `text-anchor="middle" transform="rotate(-90 ${round(side)} ${round(top + height / 2)})"`;
  parts.push(textAt(side, top + height / 2, axisTitle(panel.y, height / (0.58 * font)), turn));
  return parts.join("\n");
}

function seriesSvg(one: PreparedSeries, diagram: Diagram, frame: Frame, look: Look): string {
  const { series } = one,
    colour = colourText(series.colour, look);
  if (series.style === "cells") return cellsSvg(series, frame, colour);
  if (series.style in lineDashes)
    return (
      `<path d="${linePath(one, frame)}" fill="none" stroke="${colour}" stroke-width="1.8" ` +
      `stroke-linejoin="round" stroke-dasharray="${lineDashes[series.style].join(" ")}"/>`
    );
  if (series.style === "dots") {
    const radius = dotRadius(diagram.data.points);
    return `<path d="${dotPath(one, frame)}" stroke="${colour}" stroke-width="${2 * radius}" stroke-linecap="round"/>`;
  }
  if (series.style === "impulses") return `<path d="${impulsePath(one, frame)}" stroke="${colour}" fill="none"/>`;
  return symbolsSvg(one, diagram, frame, colour, hex(look.ground));
}

function cellsSvg(series: Series, frame: Frame, colour: string): string {
  const id = `hatch${series.hatch}-${colour.replace(/\W/g, "")}`,
    line = (series.hatch ?? 0) % 2 === 1 ? "M0 6L6 0" : "M0 0L6 6";
  const pattern =
    `<pattern id="${id}" width="6" height="6" patternUnits="userSpaceOnUse">` +
    `<path d="${line}" stroke="${colour}"/></pattern>`;
  const fill = series.hatch ? `url(#${id})` : colour;
  const cells = (series.cells ?? []).map(
    ([l, r, low, high]) =>
      `<rect x="${round(frame.x(l))}" y="${round(frame.y(high))}" width="${round(frame.x(r) - frame.x(l))}" ` +
      `height="${round(frame.y(low) - frame.y(high))}" fill="${fill}"/>`,
  );
  return [series.hatch ? pattern : "", ...cells].join("\n");
}

function linePath(one: PreparedSeries, frame: Frame): string {
  const { line, order } = one;
  const [first, last] = piecesWithin({ x: line.x, order }, frame.view.x);
  let path = "",
    open = false;
  for (let i = first; i < last; ++i) {
    const x = round(frame.x(line.x[i])),
      y = round(frame.y(line.y[i]));
    if (!Number.isFinite(x) || !Number.isFinite(y)) open = false;
    else {
      path += `${open ? "L" : "M"}${x} ${y}`;
      open = true;
    }
  }
  return path;
}

/** Dots as lines without length; of dots at the same place, to a tenth of a unit, one is enough. */
function dotPath(one: PreparedSeries, frame: Frame): string {
  const places = new Set<string>();
  const [first, last] = indicesWithin(one, frame.view.x);
  for (let i = first; i < last; ++i) {
    const x = frame.x(one.x[i]),
      y = frame.y(one.y[i]);
    if (frame.has(x, y, 2)) places.add(`M${Math.round(10 * x) / 10} ${Math.round(10 * y) / 10}h0`);
  }
  return [...places].join("");
}

function impulsePath(one: PreparedSeries, frame: Frame): string {
  const ground = frame.logarithmicY ? frame.top + frame.height : frame.y(0);
  let path = "";
  for (let i = 0; i < one.x.length; ++i) {
    const x = frame.x(one.x[i]),
      y = frame.y(one.y[i]);
    if (Number.isFinite(x) && Number.isFinite(y)) path += `M${round(x)} ${round(ground)}V${round(y)}`;
  }
  return path;
}

function symbolsSvg(one: PreparedSeries, diagram: Diagram, frame: Frame, colour: string, ground: string): string {
  const parts: string[] = [];
  const circles = one.series.style === "circles";
  for (let i = 0; i < one.x.length; ++i) {
    const x = frame.x(one.x[i]),
      y = frame.y(one.y[i]);
    if (!frame.has(x, y, 6)) continue;
    const glyph = glyphOf(circles ? 6 : one.series.symbol, circles ? "" : symbolType(one.series, i, diagram.style()));
    const fill = glyph.lines.includes("Z") ? ground : "none";
    parts.push(
      `<g transform="translate(${round(x)} ${round(y)}) scale(${symbolSize(one.series)})">` +
        `<path d="${glyph.lines}" stroke="${colour}" stroke-width="0.34" fill="${fill}"/>` +
        (glyph.area ? `<path d="${glyph.area}" fill="${colour}"/>` : "") +
        "</g>",
    );
  }
  return parts.join("\n");
}

function labelsSvg(diagram: Diagram, frame: Frame, font: number, look: Look): string {
  const context = document.createElement("canvas").getContext("2d");
  if (context) context.font = `${font}px ${appearance.font}`;
  const halo = `stroke="${hex(look.ground)}" stroke-width="2.5" paint-order="stroke"`; // letters are read over lines
  const width = (text: string) => context?.measureText(text).width ?? 0.6 * font * text.length;
  return placeLabels(diagram.data, frame, font, 1, width)
    .map((place) => {
      const colour = letterColour(place.colour, look);
      const leader = place.leader
        ? `<path d="M${round(place.anchorX)} ${round(place.anchorY)}L${round(place.leader.x)} ${round(place.leader.y)}" stroke="${colour}"/>`
        : "";
      return leader + textAt(place.x, place.y + 0.35 * font, place.text, `fill="${colour}" ${halo}`);
    })
    .join("\n");
}
