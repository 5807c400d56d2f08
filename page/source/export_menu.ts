import { appearance } from "./appearance.js";
import type { Figure } from "./contract.js";
import { csvOf } from "./csv_writer.js";
import type { Diagram } from "./diagram.js";
import { append, button, make, offer } from "./dom.js";
import { exportLayout, type ExportLayout } from "./export_layout.js";
import { looks } from "./palette.js";
import { pngOf } from "./png_writer.js";
import { svgOf } from "./svg_writer.js";

/** What is exported: diagrams as they are seen, in the figure to which they belong. */
export interface Exported {
  title(): string;
  figure(): Figure;
  diagrams(): Diagram[];
  studyText?(name: string): string; // a table of a study that draws the same
}

const longestName = 60;

/** A name of a file, of whole words. */
export function plainName(title: string): string {
  const plain = title
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-+|-+$/g, "");
  if (plain.length <= longestName) return plain || "picture";
  const end = plain.lastIndexOf("-", longestName);
  return plain.slice(0, end > 0 ? end : longestName);
}

function layoutOf(what: Exported): ExportLayout {
  const font = 12 * appearance.size;
  const context = document.createElement("canvas").getContext("2d");
  if (context) context.font = `${font}px ${appearance.font}`;
  return exportLayout(
    { ...what.figure(), title: what.title() },
    what.diagrams(),
    font,
    (text) => context?.measureText(text).width ?? 8 * text.length,
  );
}

/** The buttons that export what is seen. */
export function exportMenu(what: Exported): HTMLElement {
  const save = (ending: string, type: string, content: () => BlobPart | Promise<Blob>) => async () => {
    menu.open = false;
    const made = await content();
    offer(`${plainName(what.title())}.${ending}`, made instanceof Blob ? made : new Blob([made], { type }));
  };
  const entries = make(
    "div",
    { class: "entries" },
    button(
      "PNG",
      save("png", "image/png", () => pngOf(layoutOf(what))),
    ),
    button(
      "SVG",
      save("svg", "image/svg+xml", () => svgOf(layoutOf(what), looks.light)),
    ),
    button(
      "CSV",
      save("csv", "text/csv", () => csvOf(what.figure(), what.diagrams())),
    ),
  );
  const { studyText } = what;
  if (studyText)
    append(
      entries,
      button(
        "Study text",
        save("toml", "application/toml", () => studyText(plainName(what.title()))),
      ),
    );
  const menu = make("details", { class: "menu" }, make("summary", {}, "Export"), entries);
  menu.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    menu.open = false;
    menu.querySelector("summary")?.focus();
  });
  return menu;
}
