import type { Diagram } from "./diagram.js";
import { button, checkbox, fill, make } from "./dom.js";
import type { FigureAnswer, PictureWish } from "./contract.js";
import { axisTitle } from "./axis_text.js";
import { FigureView, type FigureMemory } from "./figure_view.js";
import { haveSameAxes } from "./joined_figure.js";
import type { Workspace } from "./workspace.js";

/** The pictures in the middle of the page; diagrams with the same horizontal axis may be zoomed together. */
export class FigureGrid {
  readonly root = make("main", { class: "middle", "aria-label": "Pictures" });
  private readonly bar = make("div", { class: "bar row" });
  private readonly place = make("div", { class: "figures" });
  private readonly figures: FigureView[] = [];
  private current: FigureView | null = null;
  private linked = true;
  private readonly nothing = make("p", { class: "note nothing" });

  constructor(
    private readonly workspace: Workspace,
    private readonly changed: () => void,
  ) {
    this.root.append(this.bar, this.nothing, this.place);
    fill(
      this.bar,
      button("Add a picture", () => this.addUsual()),
      checkbox("zoom x together", true, (on) => (this.linked = on)),
      make("span", { class: "hint" }, "drag: zoom · wheel: zoom · shift-drag: move · double click: all"),
      make("span", { class: "hint keys" }, "keys ←→: points · ↑↓: special points · Enter: what to do there"),
    );
    workspace.on("runs", () => this.arrange());
    this.arrange();
  }

  get isEmpty(): boolean {
    return this.figures.length === 0;
  }

  get remembered(): FigureMemory[] {
    return this.figures.map((figure) => figure.remembered).filter((memory): memory is FigureMemory => memory !== null);
  }

  /** For the keyboard: past the list of runs. */
  focus(): void {
    this.place.querySelector<HTMLElement>(".diagram")?.focus();
  }

  open(wish: PictureWish, memory: FigureMemory | null = null): void {
    this.insert(new FigureView(this.workspace, wish, this.neighbours, null, memory));
  }

  /** A figure that was computed for a point, and is not drawn again. */
  openFixed(answer: FigureAnswer): void {
    this.insert(new FigureView(this.workspace, {}, this.neighbours, answer));
  }

  /** Shows a run by itself. */
  showRun(run: string): void {
    this.show({ runs: [run] }, ({ pictureWish: { runs } }) => runs?.length === 1 && runs[0] === run);
  }

  /** Shows a picture of the study. */
  showPicture(name: string): void {
    this.show({ name }, ({ pictureWish }) => pictureWish.name === name);
  }

  /** Shows what is open already, or else takes the place of what one click shows again; what was composed stays. */
  private show(wish: PictureWish, isOpen: (figure: FigureView) => boolean): void {
    const known = this.figures.find((figure) => figure.isPlain && isOpen(figure));
    const current = this.current && this.figures.includes(this.current) ? this.current : null;
    if (known) this.makeCurrent(known);
    else if (current?.isPlain) current.setWish(wish);
    else this.open(wish);
    this.current?.root.scrollIntoView({ block: "nearest" });
    this.changed();
  }

  /** Adds a run to the current picture, or opens its own picture where its axes are others. */
  addRun(run: string): void {
    const target = this.current ?? this.figures[0];
    if (target && this.fits(target, run)) target.addRun(run);
    else this.open({ runs: [run] });
    this.current?.root.scrollIntoView({ block: "nearest" });
    this.changed();
  }

  /** Shows a run that has just begun beside those that vary the same parameters, or in a new panel. */
  follow(run: string): void {
    if (this.figures.some((figure) => figure.runs.includes(run))) return;
    // A branch goes over the dots of a sweep only if one asks for it: it may show extremes where those are samples.
    const isBranch = (name: string) => this.workspace.run(name)?.is_branch;
    const isAlike = (figure: FigureView) => figure.runs.every((other) => isBranch(other) === isBranch(run));
    const target = [this.current, ...this.figures].find(
      (figure) => figure !== null && this.fits(figure, run) && isAlike(figure),
    );
    if (target) target.addRun(run);
    else this.open({ runs: [run] });
    (target ?? this.current)?.root.scrollIntoView({ block: "nearest" });
    this.changed();
  }

  private fits(figure: FigureView, name: string): boolean {
    if (figure.isFixed || !["", "branch", "bifurcation"].includes(figure.kind)) return false;
    const run = this.workspace.run(name),
      others = figure.runs.map((other) => this.workspace.run(other));
    return run !== undefined && others.length > 0 && others.every((other) => other && haveSameAxes(other, run));
  }

  private insert(figure: FigureView): void {
    this.figures.push(figure);
    this.place.append(figure.root);
    this.current = figure;
    figure.root.addEventListener("focusin", () => this.makeCurrent(figure));
    figure.root.addEventListener("pointerdown", () => this.makeCurrent(figure));
    this.makeCurrent(figure);
    this.arrange();
    this.changed();
  }

  private makeCurrent(figure: FigureView): void {
    this.current = figure;
    for (const one of this.figures) one.root.classList.toggle("current", one === figure && this.figures.length > 1);
  }

  private addUsual(): void {
    const shown = this.current?.runs ?? [];
    const runs =
      shown.length > 0
        ? shown
        : this.workspace.runs
            .filter((run) => run.points > 0)
            .slice(0, 1)
            .map(({ name }) => name);
    if (runs.length > 0) this.open({ runs });
  }

  private arrange(): void {
    this.nothing.hidden = this.figures.length > 0;
    this.nothing.textContent = `No picture is open. ${this.howToBegin}`;
  }

  private get howToBegin(): string {
    const { runs, session } = this.workspace;
    if (runs.some((run) => run.points > 0)) return "Click a run or a picture in the list of runs.";
    if (!session.can_compute) return "There are no results yet.";
    if (runs.length > 0)
      return "Nothing is computed yet: “Compute all that is missing” in the list of runs does it, “compute” one run or picture: they appear here as they grow.";
    return (
      "There are no runs yet. Under “Simulate” the motion follows as you move parameters, and the buttons there " +
      "compute runs from what you see: they appear here as they grow."
    );
  }

  private readonly neighbours = {
    changed: () => this.changed(),
    close: (view: FigureView) => {
      view.destroy();
      this.figures.splice(this.figures.indexOf(view), 1);
      if (this.current === view) this.current = this.figures[this.figures.length - 1] ?? null;
      this.arrange();
      this.changed();
    },
    viewed: (view: FigureView, zoomed: Diagram) => {
      this.changed();
      if (!this.linked) return;
      const title = axisTitle(zoomed.panel.x),
        [logarithmic] = zoomed.logarithmic;
      for (const figure of this.figures)
        for (const other of figure.diagrams) {
          if (other === zoomed || axisTitle(other.panel.x) !== title || other.logarithmic[0] !== logarithmic) continue;
          if (zoomed.showsAll && figure === view) other.showAll();
          else other.setView({ x: zoomed.currentView.x, y: other.currentView.y });
        }
    },
  };
}
