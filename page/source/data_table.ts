import type { NamedNumber, Num, Table } from "./contract.js";
import { make } from "./dom.js";
import { perUnit, shown, symbolOf } from "./numbers.js";

function cell(value: Num | string | boolean | undefined): HTMLTableCellElement {
  if (typeof value === "string") return make("td", {}, value);
  if (typeof value === "boolean") return make("td", {}, value ? "yes" : "no");
  return make("td", { class: "number" }, shown(value, 8));
}

function caption(title: string, seen: boolean): HTMLTableCaptionElement {
  return make("caption", { class: seen ? null : "unseen" }, title);
}

/** A table that can be scrolled sideways. @param seen whether its title is seen, or stands above it already */
export function dataTable(table: Table, title = table.title ?? "", seen = true): HTMLElement {
  const head = make("tr");
  for (const { name, unit } of table.columns) head.append(make("th", { scope: "col" }, perUnit(name, unit)));
  const body = make("tbody");
  for (const row of table.rows) body.append(make("tr", {}, ...row.map(cell)));
  const element = make("table", {}, title ? caption(title, seen) : null, make("thead", {}, head), body);
  return make("div", { class: "table", tabindex: 0, role: "region", "aria-label": title || "Table" }, element);
}

/** Names with values and units; words tell more when there is room. */
export function valueTable(title: string, values: NamedNumber[], seen = true): HTMLElement | null {
  if (values.length === 0) return null;
  const body = make("tbody");
  for (const one of values)
    body.append(
      make(
        "tr",
        { title: one.words || null },
        make("th", { scope: "row" }, symbolOf(one.name)),
        make("td", { class: "number" }, shown(one.value, 8)),
        make("td", {}, one.unit === "1" ? "" : one.unit),
        make("td", { class: "words" }, one.words),
      ),
    );
  return make("table", { class: "values" }, caption(title, seen), body);
}
