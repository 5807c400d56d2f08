import type { Action, Model, NamedNumber, Num, Point, StartedJob, TripAnswer } from "./contract.js";
import { dataTable } from "./data_table.js";
import { append, button, choice, fill, labelled, make, messageOf, problem } from "./dom.js";
import { recall, remember } from "./memory.js";
import { shown, symbolOf } from "./numbers.js";
import type { Workshop } from "./source.js";
import { TableText } from "./table_text.js";
import { standsAlone, varied, type Workspace } from "./workspace.js";

export interface ActionActs {
  compute(text: string): Promise<StartedJob>; // a table [runs.NAME], which is added to the study
  trip(title: string, answer: TripAnswer): void;
  simulate(point: Point): void;
}

/** Where something begins: a point, or a state of a model. */
export interface ActionOrigin {
  run: string | null;
  number: number | null;
  parameters: NamedNumber[];
  coordinates?: NamedNumber[];
  actions: Action[];
  options?: () => Promise<Record<string, unknown>>; // further keys of the run
  onChange?: (act: () => void) => void; // of values and options
}

/** A button that is no action of the server, and puts what it has to say into a place. */
export interface FurtherButton {
  title: string;
  words: string;
  act(place: HTMLElement): void;
}

/** What can be done from a point: each button opens a form below. */
export function actionButtons(
  workspace: Workspace,
  origin: ActionOrigin,
  acts: ActionActs,
  model: () => Promise<Model>,
  more: FurtherButton[] = [],
): HTMLElement[] {
  const { workshop } = workspace.source;
  if (!workshop || !workspace.session.can_compute) return [];
  const place = make("div", { class: "action-place" });
  const row = make("div", { class: "row", role: "group", "aria-label": "Go on from here" });
  // A single orbit goes along no parameter, so that none is another one.
  const isSingle = standsAlone(workspace.run(origin.run ?? ""));
  for (const action of (origin.actions ?? []).filter(({ name }) => name !== "another" || !isSingle))
    append(
      row,
      button(
        action.title,
        async () => {
          const form = new ActionForm(workspace, workshop, origin, action, acts, await model());
          fill(place, form.root);
          form.root.querySelector<HTMLElement>("input, select, button")?.focus();
        },
        { title: action.words || null },
      ),
    );
  for (const one of more)
    append(
      row,
      button(one.title, () => one.act(place), { title: one.words }),
    );
  return [row, place];
}

/** What can be asked about a point at once, without adding to the study. */
export function pointButtons(
  workspace: Workspace,
  point: Point,
  model: Model | null,
  acts: ActionActs,
): FurtherButton[] {
  const { workshop } = workspace.source,
    more: FurtherButton[] = [];
  if (!workshop) return more;
  if (point.kind !== "record")
    more.push({
      title: "Simulate with sliders",
      words: "simulate from here while sliders move",
      act: () => acts.simulate(point),
    });
  if (point.kind !== "orbit") return more;
  if (point.type === "GR" || point.type === "DG")
    more.push({
      title: "What does the grazing do?",
      words: "the discontinuity map and its verdict",
      act: (place) => void showGrazing(workshop, point, place),
    });
  if ((point.type === "GR" || point.type === "SN") && canTrip(model))
    more.push({
      title: "Will it trip?",
      words: "the time until the motion leaves, by how far the parameter is beyond this point",
      act: (place) => void showTrip(workshop, point, acts, place),
    });
  return more;
}

/** Whether something trips in a model, by what its author says of it. */
function canTrip(model: Model | null): boolean {
  return model !== null && /switch|\btrip|snap-?through|pull-?in\b/i.test(`${model.name} ${model.text}`);
}

async function showGrazing(workshop: Workshop, point: Point, place: HTMLElement): Promise<void> {
  try {
    const { verdict, words, facts } = await workshop.grazing(point.run, point.number);
    const columns = ["what", "value", "meaning"].map((name) => ({ name, unit: "" }));
    fill(
      place,
      make("p", {}, make("b", {}, verdict), words && words !== verdict ? `: ${words}` : ""),
      dataTable({ columns, rows: facts }, "The discontinuity map"),
    );
  } catch (error) {
    fill(place, problem(messageOf(error)));
  }
}

async function showTrip(workshop: Workshop, point: Point, acts: ActionActs, place: HTMLElement): Promise<void> {
  fill(place, make("p", { role: "status" }, "computing…"));
  try {
    const answer = await workshop.trip(point.run, point.number, {});
    const words = Array.isArray(answer.words) ? answer.words : [answer.words];
    fill(place, ...words.map((line) => make("p", {}, line)));
    if (answer.figure) acts.trip(`Trips at ${point.run} ${point.name || point.number}`, answer);
  } catch (error) {
    fill(place, problem(messageOf(error)));
  }
}

/** A parameter along which something goes, with its bounds. */
interface AlongField {
  name: () => string;
  low: HTMLInputElement;
  high: HTMLInputElement;
}

const keptParameter = "along"; // that was chosen last
const usualPoints = 201; // of a sweep
const mostPoints = 100000; // that a form asks for; each is a motion

/** Asks along which parameters, and shows the text that does it, which follows the fields. */
class ActionForm {
  readonly root = make("form", { class: "action-form" });
  private readonly fields: AlongField[] = [];
  private readonly points = make("input", { type: "number", min: 2, step: 1, value: usualPoints });
  private readonly direction = choice(
    [
      { value: "up", text: "up" },
      { value: "down", text: "down" },
      { value: "both", text: "up, then down" },
    ],
    "up",
    () => this.follow(),
  );
  private readonly table: TableText;

  constructor(
    private readonly workspace: Workspace,
    private readonly workshop: Workshop,
    private readonly origin: ActionOrigin,
    private readonly action: Action,
    acts: ActionActs,
    private readonly model: Model,
  ) {
    this.table = new TableText(workspace, (text) => acts.compute(text));
    this.root.setAttribute("aria-label", action.title);
    this.root.addEventListener("submit", (event) => event.preventDefault());
    append(this.root, make("p", {}, action.words || action.title));
    for (let index = 0; index < action.along; ++index) append(this.root, this.parameterField(index));
    if (this.isSweep) append(this.root, this.sweepFields());
    append(this.root, this.table.root);
    origin.onChange?.(() => this.root.isConnected && this.follow());
    this.follow();
  }

  private get isSweep(): boolean {
    return this.action.name === "sweep" && this.action.along > 0;
  }

  private present(name: string): Num {
    const { parameters, coordinates = [] } = this.origin;
    return [...coordinates, ...parameters].find((one) => one.name === name)?.value ?? null;
  }

  /** What was chosen before, or what varies along other runs of the model; otherwise a frequency. */
  private usualParameter(names: string[]): string | undefined {
    const { runs } = this.workspace;
    const others = runs.filter((run) => run.model === this.model.name && run.points > 1).flatMap(varied);
    const words = new Map(this.model.parameters.map((one) => [one.name, `${one.words} ${one.text ?? ""}`]));
    const before = [recall<string>(keptParameter) ?? "", ...others];
    return (
      before.find((name) => names.includes(name)) ?? names.find((name) => /frequency/i.test(words.get(name) ?? ""))
    );
  }

  private parameterField(index: number): HTMLElement {
    const free = this.model.parameters.filter((one) => !one.dependent),
      names = free.map(({ name }) => name);
    const proposed = this.action.parameters ?? [];
    // Where a run goes along a parameter already, that one is proposed, with its bounds.
    const run = this.workspace.run(this.origin.run ?? ""),
      own = this.origin.number !== null && run && !standsAlone(run) && varied(run).some((name) => names.includes(name));
    const usual = (own || index > 0 ? undefined : this.usualParameter(names)) ?? proposed[index]?.name ?? names[index];
    const low = make("input", { type: "number", step: "any", required: true });
    const high = make("input", { type: "number", step: "any", required: true });
    const now = make("span", { class: "note" });
    const setRange = (name: string) => {
      const value = this.present(name) ?? 0;
      const known = proposed.find((one) => one.name === name);
      const [a, b] = value === 0 ? [-1, 1] : [0.5 * value, 2 * value];
      low.value = String(known?.least ?? Number(Math.min(a, b).toPrecision(3)));
      high.value = String(known?.greatest ?? Number(Math.max(a, b).toPrecision(3)));
      now.textContent = `now ${shown(value)}`;
    };
    const select = choice(
      free.map(({ name, words }) => ({ value: name, text: words ? `${symbolOf(name)}: ${words}` : symbolOf(name) })),
      usual,
      (name) => {
        setRange(name);
        remember(keptParameter, name);
        this.follow();
      },
    );
    setRange(usual);
    this.origin.onChange?.(() => (now.textContent = `now ${shown(this.present(select.value))}`));
    for (const field of [low, high]) field.addEventListener("input", () => this.follow());
    this.fields.push({ name: () => select.value, low, high });
    return make("div", { class: "row" }, labelled("along", select), labelled("from", low), labelled("to", high), now);
  }

  private sweepFields(): HTMLElement {
    this.points.addEventListener("input", () => this.follow());
    return make("div", { class: "row" }, labelled("points", this.points), labelled("direction", this.direction));
  }

  /** What is wrong with the fields; empty: nothing. */
  private mistake(): string {
    const names = this.fields.map(({ name }) => name());
    if (new Set(names).size < names.length) return "Choose two different parameters.";
    for (const { name, low, high } of this.fields) {
      const [least, greatest] = [low, high].map((field) => (field.value === "" ? NaN : Number(field.value)));
      if (!(least < greatest)) return `The bounds of ${name()}: give the lower one first, then a greater one.`;
      const value = this.present(name()),
        slack = 1e-6 * (greatest - least);
      if (!this.isSweep && value !== null && (value < least - slack || value > greatest + slack))
        return `The bounds of ${name()} leave out its present value ${shown(value)}, where the run begins.`;
    }
    const points = Number(this.points.value);
    if (this.isSweep && !(Number.isInteger(points) && points >= 2)) return "A sweep has two points at least.";
    if (this.isSweep && points > mostPoints)
      return `${points} motions take very long: choose at most ${mostPoints} points here; the text of the study takes more.`;
    return "";
  }

  /** The text follows the fields. */
  private follow(): void {
    const mistake = this.mistake();
    if (mistake) return this.table.refuse(mistake);
    const along: Record<string, [number, number]> = {};
    for (const { name, low, high } of this.fields) along[name()] = [Number(low.value), Number(high.value)];
    const { run, number } = this.origin,
      action = this.action.name;
    this.table.propose(async () => {
      const options = { ...(await this.origin.options?.()) };
      if (this.isSweep) Object.assign(options, this.sweepOptions(along, options.set));
      return this.workshop.propose({ run, number, action, along, options });
    });
  }

  private sweepOptions(along: Record<string, [number, number]>, set: unknown): Record<string, unknown> {
    const [[name, [from, to]]] = Object.entries(along),
      direction = this.direction.value;
    const { [name]: _, ...others } = (set ?? {}) as Record<string, number>; // what varies has no other value
    return {
      vary: { [name]: { from, to, points: Number(this.points.value) } },
      direction: direction === "up" ? null : direction,
      set: Object.keys(others).length > 0 ? others : null,
    };
  }
}
