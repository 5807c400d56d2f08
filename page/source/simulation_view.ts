import { actionButtons, type ActionActs, type ActionOrigin } from "./action_form.js";
import type { Action, Model, Motion } from "./contract.js";
import { append, button, fill, make, messageOf } from "./dom.js";
import { remember } from "./memory.js";
import { MotionView } from "./motion_view.js";
import { perUnit, shown, symbolOf } from "./numbers.js";
import { namesFor } from "./point_view.js";
import { isAtEnd, rangeAround, type Slid } from "./slider_range.js";
import type { Workspace } from "./workspace.js";

/** Where a simulation begins: which model, and values that replace those of the model. */
export interface SimulationStart {
  run: string | null; // whose model it is; null: the opened one
  text: string | null; // of a model that is being edited
  words: string;
  parameters: Record<string, number>;
  initial: Record<string, number>;
  mode: string;
  duration: number | null;
}

const patience = 200; // milliseconds
const usualSliders = 6; // further parameters are folded away

/** What can be done from the values of sliders; the server refuses what the model does not allow. */
const usualActions: Action[] = [
  { name: "simulate", title: "Simulate", words: "the motion for the values of the sliders", along: 0 },
  { name: "sweep", title: "Sweep", words: "what motions settle on as a parameter changes", along: 1 },
  { name: "orbit", title: "Find the orbit", words: "the periodic orbit that the motion settles on", along: 0 },
];

/** The same action in words that hold wherever the sliders are. */
function ofSliders(action: Action): Action {
  return { ...action, words: usualActions.find(({ name }) => name === action.name)?.words ?? action.words };
}

/** Sliders of parameters: the motion is computed again as they move. */
export class SimulationView {
  readonly root = make("div", { class: "simulation" });
  private readonly heading = make("div");
  private readonly words = make("p", { class: "note" }); // where the motion begins
  private readonly sliders = make("div", { class: "sliders" });
  private readonly message = make("p", { class: "note", role: "status" });
  private readonly motion = new MotionView();
  private model: Model | null = null;
  private start: SimulationStart | null = null;
  private asked: AbortController | null = null;
  private askedAt = 0;
  private last: Motion | null = null;
  private waiting = false;
  private running = false;
  private changed = new Set<() => void>(); // forms that follow the sliders
  private base: Model | null = null; // from which runs without values of their own begin
  private readonly shown = new Map<string, (value: number) => void>(); // what shows a value on its slider

  constructor(
    private readonly workspace: Workspace,
    private readonly acts: ActionActs,
  ) {
    append(this.root, this.heading, this.sliders, this.message, this.motion.root);
    this.motion.clear();
    fill(this.heading, make("p", { class: "note" }, "Choose a point and “Simulate with sliders”, or open a model."));
  }

  /** The opened model, as its file is now. */
  setBase(model: Model): void {
    this.base = model;
  }

  get isEmpty(): boolean {
    return this.start === null;
  }

  /** What is simulated, to be simulated again after a reload; an edited text of a model is kept elsewhere. */
  get kept(): SimulationStart | null {
    return this.start?.text ? null : this.start;
  }

  begin(start: SimulationStart, model: Model): void {
    this.model = model;
    this.start = { ...start, parameters: { ...start.parameters }, initial: { ...start.initial } };
    this.changed = new Set();
    this.last = null;
    fill(this.heading, make("h2", {}, model.name), this.words, ...this.actions(model));
    this.beginFrom(start.words);
    this.fillSliders(model);
    this.simulate();
  }

  /** Says where the motion begins, here and after a reload. */
  private beginFrom(words: string): void {
    if (this.start) this.start.words = words;
    const edited = this.start?.text ? " The text of the model was edited, and is not saved." : "";
    this.words.textContent = `${words}${edited}`;
  }

  /** Whether an edited text is simulated. */
  get isOfText(): boolean {
    return Boolean(this.start?.text);
  }

  private actions(model: Model): HTMLElement[] {
    if (this.start?.text) {
      const row = make("div", { class: "row", role: "group", "aria-label": "Go on from here" });
      const why = "Runs are computed with the model that is stored: save this text under “Model” first.";
      for (const { title } of usualActions)
        append(
          row,
          button(title, () => undefined, { disabled: true, title: why }),
        );
      return [row, make("p", { class: "note" }, why)];
    }
    const view = this;
    const origin: ActionOrigin = {
      run: this.start?.run ?? null,
      number: null,
      get parameters() {
        return model.parameters.map((one) => ({ ...one, value: view.start?.parameters[one.name] ?? one.value }));
      },
      actions: model.actions && model.actions.length > 0 ? model.actions.map(ofSliders) : usualActions,
      options: () => this.options(model),
      onChange: (act) => this.changed.add(act),
    };
    return actionButtons(this.workspace, origin, this.acts, () => Promise.resolve(model));
  }

  /** Keys of a run that begins with the values of the sliders: those that differ from what it has without them. */
  private async options(model: Model): Promise<Record<string, unknown>> {
    const { start, base } = this;
    if (!start) return {};
    const study = await this.workspace.source.workshop?.study().catch(() => null);
    const known = base?.name === model.name && !setsForAll(study?.text ?? "") ? base : null;
    const set: Record<string, number> = {},
      from: Record<string, number> = {};
    for (const { name, value, dependent } of model.parameters) {
      const now = start.parameters[name] ?? value;
      const usual = known?.parameters.find((one) => one.name === name)?.value;
      if (!dependent && now !== null && now !== usual) set[name] = now;
    }
    for (const { name, initial } of model.states) {
      // What was not chosen may follow from parameters.
      const now = start.initial[name] ?? (known && !start.run ? null : (this.firstOf(name) ?? initial));
      const usual = known?.states.find((one) => one.name === name)?.initial;
      if (now !== null && now !== usual) from[name] = now;
    }
    const given = (values: Record<string, number>) => (Object.keys(values).length > 0 ? values : null);
    const mode = start.mode && start.mode !== model.initial_mode ? start.mode : null;
    return { set: given(set), from: given(from), mode };
  }

  private fillSliders(model: Model): void {
    const { start } = this;
    if (!start) return;
    const free = model.parameters.filter((one) => !one.dependent && one.value !== null);
    this.shown.clear();
    const rows = free.map((one) => {
      // Every value is sent, so that what is shown is what is simulated.
      const value = start.parameters[one.name] ?? one.value ?? 0;
      start.parameters[one.name] = value;
      const { root, show } = this.slider(
        one,
        value,
        { kind: "parameter" },
        (now) => (start.parameters[one.name] = now),
      );
      this.shown.set(one.name, show);
      return root;
    });
    const states = model.states.map((one) => {
      const value = start.initial[one.name] ?? one.initial ?? 0,
        slid: Slid = { kind: "state", period: one.cyclic ? one.period : null };
      const { root, show } = this.slider(one, value, slid, (now) => {
        start.initial[one.name] = now;
        this.beginFrom("From the initial state that the sliders have.");
      });
      this.shown.set(one.name, show);
      return root;
    });
    const duration = { name: "duration", unit: model.time_unit ?? "", words: "" };
    start.duration ??= model.duration ?? 100;
    const more = rows.slice(usualSliders);
    const initial = make("details", {}, make("summary", {}, "Initial state"), ...states);
    initial.open = this.sliders.querySelector<HTMLDetailsElement>("details.initial")?.open ?? false;
    initial.className = "initial";
    fill(
      this.sliders,
      ...rows.slice(0, usualSliders),
      more.length > 0 ? make("details", {}, make("summary", {}, `${more.length} more parameters`), ...more) : null,
      initial,
      this.slider(duration, start.duration, { kind: "duration" }, (value) => (start.duration = value)).root,
      make(
        "div",
        { class: "row" },
        button("From the model's initial state", () => this.fromModel(), {
          title: "the motion begins where the model says; parameters stay",
        }),
        button("Go on from where it ends", () => this.goOn(), { title: "the last state becomes the first one" }),
      ),
    );
  }

  /** A slider around a value, and a field for any value, which moves the slider's range. */
  private slider(
    { name, unit, words }: { name: string; unit: string; words: string },
    value: number,
    slid: Slid,
    set: (value: number) => void,
  ): { root: HTMLElement; show: (value: number) => void } {
    const slider = make("input", { type: "range", step: "any", "aria-label": name });
    const field = make("input", { type: "number", step: "any", "aria-label": `${name}, value` });
    let range: [number, number] = [0, 1],
      typing = false; // the field has a text that was not chosen yet
    const setRange = (around: number) => {
      range = rangeAround(around, slid);
      [slider.min, slider.max] = range.map(String);
      slider.value = String(around);
    };
    const choose = (chosen: number) => {
      set(chosen);
      this.simulate();
    };
    const show = (shownValue: number) => {
      setRange(shownValue);
      if (!typing || document.activeElement !== field) field.value = String(Number(shownValue.toPrecision(8)));
    };
    show(value);
    slider.addEventListener("input", () => {
      const chosen = Number(Number(slider.value).toPrecision(5));
      field.value = String(chosen);
      choose(chosen);
    });
    // A pointer that is held must not lose its place: another range comes when it is released.
    slider.addEventListener("change", () => isAtEnd(Number(slider.value), range) && setRange(Number(field.value)));
    field.addEventListener("input", () => (typing = true));
    field.addEventListener("change", () => {
      typing = false;
      const chosen = Number(field.value);
      const possible = field.value !== "" && Number.isFinite(chosen) && (slid.kind !== "duration" || chosen > 0);
      if (!possible)
        return this.refuse(`The ${name} needs a ${slid.kind === "duration" ? "positive number" : "number"}.`);
      setRange(chosen);
      choose(chosen);
    });
    const title = perUnit(symbolOf(name), unit);
    const meaning = words && words !== name ? make("span", { class: "words" }, words) : null;
    return { root: make("div", { class: "slider" }, make("span", {}, title), slider, field, meaning), show };
  }

  private refuse(problem: string): void {
    this.message.textContent = problem;
    this.message.className = "problem";
  }

  /**
   * Asks for the motion. While one is computed, only the newest further wish is kept. A slow one is given up for it; a
   * fast one is awaited, for otherwise nothing would be seen as long as the slider moves.
   */
  private simulate(): void {
    this.waiting = true;
    for (const act of this.changed) act();
    if (this.kept) remember("simulation", this.kept);
    if (!this.running) void this.run();
    else if (performance.now() - this.askedAt > patience) this.asked?.abort();
  }

  private async run(): Promise<void> {
    const { workshop } = this.workspace.source;
    this.running = true;
    while (this.waiting && workshop && this.start && this.model) {
      this.waiting = false;
      const asked = (this.asked = new AbortController());
      const { model } = this,
        { run, text, parameters, initial, mode, duration } = this.start;
      const { names, hidden } = namesFor(null, model);
      const before = (this.askedAt = performance.now());
      try {
        const motion = await workshop.simulate({ run, text, parameters, initial, mode, duration, names }, asked.signal);
        if (asked.signal.aborted || model !== this.model) continue;
        this.last = motion;
        this.motion.setMotion(motion, model, hidden, model.name);
        this.showOthers();
        this.message.textContent = `The motion was computed in ${shown(performance.now() - before, 2)} ms.`;
        this.message.className = "note";
      } catch (error) {
        if (asked.signal.aborted || model !== this.model) continue;
        this.refuse(messageOf(error));
        this.motion.clear(); // it would be that of other values
      }
    }
    this.running = false;
  }

  /** The first value of a state, or of a parameter, in the motion. */
  private firstOf(wanted: string): number | null {
    const column = this.last?.columns.findIndex(({ name }) => name === wanted) ?? -1;
    return column < 0 ? null : (this.last?.values[column][0] ?? null);
  }

  /** What was not chosen follows from the model's text, and from parameters. */
  private showOthers(): void {
    const chosen = { ...this.start?.parameters, ...this.start?.initial };
    for (const [name, show] of this.shown) {
      const value = chosen[name] === undefined ? this.firstOf(name) : null;
      if (value !== null) show(value);
    }
  }

  private fromModel(): void {
    const { start, model } = this;
    if (!start || !model) return;
    // All parameters are given, so that the opened model is the same one, with its own initial state.
    if (!start.text && this.base?.name === model.name) start.run = null;
    start.initial = {};
    start.mode = "";
    this.last = null;
    this.beginFrom("From the initial state of the model.");
    this.fillSliders(model);
    this.simulate();
  }

  private goOn(): void {
    const { last, start, model } = this;
    if (!last || !start || !model) return;
    for (const state of model.states) {
      const column = last.columns.findIndex(({ name }) => name === state.name);
      const value = column < 0 ? null : last.values[column][last.values[column].length - 1];
      if (value !== null && value !== undefined) start.initial[state.name] = value;
    }
    start.mode = last.modes?.[last.modes.length - 1] ?? start.mode;
    this.beginFrom("From where the motion before ended.");
    this.fillSliders(model);
    this.simulate();
  }
}

/** Whether a study has values for all its runs, which those of the model do not tell. */
function setsForAll(text: string): boolean {
  const [beginning] = text.split(/^\s*\[/m);
  return /^\s*set\s*[.=]/m.test(beginning) || /^\s*\[set\]/m.test(text);
}
