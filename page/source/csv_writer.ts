import type { Figure, Panel } from "./contract.js";
import type { Diagram } from "./diagram.js";
import { perUnit } from "./numbers.js";

/** A cell of a CSV file. A leading "=" and the like would be a formula to spreadsheets: it becomes a text. */
function cell(value: string | number | null | undefined): string {
  if (value === null || value === undefined) return "";
  if (typeof value === "number") return String(value);
  const text = /^[=+\-@\t\r]/.test(value) ? `'${value}` : value;
  return /[",\n\r]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

function heading(axis: Panel["x"]): string {
  return perUnit(axis.label || axis.words, axis.unit);
}

/** What is drawn within the frames: a row for each point. */
export function csvOf(figure: Figure, diagrams: Diagram[]): string {
  const rows = [["panel", "series", "style", "run", "number", "label", "x", "y"].join(",")];
  const many = diagrams.length > 1;
  diagrams.forEach((diagram, index) => {
    const { data, currentView: view } = diagram,
      panel = figure.panels[index];
    if (!panel) return;
    const title = panel.title || (many ? String(index + 1) : figure.title);
    rows.push([cell(title), "", "axes", "", "", "", cell(heading(panel.x)), cell(heading(panel.y))].join(","));
    const labels = new Map(panel.labels.map((label) => [`${label.run}/${label.number}`, label.text]));
    for (const { series, x, y } of data.drawn) {
      const write = (at: number, px: number, py: number) => {
        if (px < view.x.low || px > view.x.high || py < view.y.low || py > view.y.high) return;
        const number = series.numbers?.[at] ?? null;
        const label = labels.get(`${series.run}/${number}`) ?? "";
        const name = series.title || series.run || "";
        rows.push(
          [cell(title), cell(name), series.style, cell(series.run), cell(number), cell(label), px, py].join(","),
        );
      };
      for (let i = 0; i < x.length; ++i) if (Number.isFinite(x[i]) && Number.isFinite(y[i])) write(i, x[i], y[i]);
      (series.cells ?? []).forEach(([l, r, low, high], i) => write(i, (l + r) / 2, (low + high) / 2));
    }
  });
  return rows.join("\n") + "\n";
}
