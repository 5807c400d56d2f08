import { appearance } from "./appearance.js";
import type { Figure, Model, Motion } from "./contract.js";
import { Diagram } from "./diagram.js";
import { exportMenu } from "./export_menu.js";
import { append, checkbox, choice, fill, labelled, make } from "./dom.js";
import { endingWords } from "./motion_ending.js";
import { areProportional, columnIndex, cyclesOf, motionPanel, movingColumns, valuesAt } from "./motion_rows.js";
import { ModelDrawing } from "./model_drawing.js";
import { Player } from "./player.js";
import { symbolOf } from "./numbers.js";

/** Which quantities a user looks at; kept when the next motion has them too. */
interface Choice {
  x: string;
  y: string;
  histories: Set<string>;
}

const usualHistories = 2;

/** A motion: histories, a portrait of any two quantities, the drawing of the model, and an animation of all of them. */
export class MotionView {
  readonly root = make("div", { class: "motion" });
  private readonly scene = make("div", { class: "scene-place" });
  private readonly chooser = make("div", { class: "row" });
  private readonly portraitPlace = make("div", { class: "portrait-place" });
  private readonly historyChooser = make("div", { class: "row" });
  private readonly historyPlace = make("div", { class: "histories" });
  private readonly note = make("p", { class: "problem", role: "status" });
  private offered: string[] = []; // quantities that have changed in a motion with these columns
  private readonly player = new Player((time) => this.showTime(time));
  private portrait: Diagram | null = null;
  private histories = new Map<string, Diagram>();
  private drawing: ModelDrawing | null = null;
  private drawn: unknown = null;
  private title = "";
  private motion: Motion | null = null;
  private chosen: Choice | null = null;
  private now = 0;
  private readonly exports: HTMLElement;

  constructor() {
    append(this.root, this.note, this.scene, this.player.root, this.chooser, this.portraitPlace, this.historyChooser);
    append(this.root, this.historyPlace);
    this.exports = exportMenu({
      title: () => this.title,
      figure: () => this.figure,
      diagrams: () => this.diagrams,
    });
    appearance.onChange(() => this.showTime(this.now));
  }

  /** The portrait, and the histories below. */
  private get diagrams(): Diagram[] {
    return [...(this.portrait ? [this.portrait] : []), ...this.histories.values()];
  }

  private get figure(): Figure {
    return { title: this.title, columns: 1, symbols: [], panels: this.diagrams.map((diagram) => diagram.panel) };
  }

  clear(): void {
    this.player.pause();
    this.root.hidden = true;
  }

  /** @param hidden names of columns that only the drawing needs; @param title for exported files */
  setMotion(motion: Motion, model: Model | null, hidden: Set<string>, title: string): void {
    this.title = title;
    this.root.hidden = false;
    const ending = endingWords(motion);
    this.note.textContent = ending;
    this.note.hidden = ending === "";
    const atRest = motion.at_rest === true;
    const isEmpty = (motion.values[0]?.length ?? 0) < (atRest ? 1 : 2);
    this.root.classList.toggle("empty", isEmpty);
    for (const place of [this.player.root, this.historyChooser, this.historyPlace]) place.hidden = atRest;
    if (atRest) this.player.pause();
    if (isEmpty) return this.player.pause(); // what is chosen stays for the next motion
    const before = this.motion;
    this.motion = motion;
    this.setDrawing(model);
    const columnNames = motion.columns.map(({ name }) => name);
    const sameNames = before !== null && before.columns.map(({ name }) => name).join() === columnNames.join();
    const moving = new Set(movingColumns(motion).map((index) => columnNames[index]));
    if (sameNames) for (const name of this.offered) moving.add(name); // a state that rests now is no other choice
    const names = columnNames.filter((name, index) => index > 0 && moving.has(name) && !hidden.has(name));
    const sameOffer = this.offered.join() === names.join();
    this.offered = names;
    if (!this.chosen || !names.includes(this.chosen.x) || !names.includes(this.chosen.y))
      this.chosen = usual(motion, names, model);
    else for (const name of this.chosen.histories) if (!names.includes(name)) this.chosen.histories.delete(name);
    if (!sameNames || !sameOffer || this.chooser.childElementCount === 0) this.fillChoosers(names);
    this.draw();
    const times = motion.values[0],
      last = times[times.length - 1] ?? 1;
    const cycles = cyclesOf(motion.values[Math.max(0, columnIndex(motion, this.chosen.y))]);
    this.player.setMotion(times[0] ?? 0, last, motion.columns[0].unit, cycles, before !== null);
  }

  private setDrawing(model: Model | null): void {
    const drawing = model?.drawing ?? null;
    if (JSON.stringify(drawing) === this.drawn) return;
    this.drawn = JSON.stringify(drawing);
    const drifting = model?.states.filter((state) => state.drifting).map(({ name }) => name) ?? [];
    this.drawing = drawing ? new ModelDrawing(drawing, drifting) : null;
    this.scene.hidden = !this.drawing;
    fill(this.scene, this.drawing?.canvas, drawing?.text ? make("p", { class: "note" }, drawing.text) : null);
  }

  private fillChoosers(names: string[]): void {
    const { chosen } = this;
    if (!chosen) return;
    const options = ["t", ...names].map((value) => ({ value, text: symbolOf(value) }));
    const select = (key: "x" | "y") =>
      choice(options, chosen[key], (value) => {
        chosen[key] = value;
        this.draw();
        this.showTime(this.now);
      });
    fill(
      this.chooser,
      make("b", {}, "Portrait"),
      labelled("x", select("x")),
      labelled("y", select("y")),
      make("span", { class: "space" }),
      this.exports,
    );
    fill(this.historyChooser, make("b", {}, "Histories"));
    for (const name of names)
      append(
        this.historyChooser,
        checkbox(symbolOf(name), chosen.histories.has(name), (on) => {
          if (on) chosen.histories.add(name);
          else chosen.histories.delete(name);
          this.draw();
          this.showTime(this.now);
        }),
      );
  }

  private draw(): void {
    const { motion, chosen } = this;
    if (!motion || !chosen) return;
    const x = Math.max(0, columnIndex(motion, chosen.x)),
      y = Math.max(0, columnIndex(motion, chosen.y));
    const panel = motionPanel(motion, x, y);
    if (this.portrait) this.portrait.setPanel(panel);
    else {
      this.portrait = new Diagram(panel, { name: "Portrait of the motion" });
      this.portraitPlace.append(this.portrait.root);
    }
    for (const [name, diagram] of this.histories)
      if (!chosen.histories.has(name)) {
        diagram.destroy();
        this.histories.delete(name);
      }
    for (const name of this.offered.filter((one) => chosen.histories.has(one))) {
      const column = columnIndex(motion, name);
      const history = motionPanel(motion, 0, column);
      history.y.words = ""; // there is no room for them
      const known = this.histories.get(name);
      if (known) known.setPanel(history);
      else {
        const diagram = new Diagram(history, { name: `History of ${name}` });
        this.histories.set(name, diagram);
      }
    }
    // They stand in the order of the columns, whichever was chosen first.
    const order = this.offered.flatMap((name) => this.histories.get(name)?.root ?? []);
    if (order.some((root, index) => this.historyPlace.children[index] !== root)) append(this.historyPlace, ...order);
  }

  private showTime(time: number): void {
    const { motion, chosen } = this;
    this.now = time;
    if (!motion || !chosen || this.root.hidden) return;
    const { row, values } = valuesAt(motion, time);
    const value = (name: string) => values[Math.max(0, columnIndex(motion, name))];
    this.portrait?.mark("moving", { x: value(chosen.x), y: value(chosen.y) });
    for (const [name, diagram] of this.histories) diagram.mark("moving", { x: time, y: value(name) });
    this.drawing?.draw(motion, row, values);
  }
}

/** What pictures of the model show; otherwise the first two quantities that are no phases. */
function usual(motion: Motion, names: string[], model: Model | null): Choice {
  const plain = names.filter((name) => !motion.columns[columnIndex(motion, name)].period);
  const known = (list: string[] | undefined) => (list ?? []).filter((name) => names.includes(name));
  const portrait = known(model?.portrait),
    histories = known(model?.histories);
  // Two names of one quantity, as a record has of what it measures, are no portrait.
  const column = (name: string) => motion.values[columnIndex(motion, name)];
  const other = plain.slice(1).find((name) => !areProportional(column(plain[0]), column(name)));
  const pair = portrait.length === 2 ? portrait : other ? [plain[0], other] : ["t", plain[0] ?? names[0] ?? "t"];
  const shown = (histories.length > 0 ? histories : plain).slice(0, usualHistories);
  return { x: pair[0], y: pair[1], histories: new Set(shown) };
}
