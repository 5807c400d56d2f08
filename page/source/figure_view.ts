import { Diagram } from "./diagram.js";
import { button, checkbox, fill, make, messageOf, problem } from "./dom.js";
import type { Figure, FigureAnswer, PictureWish, StudyPicture, Table } from "./contract.js";
import { dataTable } from "./data_table.js";
import { exportMenu } from "./export_menu.js";
import type { View } from "./frame.js";
import { legendElement } from "./legend.js";
import type { Hit } from "./nearest.js";
import { pointAfter, describeHit } from "./point_steps.js";
import { PictureChooser } from "./picture_chooser.js";
import { recoloured, type Colouring } from "./colouring.js";
import { appearance } from "./appearance.js";
import { figureOf, partsOf } from "./joined_figure.js";
import { hiddenPoints } from "./prepared_panel.js";
import { pictureText } from "./picture_text.js";
import { namedWish, seenWish } from "./seen_wish.js";
import { SpecialList } from "./special_list.js";
import { Refusal } from "./source.js";
import { varied, type Workspace } from "./workspace.js";

/** What is kept of a panel when the page is opened again. */
export interface FigureMemory {
  wish: PictureWish;
  logarithmic: [boolean, boolean][];
  views: (View | null)[]; // null: everything
  colouring: Colouring;
}

export interface FigureNeighbours {
  close(view: FigureView): void;
  viewed(view: FigureView, diagram: Diagram): void; // zoomed by the user
  changed(): void; // what is shown
}

const leastDelay = 500; // milliseconds between two drawings of a run that is being computed

/** A picture in the middle of the page, with all that one can do to it. */
export class FigureView {
  readonly root: HTMLElement;
  readonly diagrams: Diagram[] = [];
  answer: FigureAnswer | null = null;
  private logarithmic: [boolean, boolean][] = [];
  private colouring: Colouring = "picture";
  private rememberedViews: (View | null)[] = [];
  private readonly title = make("h2", { class: "figure-title" });
  private readonly tools = make("div", { class: "tools", role: "group", "aria-label": "Picture" });
  private readonly chooserButton = button("Choose…", () => this.toggleChooser());
  private logarithmicBoxes: HTMLInputElement[] = [];
  /** Choices for x and y since the picture was asked for: they hold for it too when it arrives. */
  private chosenAxes: [boolean?, boolean?] = [];
  private readonly before: PictureWish[] = []; // what the picture showed, the last one last
  private readonly backButton = button("↶", () => this.goBack(), {
    "aria-label": "Show what this picture showed before",
    title: "Show what this picture showed before",
    hidden: true,
  });
  private readonly shownRuns = make("div", { class: "shown-runs row", role: "group", "aria-label": "Runs shown" });
  private readonly unseen = make("div", { class: "notes" });
  private readonly chooserPlace = make("div", { class: "chooser", hidden: true });
  private readonly grid = make("div", { class: "diagrams" });
  private readonly legend = make("div");
  private readonly notes = make("div", { class: "notes" });
  private readonly refusal = make("div", { role: "status" }); // of what was chosen last
  private readonly special: SpecialList;
  private readonly ends: (() => void)[] = [];
  private asked: AbortController | null = null;
  private drawnWish: PictureWish | null = null; // the last one that could be drawn
  private chooser: PictureChooser | null = null;
  private sameQuantities = false; // only runs were added
  private drawnAt = 0;
  private timer = 0;

  /** @param fixed a figure that is no picture of a run, such as one of trips */
  constructor(
    readonly workspace: Workspace,
    private wish: PictureWish,
    private readonly neighbours: FigureNeighbours,
    private readonly fixed: { figure: Figure; table: Table | null } | null = null,
    memory: FigureMemory | null = null,
  ) {
    this.special = new SpecialList(workspace);
    this.root = make(
      "section",
      { class: "figure" },
      make("header", {}, this.title, this.tools),
      this.chooserPlace,
      this.refusal,
      this.shownRuns,
      this.grid,
      this.unseen,
      this.legend,
      this.special.root,
      this.notes,
    );
    if (memory) {
      this.logarithmic = memory.logarithmic;
      this.rememberedViews = memory.views;
      this.colouring = memory.colouring;
    }
    this.ends.push(
      workspace.on("selection", () => this.markSelection()),
      workspace.on("runs", (changed) => this.runsChanged(changed)),
      workspace.on("special", () => this.showTypes()),
      appearance.onChange(() => this.showLegend()),
    );
    this.makeTools();
    void this.load();
  }

  get isFixed(): boolean {
    return this.fixed !== null;
  }
  /** Whether it shows just one run, or a picture of the study: a click in the list shows it again. */
  get isPlain(): boolean {
    const keys = Object.entries(this.wish).filter(([, value]) => value !== undefined);
    return !this.isFixed && keys.length === 1 && (this.wish.name !== undefined || this.wish.runs?.length === 1);
  }
  /** The one of the study that is shown. */
  get picture(): StudyPicture | undefined {
    return this.workspace.picture(this.wish.name);
  }
  get kind(): string {
    return this.wish.kind ?? this.picture?.kind ?? "";
  }
  get pictureWish(): PictureWish {
    return this.wish;
  }
  /** Runs that are shown. */
  get runs(): string[] {
    return this.wish.runs ?? this.picture?.runs ?? [];
  }
  /** What the picture shows, in keys of its own instead of a name of the study. */
  private get ownWish(): PictureWish {
    if (!this.workspace.source.workshop) return { runs: this.runs }; // a file has no other pictures
    return { ...namedWish(this.picture), ...this.wish, name: undefined, runs: this.runs };
  }
  get remembered(): FigureMemory | null {
    if (this.fixed) return null;
    const views = this.diagrams.map((diagram) => (diagram.showsAll ? null : diagram.currentView));
    return { wish: this.wish, logarithmic: this.logarithmic, views, colouring: this.colouring };
  }

  /** @param byChooser otherwise an open form does not show what is drawn, and is closed */
  setWish(wish: PictureWish, byChooser = false): void {
    this.before.push(this.wish);
    this.change(wish, byChooser);
  }

  private goBack(): void {
    const wish = this.before.pop();
    if (wish) this.change(wish, false);
    if (this.backButton.hidden) this.root.querySelector<HTMLElement>(".diagram")?.focus(); // not lost to the keyboard
  }

  private change(wish: PictureWish, byChooser: boolean): void {
    if (!byChooser) this.chooserPlace.hidden = true;
    this.backButton.hidden = this.before.length === 0;
    const sameAxes = wish.x === this.wish.x && wish.kind === this.wish.kind && wish.name === this.wish.name;
    this.wish = wish;
    this.chosenAxes = [];
    fill(this.refusal);
    if (!sameAxes && !this.sameQuantities) this.logarithmic = [];
    void this.load();
  }

  /** What was chosen cannot be drawn: the picture stays as it was, and says why. */
  private takeBack(drawn: PictureWish, why: string): void {
    this.wish = drawn;
    if (this.before[this.before.length - 1] === drawn) this.before.pop();
    this.backButton.hidden = this.before.length === 0;
    this.logarithmic = this.diagrams.map((diagram) => this.asChosen(diagram.logarithmic));
    this.redraw();
    this.sameQuantities = false;
    fill(this.refusal, problem(`The picture stays as it was: ${why}`));
    this.chooser?.takeBack(this.ownWish);
    this.showTools();
    this.showRuns();
    this.neighbours.changed();
  }

  addRun(run: string): void {
    if (this.runs.includes(run)) void this.load();
    else {
      this.sameQuantities = true;
      this.setWish({ ...this.ownWish, title: undefined, runs: [...this.runs, run] });
    }
  }

  removeRun(run: string): void {
    this.sameQuantities = true;
    this.setWish({ ...this.ownWish, title: undefined, runs: this.runs.filter((name) => name !== run) });
    this.neighbours.changed();
  }

  private showRuns(): void {
    const { runs } = this;
    this.shownRuns.hidden = runs.length < 2 || this.fixed !== null;
    const hide = (name: string) =>
      button(`${name} ✕`, () => this.removeRun(name), {
        "aria-label": `Hide ${name}`,
        title: `Hide ${name} in this picture`,
      });
    fill(this.shownRuns, ...(this.shownRuns.hidden ? [] : runs.map(hide)));
  }

  destroy(): void {
    this.asked?.abort();
    clearTimeout(this.timer);
    this.ends.forEach((end) => end());
    this.diagrams.forEach((diagram) => diagram.destroy());
    this.root.remove();
  }

  /** Figures of runs that are being computed are drawn again at most twice a second. */
  private runsChanged(changed: Set<string>): void {
    if (!this.runs.some((run) => changed.has(run)) || this.timer) return;
    const delay = Math.max(0, this.drawnAt + leastDelay - performance.now());
    this.timer = window.setTimeout(() => {
      this.timer = 0;
      void this.load();
    }, delay);
  }

  async load(): Promise<void> {
    this.asked?.abort();
    const asked = (this.asked = new AbortController());
    const runs = this.fixed ? [] : this.workspace.runsOf(this.runs);
    if (runs.length > 0 && runs.every((run) => run.points === 0)) {
      this.showProblem(new Error("no point is computed yet"), false);
      return;
    }
    try {
      const answer = this.fixed ?? (await figureOf(this.workspace, this.wish, asked.signal));
      if (asked.signal.aborted) return;
      this.answer = answer;
      this.drawnAt = performance.now();
      this.drawnWish = this.wish;
      this.show(answer);
    } catch (error) {
      if (asked.signal.aborted) return;
      const { drawnWish } = this;
      const isRefused = error instanceof Refusal && error.status === 400;
      if (isRefused && drawnWish && drawnWish !== this.wish) this.takeBack(drawnWish, messageOf(error));
      else this.showProblem(error, isRefused);
    }
  }

  /** @param isRefused otherwise the server does not answer, and what was drawn may still be so */
  private showProblem(error: unknown, isRefused: boolean): void {
    this.title.textContent = this.wish.title ?? this.wish.name ?? this.runs.join(", ");
    this.showTools();
    this.showRuns();
    fill(this.notes, problem(messageOf(error)));
    if (this.diagrams.length > 0 && !isRefused) return;
    this.grid.hidden = this.special.root.hidden = true;
    fill(this.legend);
    fill(this.unseen);
  }

  private show({ figure, table }: FigureAnswer): void {
    this.grid.hidden = false;
    this.title.textContent = figure.title || this.runs.join(", ");
    this.root.setAttribute("aria-label", `Picture: ${this.title.textContent}`);
    this.grid.style.setProperty("--columns", String(Math.max(1, figure.columns)));
    if (this.logarithmic.length !== figure.panels.length)
      this.logarithmic = figure.panels.map(({ x, y }) => this.asChosen([x.logarithmic, y.logarithmic]));
    this.redraw();
    this.sameQuantities = false;
    this.rememberedViews.forEach((view, index) => view && this.diagrams[index]?.setView(view));
    this.rememberedViews = [];
    this.showTools();
    this.showLegend();
    this.showRuns();
    this.special.show(figure);
    const notes = [...new Set([...this.motionNotes(figure), ...figure.panels.flatMap((panel) => panel.notes ?? [])])];
    fill(
      this.notes,
      ...notes.map((note) => make("p", { class: "note" }, note)),
      table && table.rows.length > 0 ? make("details", {}, make("summary", {}, "Numbers"), dataTable(table)) : null,
    );
    this.markSelection();
  }

  /** Which motion is drawn, of a run that has many. */
  private motionNotes(figure: Figure): string[] {
    const notes: string[] = [];
    for (const run of this.workspace.runsOf(this.runs)) {
      if (run.is_branch || run.points < 2) continue;
      const series = figure.panels.flatMap((panel) => panel.series).filter((one) => one.run === run.name);
      const numbers = new Set(series.flatMap((one) => one.numbers ?? []).filter((number) => number !== null));
      if (numbers.size !== 1) continue;
      const [number] = numbers;
      const along = varied(run)[0];
      const how = along ? `; “at” in a picture of the study chooses another one by ${along}` : "";
      notes.push(`Of the ${run.points} motions of ${run.name} one is drawn: that of point ${number}${how}.`);
    }
    return notes;
  }

  /** Draws the figure as it is, after a change of colours or axes. */
  private redraw(): void {
    const figure = this.answer?.figure;
    if (!figure) return;
    recoloured(figure, this.colouring, this.workspace).panels.forEach((panel, index) => {
      const known = this.diagrams[index];
      const title = [figure.title || this.runs.join(", "), panel.title].filter((text) => text !== "").join(", ");
      const name = `${title}: arrow keys go from point to point, up and down between special points, Enter to what can be done there`;
      known?.setName(name);
      if (known) return known.setPanel(panel, this.logarithmic[index], this.sameQuantities);
      const diagram: Diagram = new Diagram(
        panel,
        {
          name,
          typeOf: this.workspace.typeOf,
          pick: (hit) => this.pick(hit),
          step: (key) => this.step(diagram, key),
          enter: () => this.enter(),
          viewed: () => this.neighbours.viewed(this, diagram),
        },
        this.logarithmic[index],
      );
      this.diagrams.push(diagram);
      this.grid.append(make("div", { class: "diagram-place" }, make("h3"), diagram.root));
    });
    while (this.diagrams.length > figure.panels.length) {
      this.diagrams.pop()?.destroy();
      this.grid.lastElementChild?.remove();
    }
    figure.panels.forEach((panel, index) => {
      const heading = this.grid.children[index].querySelector("h3");
      if (heading) heading.textContent = panel.title;
      if (heading) heading.hidden = !panel.title;
    });
    const hidden = this.diagrams.map((diagram) => hiddenPoints(diagram.data)).filter((note) => note !== "");
    fill(this.unseen, ...[...new Set(hidden)].map((note) => make("p", { class: "note", role: "status" }, note)));
  }

  /** What special points are may be known later than the figure. */
  private showTypes(): void {
    this.diagrams.forEach((one) => one.redraw());
    if (this.answer) this.special.show(this.answer.figure);
  }

  private showLegend(): void {
    if (this.answer) fill(this.legend, legendElement(recoloured(this.answer.figure, this.colouring, this.workspace)));
  }

  /** The buttons stay while the figure is drawn again: one that is being pressed must not be replaced. */
  private makeTools(): void {
    const setAxis = (axis: 0 | 1) => (on: boolean) => {
      this.chosenAxes[axis] = on;
      this.logarithmic.forEach((one) => (one[axis] = on));
      if (this.logarithmic.length > 0) this.redraw();
    };
    const boxes = [checkbox("log x", false, setAxis(0)), checkbox("log y", false, setAxis(1))];
    this.logarithmicBoxes = boxes.map((box) => box.querySelector("input")).filter((box) => box !== null);
    fill(
      this.tools,
      this.fixed ? null : this.chooserButton,
      ...boxes,
      this.backButton,
      button("All", () => this.diagrams.forEach((diagram) => diagram.showAll(true)), { title: "Show everything (0)" }),
      exportMenu({
        title: () => this.answer?.figure.title || this.runs.join(", "),
        figure: () => recoloured(this.answer?.figure ?? emptyFigure, this.colouring, this.workspace),
        diagrams: () => this.diagrams,
        studyText: this.fixed ? undefined : (name) => this.studyText(name),
      }),
      button("✕", () => this.neighbours.close(this), { "aria-label": "Close this picture", class: "close" }),
    );
  }

  private asChosen([x, y]: [boolean, boolean]): [boolean, boolean] {
    return [this.chosenAxes[0] ?? x, this.chosenAxes[1] ?? y];
  }

  private studyText(name: string): string {
    const wish = seenWish(this),
      parts = partsOf(this.workspace, wish);
    if (!parts) return pictureText(name, wish);
    const note = "# A study draws branches and other runs in pictures of their own.\n";
    return `${note}${pictureText(name, parts.others)}\n${pictureText(`${name}-branches`, parts.branches)}`;
  }

  private showTools(): void {
    this.logarithmicBoxes.forEach((box, axis) => (box.checked = this.logarithmic.some((one) => one[axis])));
    this.chooserButton.setAttribute("aria-expanded", String(!this.chooserPlace.hidden));
  }

  private toggleChooser(): void {
    this.chooserPlace.hidden = !this.chooserPlace.hidden;
    this.showTools();
    if (this.chooserPlace.hidden) return;
    const chooser = (this.chooser = new PictureChooser(this.workspace, this.ownWish, this.colouring, {
      wish: (wish) => this.setWish(wish, true),
      colouring: (colouring) => {
        this.colouring = colouring;
        this.redraw();
        this.showLegend();
      },
    }));
    fill(this.chooserPlace, chooser.root);
    chooser.root.querySelector<HTMLElement>("select, input, button")?.focus();
  }

  private pick(hit: Hit): void {
    if (hit.run !== null && hit.number !== null) this.workspace.select({ run: hit.run, number: hit.number });
  }

  /** From a point to what can be done there. */
  private enter(): boolean {
    if (!this.workspace.selection) return false;
    this.workspace.enter();
    return true;
  }

  private markSelection(): void {
    const chosen = this.workspace.selection;
    for (const diagram of this.diagrams) diagram.markPoint(chosen?.run ?? null, chosen?.number ?? null);
  }

  private step(diagram: Diagram, key: string): boolean {
    const next = pointAfter(diagram, this.workspace.selection, key);
    if (!next || next.run === null || next.number === null) return false;
    this.workspace.select({ run: next.run, number: next.number });
    diagram.reveal(next);
    this.workspace.announce(describeHit(next, diagram.panel, this.workspace.typeOf(next.run, next.number)));
    return true;
  }
}

const emptyFigure: Figure = { title: "", columns: 1, symbols: [], panels: [] };
