import { appearance } from "./appearance.js";
import type { ColourName, Figure, SeriesStyle } from "./contract.js";
import { make, makeSvg } from "./dom.js";
import { colourText, hex, type Look } from "./palette.js";
import { lineDashes } from "./prepared_panel.js";
import { glyphOf, typeIn } from "./symbols.js";

export interface LegendEntry {
  title: string;
  style: SeriesStyle | "mark";
  colour: ColourName;
  symbol: number;
  type: string;
}

/** The meanings of colours, lines and symbols in all panels of a figure, each once. */
export function legendOf(figure: Figure): LegendEntry[] {
  const entries = new Map<string, LegendEntry>();
  for (const panel of figure.panels) {
    for (const series of panel.series)
      if (series.title)
        entries.set(`${series.title}\n${series.colour}\n${series.style}`, {
          title: series.title,
          style: series.style,
          colour: series.colour,
          symbol: series.symbol ?? 7,
          type: series.style === "symbols" ? typeIn(series.title) : "",
        });
    if (panel.marks_title && panel.marks.length > 0)
      entries.set(panel.marks_title, { title: panel.marks_title, style: "mark", colour: "grey", symbol: 0, type: "" });
  }
  return [...entries.values()];
}

/** A small drawing of the entry's look, as SVG in a box of 26 by 14. */
export function legendSample(entry: LegendEntry, look: Look = appearance.look): SVGElement {
  const colour = colourText(entry.colour, look);
  const svg = makeSvg("svg", { viewBox: "0 0 26 14", width: 26, height: 14, "aria-hidden": "true" });
  if (entry.style in lineDashes)
    svg.append(
      makeSvg("path", {
        d: "M1 7H25",
        stroke: colour,
        "stroke-width": 2,
        fill: "none",
        "stroke-dasharray": lineDashes[entry.style].join(" "),
      }),
    );
  else if (entry.style === "cells") svg.append(makeSvg("rect", { x: 6, y: 1, width: 14, height: 12, fill: colour }));
  else if (entry.style === "mark" || entry.style === "impulses")
    svg.append(makeSvg("path", { d: "M13 0V14", stroke: colour, "stroke-width": 1.5 }));
  else if (entry.style === "dots") svg.append(makeSvg("circle", { cx: 13, cy: 7, r: 2, fill: colour }));
  else {
    const glyph = glyphOf(entry.style === "circles" ? 6 : entry.symbol, entry.type);
    const place = "translate(13 7) scale(5)";
    const ground = glyph.lines.includes("Z") ? hex(look.ground) : "none";
    svg.append(
      makeSvg("path", { d: glyph.lines, transform: place, stroke: colour, "stroke-width": 0.34, fill: ground }),
      makeSvg("path", { d: glyph.area, transform: place, fill: colour }),
    );
  }
  return svg;
}

export function legendElement(figure: Figure): HTMLElement {
  const list = make("ul", { class: "legend", "aria-label": "Legend" });
  for (const entry of legendOf(figure)) {
    const item = make("li");
    item.append(legendSample(entry), entry.title);
    list.append(item);
  }
  list.hidden = list.childElementCount === 0;
  return list;
}
