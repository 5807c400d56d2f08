import { actionButtons, pointButtons, type ActionActs } from "./action_form.js";
import type { Model, NamedNumber, Num, Point, Run } from "./contract.js";
import { dataTable, valueTable } from "./data_table.js";
import { Diagram } from "./diagram.js";
import { append, fill, make, messageOf, problem } from "./dom.js";
import { expressionsOf } from "./model_drawing.js";
import { MotionView } from "./motion_view.js";
import { multiplierPanel } from "./multiplier_panel.js";
import { shown, symbolOf, withUnit } from "./numbers.js";
import { standsAlone, varied, type Selection, type Workspace } from "./workspace.js";

const marginal = new Set(["SN", "PD", "NS", "BP", "SB", "HB", "BT", "ZH", "HH", "GH"]);
const delay = 60; // milliseconds: a key that is held down does not ask for every point on its way

/** All that is known of the chosen point: its orbit, multipliers, certificate, values, and what can be done from it. */
export class PointView {
  readonly root = make("div", { class: "point" });
  private readonly heading = make("div");
  private readonly actions = make("div", { class: "actions" });
  private readonly motion = new MotionView();
  private readonly multiplierPlace = make("div", { class: "multipliers" });
  private readonly eigenvaluePlace = make("div", { class: "multipliers eigenvalues" });
  private readonly facts = make("div");
  private multipliers: Diagram | null = null;
  private asked: AbortController | null = null;
  private timer = 0;
  private shown: Selection | null = null;
  private awaitsFocus = false;
  private readonly models = new Map<string, Promise<Model>>();

  constructor(
    private readonly workspace: Workspace,
    private readonly acts: ActionActs,
  ) {
    append(this.root, this.heading, this.actions, this.motion.root);
    append(this.root, this.multiplierPlace, this.eigenvaluePlace, this.facts);
    this.motion.clear();
    fill(this.heading, make("p", { class: "note" }, "Click a point of a diagram to see its orbit here."));
    workspace.on("selection", (selection) => {
      clearTimeout(this.timer);
      this.timer = window.setTimeout(() => selection && void this.show(selection), delay);
    });
    workspace.on("runs", (changed) => {
      changed.forEach((run) => this.models.delete(run));
      // The point of a run that was computed again is another one; but what is being filled in stays.
      const { selection } = workspace;
      const isOther = selection && changed.has(selection.run) && workspace.run(selection.run)?.status === "complete";
      if (isOther && !this.actions.querySelector(".action-form")) void this.show(selection);
    });
  }

  /** The keyboard goes to the first button, or to the point's title, as soon as they are those of the chosen point. */
  focus(): void {
    const { selection } = this.workspace;
    this.awaitsFocus = selection?.run !== this.shown?.run || selection?.number !== this.shown?.number;
    if (this.awaitsFocus) return;
    const first = this.actions.querySelector<HTMLElement>("button") ?? this.heading.querySelector<HTMLElement>("h2");
    first?.focus();
  }

  modelOf(run: string): Promise<Model> {
    let model = this.models.get(run);
    if (!model) {
      model = this.workspace.source.model(run);
      this.models.set(run, model);
      model.catch(() => this.models.delete(run));
    }
    return model;
  }

  private async show({ run, number }: Selection): Promise<void> {
    this.asked?.abort();
    const asked = (this.asked = new AbortController());
    const { source } = this.workspace;
    try {
      const [{ point, note }, model] = await Promise.all([
        source.point(run, number, asked.signal),
        this.modelOf(run).catch(() => null),
      ]);
      if (asked.signal.aborted) return;
      this.showPoint(point, note, model);
      const { names, hidden } = namesFor(point, model);
      const motion = await source.motion(run, point.number, names, asked.signal);
      if (!asked.signal.aborted)
        this.motion.setMotion(motion, model, hidden, `${run} ${point.name || point.label || point.number}`);
    } catch (error) {
      if (asked.signal.aborted) return;
      this.motion.clear();
      append(this.heading, problem(messageOf(error)));
    }
  }

  private showPoint(point: Point, note: string, model: Model | null): void {
    const run = this.workspace.run(point.run);
    // The points of a run that finds an orbit or equilibria are the ends of no branch.
    const isFound = standsAlone(run) && point.type === "EP";
    const what = isAtRest(point) ? "equilibrium" : "orbit",
      foundWords = isAtRest(point) ? what : "periodic orbit";
    const name = isFound ? "" : point.name || point.label;
    const typeWords = isFound ? foundWords : point.type === "EP" ? "end of the branch" : point.type_words;
    const type = [typeWords, detailInWords(point.detail)].filter((text) => text && text !== "regular").join(": ");
    const badges = make("p", { class: "badges" });
    if (point.kind === "orbit") {
      // Where a multiplier is on the circle, rounding errors would decide.
      if (!marginal.has(point.type))
        append(
          badges,
          make("span", { class: point.stable ? "badge good" : "badge warn" }, point.stable ? "stable" : "unstable"),
        );
      if (point.unphysical) append(badges, make("span", { class: "badge bad" }, "unphysical"));
    }
    fill(
      this.heading,
      make(
        "h2",
        { tabindex: -1 },
        `${point.run}: ${name || (isFound ? foundName(what, point, run) : `point ${point.number}`)}`,
      ),
      name ? make("p", {}, `point ${point.number}${type ? `: ${type}` : ""}`) : type ? make("p", {}, type) : null,
      badges,
      make("p", { class: "summary" }, this.summary(point)),
      note ? make("p", { class: "problem", role: "status" }, note) : null,
      run?.kind === "basin"
        ? make(
            "p",
            { class: "note" },
            "The motion below is that of the attractor on which it settles, not the way there.",
          )
        : null,
    );
    const more = pointButtons(this.workspace, point, model, this.acts);
    fill(this.actions, ...actionButtons(this.workspace, point, this.acts, () => this.modelOf(point.run), more));
    this.showMultipliers(point);
    this.showEigenvalues(point, model?.time_unit ?? "");
    this.shown = { run: point.run, number: point.number };
    if (this.awaitsFocus) this.focus();
    const coordinates = this.variedOf(point),
      states = new Set(run?.states.map(({ name }) => name));
    fill(
      this.facts,
      valueTable(
        "Parameters that vary",
        coordinates.filter((one) => !states.has(one.name)),
      ),
      valueTable(
        "Initial states",
        coordinates.filter((one) => states.has(one.name)),
      ),
      valueTable("Values", point.values),
      section("Solution", true, point.facts.length > 0 ? factTable(point.facts) : null),
      point.signature ? make("p", { class: "signature" }, make("b", {}, "Signature "), point.signature) : null,
      section(
        "Certificate and tables",
        false,
        ...point.tables.filter((table) => table.rows.length > 0).map((table) => dataTable(table)),
      ),
      section("All parameters", false, valueTable("All parameters", point.parameters, false)),
    );
  }

  private variedOf(point: Point): NamedNumber[] {
    const run = this.workspace.run(point.run);
    return point.coordinates.filter(({ name }) => !run || varied(run).includes(name));
  }

  /** What varies along the run; of a single orbit, what varies along other runs of its model, or its first parameters. */
  private placeOf(point: Point): NamedNumber[] {
    const { workspace } = this,
      run = workspace.run(point.run);
    if (!run || !standsAlone(run)) return this.variedOf(point);
    const others = new Set(workspace.runs.filter(({ model }) => model === run.model).flatMap(varied));
    const chosen = point.coordinates.filter(({ name }) => others.has(name));
    return (chosen.length > 0 ? chosen : point.coordinates).slice(0, 4);
  }

  /** Where the point is, and its values, in a line. */
  private summary(point: Point): string {
    const period: NamedNumber[] =
      point.period === null ? [] : [{ name: "period", value: point.period, unit: "", words: "" }];
    const shownValues = point.values.filter((one) => one.name !== "period").slice(0, 4);
    const values = [...this.placeOf(point), ...shownValues, ...period];
    return values.map(({ name, value, unit }) => `${symbolOf(name)} = ${withUnit(value, unit)}`).join("  ·  ");
  }

  private showMultipliers({ multipliers, half_multipliers: halves }: Point): void {
    this.multiplierPlace.hidden = multipliers.length === 0;
    if (multipliers.length === 0) return;
    const panel = multiplierPanel(multipliers, halves ?? []);
    const known = this.multipliers;
    const list = make(
      "ul",
      { class: "numbers", "aria-label": "Multipliers" },
      ...multipliers.map((one) => make("li", {}, complexText(one))),
    );
    if (known) {
      known.setPanel(panel);
      this.multiplierPlace.querySelector("ul")?.replaceWith(list);
      return;
    }
    this.multipliers = new Diagram(panel, { name: "Multipliers and the unit circle", equalAspect: true });
    fill(
      this.multiplierPlace,
      make("h3", {}, "Multipliers"),
      make("div", { class: "pair" }, this.multipliers.root, list),
    );
  }

  private showEigenvalues({ eigenvalues }: Point, timeUnit: string): void {
    const all = eigenvalues ?? []; // pages that were exported before have none
    this.eigenvaluePlace.hidden = all.length === 0;
    const rows = all.map((one) => make("li", {}, eigenvalueText(one, timeUnit)));
    fill(
      this.eigenvaluePlace,
      make("h3", {}, timeUnit ? `Eigenvalues, per ${timeUnit}` : "Eigenvalues"),
      make("ul", { class: "numbers", "aria-label": "Eigenvalues" }, ...rows),
    );
  }
}

/** Of an equilibrium: how fast disturbances of it grow, and how they oscillate. */
function eigenvalueText([re, im]: [Num, Num], unit: string): string {
  const real = shown(re, 5);
  if (!im) return real;
  const period = `period ${withUnit((2 * Math.PI) / Math.abs(im), unit, 5)}`;
  return `${real} ${im < 0 ? "−" : "+"} ${shown(Math.abs(im), 5)}i, ${period}`;
}

function isAtRest(point: Point): boolean {
  return point.signature === "equilibrium";
}

/** What a run has found, by its number where it has found several. */
function foundName(what: string, point: Point, run: Run | undefined): string {
  return run && run.points > 1 ? `${what} ${point.number + 1} of ${run.points}` : `the ${what}`;
}

function section(title: string, open: boolean, ...content: (HTMLElement | null)[]): HTMLElement | null {
  const known = content.filter((one): one is HTMLElement => one !== null);
  if (known.length === 0) return null;
  const details = make("details", {}, make("summary", {}, title), ...known);
  details.open = open;
  return details;
}

/** What is known of a solution, line by line. */
function factTable(facts: [string, string | number][]): HTMLElement {
  const row = ([fact, value]: [string, string | number]) => {
    const text = typeof value === "number" ? shown(value, 8) : value.replace(/^1 (\w+)s$/, "1 $1");
    return make("tr", {}, make("th", { scope: "row" }, fact), make("td", {}, text));
  };
  const body = make("tbody", {}, ...facts.map(row));
  return make("table", {}, make("caption", { class: "unseen" }, "Solution"), body);
}

/** "unphysical beyond: event 'right' happens within segment 1", as one who looks at the motion says it. */
function detailInWords(detail: string): string {
  const passed = /unphysical beyond: event '([^']+)' happens within segment \d+/.exec(detail);
  if (!passed) return detail;
  const words = `the orbit touches '${passed[1]}'; beyond, it would pass through it`;
  return words;
}

function complexText([re, im]: [Num, Num]): string {
  const size = Math.hypot(re ?? NaN, im ?? NaN);
  if (!im) return shown(re, 6);
  return `${shown(re, 5)} ${im < 0 ? "−" : "+"} ${shown(Math.abs(im), 5)}i, size ${shown(size, 5)}`;
}

/** The columns of a motion: states, quantities of the model, and what its drawing needs, which is not offered. */
export function namesFor(point: Point | null, model: Model | null): { names: string[]; hidden: Set<string> } {
  if (!model || point?.kind === "record") return { names: [], hidden: new Set() };
  const shownNames = [...model.states.map(({ name }) => name), ...(model.quantities ?? []).map(({ name }) => name)];
  const drawn = model.drawing ? expressionsOf(model.drawing) : [];
  const hidden = drawn.filter((expression) => !shownNames.includes(expression));
  return { names: [...shownNames, ...hidden], hidden: new Set(hidden) };
}
