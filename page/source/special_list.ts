import type { Figure, SpecialPoint } from "./contract.js";
import { append, button, fill, make } from "./dom.js";
import { kindInWords } from "./kind_words.js";
import { shown, symbolOf } from "./numbers.js";
import { varied, type Workspace } from "./workspace.js";

const few = 12; // so many are seen without opening the list

/** The labelled points of a figure as buttons: for those for which there was no room, and for the keyboard. */
export class SpecialList {
  readonly root = make("details", { class: "special" });
  private shown = "";

  constructor(private readonly workspace: Workspace) {}

  show(figure: Figure): void {
    const known = new Map<string, { text: string; run: string; number: number }>();
    for (const panel of figure.panels)
      for (const { text, run, number } of panel.labels)
        if (run !== null && run !== undefined && number !== null && number !== undefined)
          known.set(`${run}/${number}`, { text, run, number });
    const entries = [...known.values()].map(({ text, run, number }) => {
      const point = this.workspace.specialPointsOf(run).find((one) => one.number === number);
      return {
        text,
        run,
        number,
        kind: point?.type ?? "",
        type: point?.type_words ?? "",
        place: placeOf(this.workspace, run, point),
      };
    });
    const key = JSON.stringify(entries);
    if (this.shown === "") this.root.open = known.size <= few;
    if (key === this.shown) return; // it is not taken from under the pointer while a run is computed
    this.shown = key;
    this.root.hidden = known.size === 0;
    const byRun = new Map<string, HTMLElement[]>();
    for (const { text, run, number, type, place } of entries) {
      const act = () => this.workspace.select({ run, number });
      const entry = button(text, act, { title: [type, place].filter((one) => one).join(", ") || null });
      const more = [` of ${run}`, type].filter((one) => one).join(", ");
      append(entry, make("span", { class: "unseen" }, more));
      const withPlace = make("span", {}, entry, place ? make("small", { class: "note" }, ` ${place}`) : null);
      byRun.set(run, [...(byRun.get(run) ?? []), withPlace]);
    }
    const lists = [...byRun].map(([run, entries]) => make("div", { class: "row" }, make("span", {}, run), ...entries));
    const kinds = new Set(entries.map(({ kind }) => kind).filter((kind) => kind !== ""));
    const meanings = [...kinds].sort().map(kindInWords).join(" · ");
    fill(
      this.root,
      make("summary", {}, `Special points (${known.size})`),
      meanings ? make("p", { class: "note" }, meanings) : null,
      ...lists,
    );
  }
}

/** Where a point is along its branch. */
function placeOf(workspace: Workspace, run: string, point: SpecialPoint | undefined): string {
  const known = workspace.run(run);
  if (!known || !point) return "";
  const values = varied(known).map((name, index) => `${symbolOf(name)} = ${shown(point.coordinates[index], 4)}`);
  return values.join(", ");
}
