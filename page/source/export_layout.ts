import type { Figure } from "./contract.js";
import type { Diagram } from "./diagram.js";
import { legendOf, type LegendEntry } from "./legend.js";

export interface PlacedDiagram {
  diagram: Diagram;
  title: string;
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface PlacedEntry {
  entry: LegendEntry;
  left: number;
  middle: number;
}

/** Where title, diagrams and legend lie on an exported picture, in units of the screen. */
export interface ExportLayout {
  width: number;
  height: number;
  title: string;
  diagrams: PlacedDiagram[];
  legend: PlacedEntry[];
  font: number;
}

/** The diagrams as they lie on the screen, and the legend in columns below. @param widthOf of a text */
export function exportLayout(
  figure: Figure,
  diagrams: Diagram[],
  font: number,
  widthOf: (text: string) => number,
): ExportLayout {
  const gap = font,
    titleHeight = 2.4 * font,
    headingHeight = 1.6 * font;
  const columns = Math.max(1, Math.min(figure.columns, diagrams.length));
  const placed: PlacedDiagram[] = [];
  let top = titleHeight,
    width = 0;
  for (let first = 0; first < diagrams.length; first += columns) {
    const row = diagrams.slice(first, first + columns);
    const heading = row.some((diagram) => diagram.panel.title) ? headingHeight : 0;
    let left = 0,
      height = 0;
    for (const diagram of row) {
      const { clientWidth: w, clientHeight: h } = diagram.root;
      placed.push({ diagram, title: diagram.panel.title, left, top: top + heading, width: w, height: h });
      left += w + gap;
      height = Math.max(height, h);
    }
    width = Math.max(width, left - gap);
    top += heading + height + gap;
  }
  const entries = legendOf(figure);
  const widest = Math.max(0, ...entries.map((entry) => widthOf(entry.title))) + 32 + gap;
  const across = Math.max(1, Math.floor(width / widest));
  const indent = Math.max(0, (width - Math.min(across, entries.length) * widest) / 2);
  const legend = entries.map((entry, index) => ({
    entry,
    left: indent + (index % across) * widest,
    middle: top + (Math.floor(index / across) + 0.5) * 1.5 * font,
  }));
  const height = top + Math.ceil(entries.length / across) * 1.5 * font + gap;
  return { width: Math.ceil(width), height: Math.ceil(height), title: figure.title, diagrams: placed, legend, font };
}
