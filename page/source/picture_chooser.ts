import { colourings, type Colouring } from "./colouring.js";
import type { PictureWish, Quantity, Run } from "./contract.js";
import { append, button, checkbox, choice, fill, labelled, make, type Option } from "./dom.js";
import { perUnit, symbolOf } from "./numbers.js";
import { haveSameAxes } from "./joined_figure.js";
import type { Workspace } from "./workspace.js";

export interface ChooserActs {
  wish(wish: PictureWish): void;
  colouring(colouring: Colouring): void;
}

/** The kinds of pictures that a run can have. */
function kindsOf(run: Run): string[] {
  if (run.is_branch) return ["branch", "portrait", "history", "scatter"];
  const ofSamples = ["spectrum", "history", "portrait", "poincare", "regression", "scatter"];
  if (run.kind === "identify") return ["residuals"];
  if (run.kind === "record") return ofSamples;
  const { length } = run.coordinates;
  return [
    ...(run.kind === "atlas" ? ["atlas"] : []),
    ...(length === 1 ? ["bifurcation"] : length > 1 ? ["basin", "map", "bifurcation"] : []),
    ...ofSamples,
  ];
}

const ofOrbits = ["period", "multiplier", "error", "slowest_approach"]; // what every point of a branch has

/** What is in all lists, in the order of the first. */
function common(lists: string[][]): string[] {
  return (lists[0] ?? []).filter(
    (name, index, all) => all.indexOf(name) === index && lists.every((list) => list.includes(name)),
  );
}

/** The form in which one chooses what a picture shows: runs, quantities, kind and colours. */
export class PictureChooser {
  readonly root = make("form", { class: "chooser-form", "aria-label": "Choose what the picture shows" });
  private wish: PictureWish;
  private readonly own = make("input", { type: "text", placeholder: "expression for y, such as V/omega", size: 24 });

  constructor(
    private readonly workspace: Workspace,
    wish: PictureWish,
    private colouring: Colouring,
    private readonly acts: ChooserActs,
  ) {
    this.wish = { ...wish };
    this.root.addEventListener("submit", (event) => event.preventDefault());
    this.build();
  }

  /** What was chosen cannot be drawn; the text that was typed stays, to be mended. */
  takeBack(wish: PictureWish): void {
    this.wish = { ...wish };
    const typed = this.own.value;
    this.build();
    this.own.value = typed;
  }

  private build(): void {
    const automatic: Option = { value: "", text: "automatic" };
    const option = ({ name, unit, words }: Quantity): Option => ({
      value: name,
      text: `${perUnit(symbolOf(name), unit)}${words ? ` – ${words}` : ""}`,
    });
    const quantities = this.quantities().map(option);
    const set = (change: Partial<PictureWish>) => this.change(change);
    const x = choice([automatic, ...this.horizontal().map(option)], this.wish.x ?? "", (value) =>
      set({ x: value || undefined }),
    );
    const y = choice([automatic, ...quantities], this.wish.y?.[0] ?? "", (value) =>
      set({ y: value ? [value, ...(this.wish.y?.slice(1) ?? [])] : undefined }),
    );
    const more = choice([{ value: "", text: "add another" }, ...quantities], "", (value) => {
      if (!value) return;
      set({ y: [...(this.wish.y ?? []), value] });
      this.build();
    });
    const kinds = common(this.chosenRuns().map(kindsOf));
    const kind = choice([automatic, ...kinds], this.wish.kind ?? "", (value) => {
      set({ kind: value || undefined });
      this.build(); // other quantities belong to it
    });
    const useOwn = button("Use", () => set({ y: this.own.value.trim() ? [this.own.value.trim()] : undefined }));
    const colours = labelled(
      "colours by",
      choice(colourings, this.colouring, (value) => {
        this.colouring = value as Colouring;
        this.acts.colouring(this.colouring);
      }),
    );
    // A file has its pictures; only who can compute makes others.
    if (!this.workspace.source.workshop) return fill(this.root, this.runChoice(), colours);
    fill(
      this.root,
      this.runChoice(),
      labelled("x", x),
      labelled("y", y),
      labelled("and y", more),
      this.lists(),
      make("div", { class: "row" }, labelled("y =", this.own), useOwn),
      labelled("kind", kind),
      this.ways(),
      colours,
    );
  }

  /** Further values of y, each in a panel of its own. */
  private lists(): HTMLElement | null {
    const further = this.wish.y?.slice(1) ?? [];
    if (further.length === 0) return null;
    const row = make("div", { class: "row" });
    for (const name of further)
      append(
        row,
        button(
          `${symbolOf(name)} ✕`,
          () => {
            this.change({ y: this.wish.y?.filter((other) => other !== name) });
            this.build();
          },
          { "aria-label": `Leave out ${name}` },
        ),
      );
    return row;
  }

  private runChoice(): HTMLElement {
    const chosen = new Set(this.wish.runs ?? []);
    const field = make("fieldset", {}, make("legend", {}, "Runs"));
    const boxes: { run: Run; box: HTMLLabelElement }[] = [];
    // Others cannot be drawn in the same axes.
    const offer = () =>
      boxes.forEach(({ run, box }) => {
        const fits = [...chosen].every((name) => {
          const other = this.workspace.run(name);
          return !other || haveSameAxes(other, run);
        });
        const input = box.querySelector("input");
        if (input) input.disabled = !fits && !chosen.has(run.name);
        box.title = fits ? "" : "It varies other parameters, or has none of the values, than the runs that are chosen";
      });
    for (const run of this.workspace.runs) {
      if (run.points === 0) continue;
      const box = checkbox(run.name, chosen.has(run.name), (on) => {
        if (on) chosen.add(run.name);
        else chosen.delete(run.name);
        if (chosen.size === 0) return;
        this.change({ runs: [...chosen] });
        offer();
      });
      boxes.push({ run, box });
      append(field, box);
    }
    offer();
    return field;
  }

  /** Directions and samplings, where there is more than one. */
  private ways(): HTMLElement | null {
    const runs = this.chosenRuns();
    const directions = [...new Set(runs.flatMap((run) => [...run.directions, ...run.parts]))].filter((way) => way);
    const samplings = [...new Set(runs.flatMap((run) => run.samplings))];
    const row = make("div", { class: "row" });
    const offer = (name: string, key: "directions" | "samples", ways: string[]) => {
      const set = (value: string) => this.change({ [key]: value ? [value] : undefined });
      const options = [{ value: "", text: "all" }, ...ways];
      if (ways.length > 1) append(row, labelled(name, choice(options, this.wish[key]?.[0] ?? "", set)));
    };
    offer("direction", "directions", directions);
    offer("samples", "samples", samplings);
    return row.childElementCount > 0 ? row : null;
  }

  private chosenRuns(): Run[] {
    return this.workspace.runsOf(this.wish.runs ?? []);
  }

  private quantities(): Quantity[] {
    const { kind } = this.wish,
      isMotion = ["history", "portrait", "poincare", "spectrum"].includes(kind ?? "");
    const of = (run: Run): Quantity[] => {
      if (isMotion)
        return [
          ...run.states,
          ...run.values.filter(({ name }) => !run.is_branch || run.states.some((one) => one.name === name)),
        ];
      const general = run.is_branch ? ofOrbits.map((name) => ({ name, unit: "", words: "" })) : [];
      return [...run.values, ...(run.is_branch || kind === "scatter" ? run.coordinates : []), ...general];
    };
    // Over the dots of a sweep branches are drawn with what belongs to the sweep's values.
    const runs = this.chosenRuns(),
      sweeps = runs.filter((run) => !run.is_branch);
    const all = (sweeps.length > 0 ? sweeps : runs).map((run) => new Map(of(run).map((one) => [one.name, one])));
    const names = common(all.map((known) => [...known.keys()]));
    return names.flatMap((name) => all[0].get(name) ?? []);
  }

  /** What the horizontal axis can show: of a sweep only what it varies. */
  private horizontal(): Quantity[] {
    const runs = this.chosenRuns(),
      { kind } = this.wish;
    if (runs.some((run) => run.is_branch) || !["", "bifurcation", "basin", "map"].includes(kind ?? ""))
      return this.quantities();
    const names = common(runs.map((run) => run.coordinates.map(({ name }) => name)));
    return names.flatMap((name) => runs[0].coordinates.find((one) => one.name === name) ?? []);
  }

  private change(change: Partial<PictureWish>): void {
    this.wish = { ...this.wish, ...change };
    // What is chosen is no longer the picture of the study that has this name.
    const { name: _, title: __, ...own } = this.wish;
    this.acts.wish(own);
  }
}
