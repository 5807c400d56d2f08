import type { ActionActs } from "./action_form.js";
import { addressOf, keep, kept, type KeptView } from "./kept_view.js";
import { ConnectionBanner } from "./connection_banner.js";
import type { Job, Model, Point, Session, StartedJob, StudyPicture } from "./contract.js";
import { append, button, fill, make, messageOf, problem } from "./dom.js";
import { FigureGrid } from "./figure_grid.js";
import { JobList } from "./job_list.js";
import { recall, remember } from "./memory.js";
import { ModelView } from "./model_view.js";
import { pageHeader } from "./page_header.js";
import { PointView } from "./point_view.js";
import { RunList } from "./run_list.js";
import { Screens } from "./screens.js";
import { SimulationView, type SimulationStart } from "./simulation_view.js";
import { Refusal, type Source } from "./source.js";
import { splitter } from "./splitter.js";
import { StudyView } from "./study_view.js";
import { Tabs } from "./tabs.js";
import { withoutRun } from "./study_text.js";
import { standsAlone, Workspace } from "./workspace.js";

/** Puts the parts of the page together, and connects them. */
export class Page {
  private readonly workspace: Workspace;
  private readonly grid: FigureGrid;
  private readonly tabs = new Tabs();
  private readonly point: PointView;
  private readonly simulation: SimulationView;
  private readonly study: StudyView;
  private readonly models: ModelView;
  private readonly banner: ConnectionBanner;
  private readonly trouble = make("div", { class: "banner", role: "alert", hidden: true }); // with the result file
  private readonly acts: ActionActs;
  private model: Model | null = null;
  private opened: Model | null = null; // that of the file
  private modelRun: string | null = null; // whose model it is; null: the opened one
  private refreshing = 0;
  private refreshAgain = false;
  private ready = false;
  private keeping = 0;
  private screens: Screens | null = null;

  private constructor(
    private readonly source: Source,
    workspace: Workspace,
  ) {
    this.workspace = workspace;
    this.grid = new FigureGrid(workspace, () => this.keep());
    this.study = new StudyView(workspace, () => this.model);
    this.models = new ModelView(workspace, {
      simulate: (model, text) => this.simulateModel(model, text),
      stored: (model) => void (this.simulation.isOfText && this.beginModel(model, null)),
      saved: () => this.modelSaved(),
    });
    this.banner = new ConnectionBanner(() => addressOf(this.view));
    this.acts = {
      compute: (text) => this.compute(text),
      trip: (title, { figure, table }) =>
        figure && this.grid.openFixed({ figure: { ...figure, title: figure.title || title }, table }),
      simulate: (point) => void this.simulatePoint(point),
    };
    this.point = new PointView(workspace, this.acts);
    this.simulation = new SimulationView(workspace, this.acts);
  }

  static async open(source: Source, root: HTMLElement): Promise<void> {
    const session = await source.session();
    session.title = keptTitle(session);
    const page = new Page(source, new Workspace(source, session));
    await page.workspace.refresh();
    page.build(root);
    await page.restore();
    page.listen();
  }

  private build(root: HTMLElement): void {
    const { workspace, source } = this;
    document.title = `${workspace.session.title || workspace.session.opened.name} – graze`;
    const runs = new RunList(workspace, {
      open: (run, add) => {
        if (add) this.grid.addRun(run);
        else this.grid.showRun(run);
        void this.showModel(run);
      },
      picture: (picture) => this.grid.showPicture(picture.name),
      compute: (names, picture) => void this.computeRuns(names, picture),
      remove: (run) => void this.removeRun(run),
    });
    this.tabs.add("Point", this.point.root);
    if (source.workshop) this.tabs.add("Simulate", this.simulation.root, () => void this.simulateUsual());
    this.tabs.add("Model", this.models.root);
    if (source.workshop) {
      this.tabs.add("Study", this.study.root, () => void this.study.show());
      this.tabs.add("Jobs", new JobList(workspace).root);
    }
    const aside = make("aside", { class: "side", "aria-label": "The chosen point" }, this.tabs.root);
    const columns = make("div", { class: "columns" }, runs.root, this.grid.root);
    aside.prepend(splitter(columns));
    columns.append(aside);
    const screens = (this.screens = new Screens(columns, source.workshop ? "Point and tools" : "Point"));
    const toPictures = () => {
      if (this.grid.root.offsetParent === null) screens.showSide(false); // a very narrow window shows one of them
      this.grid.focus();
    };
    const skip = button("To the pictures", toPictures, { class: "skip" });
    fill(root, skip, pageHeader(workspace, screens.root), this.banner.root, this.trouble, columns);
    workspace.on("selection", (selection) => {
      this.keep();
      if (!selection) return;
      if (this.ready) this.tabs.open("Point");
      if (this.ready) screens.showSide(true);
      void this.showModel(selection.run);
    });
    workspace.on("enter", () => {
      this.tabs.open("Point");
      screens.showSide(true);
      this.point.focus();
    });
    window.addEventListener("pagehide", () => this.keepNow());
  }

  private get view(): KeptView {
    const { selection } = this.workspace;
    return { figures: this.grid.remembered, selection, tab: this.tabs.opened, simulation: this.simulation.kept };
  }

  /** A diagram that is moved changes at each event of the pointer: what is shown is kept when it rests. */
  private keep(): void {
    if (!this.ready) return;
    clearTimeout(this.keeping);
    this.keeping = window.setTimeout(() => this.keepNow(), 200);
  }

  private keepNow(): void {
    if (this.keeping) keep(this.view);
    clearTimeout(this.keeping);
    this.keeping = 0;
  }

  /** What was shown before, or the first pictures of the study, or the first run. */
  private async restore(): Promise<void> {
    const before = kept(),
      { runs, session } = this.workspace;
    const exists = (name: string) => runs.some((run) => run.name === name);
    for (const memory of before?.figures ?? []) {
      if (this.workspace.picture(memory.wish.name) || memory.wish.runs?.some(exists))
        this.grid.open(memory.wish, memory);
    }
    this.openUsual();
    await this.readOpened();
    const drawable = runs.filter((run) => run.points > 0);
    this.ready = true;
    if (before?.simulation) remember("simulation", before.simulation);
    if (before?.selection && exists(before.selection.run)) this.workspace.select(before.selection);
    else if (drawable.length > 0 && session.opened.kind !== "model") await this.showModel(drawable[0].name);
    else if (session.opened.kind === "model" || session.stored) await this.showModel(null); // a study has many
    if (before?.tab) this.tabs.open(before.tab);
    else if (session.opened.kind === "model") this.tabs.open("Simulate");
    if (this.grid.isEmpty && session.opened.kind === "model") this.screens?.showSide(true);
  }

  /** The first picture of the study, or the first run, if nothing is open. */
  private openUsual(): void {
    const { pictures, runs } = this.workspace;
    const drawable = runs.filter((run) => run.points > 0);
    // Pictures without a title are those that every run has in a file of its own.
    const known = pictures.filter((one) => one.runs.every((name) => this.workspace.run(name))),
      titled = known.filter((one) => one.title);
    const isDiagram = ({ kind }: StudyPicture) => kind === "branch" || kind === "bifurcation";
    const first = titled.find(({ kind }) => kind === "branch") ?? titled[0] ?? known.find(isDiagram) ?? known[0];
    if (this.grid.isEmpty && first && first.runs.some((name) => drawable.some((run) => run.name === name)))
      this.grid.open({ name: first.name });
    else if (this.grid.isEmpty && drawable.length > 0)
      this.grid.open({
        runs: [(drawable.find((run) => run.is_followed) ?? drawable.find((run) => run.is_branch) ?? drawable[0]).name],
      });
  }

  private async showModel(run: string | null): Promise<void> {
    try {
      const model = run === null ? await this.source.model(null) : await this.point.modelOf(run);
      this.model = model;
      this.modelRun = run;
      if (run === null) this.opened = model;
      // A model that was opened stays in its editor, where it can be saved, beside its runs.
      const isOpened = this.opened?.file !== undefined && this.opened.name === model.name;
      await (isOpened && this.opened ? this.models.show(this.opened, null) : this.models.show(model, run));
    } catch {
      return; // a file may lack the model
    }
  }

  private async simulatePoint(point: Point): Promise<void> {
    const model = await this.point.modelOf(point.run);
    const names = model.states.map(({ name }) => name);
    const motion = await this.source.motion(point.run, point.number, names).catch(() => null);
    const initial: Record<string, number> = {},
      parameters: Record<string, number> = {};
    motion?.columns.forEach(({ name }, index) => {
      const value = motion.values[index][0];
      if (index > 0 && value !== null && value !== undefined) initial[name] = value;
    });
    const free = new Set(model.parameters.filter((one) => !one.dependent).map(({ name }) => name));
    for (const { name, value } of [...point.parameters, ...point.coordinates])
      if (value !== null && free.has(name)) parameters[name] = value;
    const duration = point.period ? 10 * point.period : null,
      mode = motion?.modes?.[0] ?? "";
    const words = `From ${point.run}, ${point.name || `point ${point.number}`}: the motion is computed again as you move a slider.`;
    this.simulation.begin({ run: point.run, text: null, words, parameters, initial, mode, duration }, model);
    this.tabs.open("Simulate");
  }

  /** @throws Refusal when the text has mistakes */
  private async simulateModel(model: Model, text: string): Promise<void> {
    const { workshop } = this.source;
    const edited = text !== model.text && workshop ? await workshop.modelOf(text) : null;
    this.beginModel(edited ?? model, edited ? text : null);
    this.tabs.open("Simulate");
  }

  /** @param text of a model that no file has; null: it is the stored one */
  private beginModel(model: Model, text: string | null): void {
    const run = text === null && model !== this.opened ? this.modelRun : null;
    const words = `From the initial state of the model${run === null ? "" : ` of run ${run}`}.`;
    this.simulation.begin({ run, text, words, parameters: {}, initial: {}, mode: "", duration: null }, model);
  }

  /** The opened model has another text now, with which it is simulated. */
  private async modelSaved(): Promise<void> {
    await this.workspace.refresh().catch(() => undefined);
    await this.readOpened();
    if (this.opened && this.simulation.isOfText) this.beginModel(this.opened, null);
  }

  /** The opened model by its file, as it is now. */
  private async readOpened(): Promise<void> {
    if (this.workspace.session.opened.kind !== "model") return;
    this.opened = await this.source.model(null).catch(() => this.opened);
    if (!this.opened) return;
    this.simulation.setBase(this.opened);
    if (this.modelRun === null) this.model = this.opened;
    await this.models.show(this.opened, null);
  }

  /** What was simulated before the page was loaded anew, or else the model that is shown. */
  private async simulateUsual(): Promise<void> {
    if (!this.simulation.isEmpty) return;
    const before = recall<SimulationStart>("simulation");
    const model = before ? await this.modelBefore(before) : null;
    if (!this.simulation.isEmpty) return; // something else was chosen meanwhile
    if (before && model) this.simulation.begin(before, model);
    else if (this.model) this.beginModel(this.model, null);
  }

  /** The model of an earlier simulation, if it still has all that has a value there. */
  private async modelBefore({ run, parameters, initial }: SimulationStart): Promise<Model | null> {
    if (run !== null && !this.workspace.run(run)) return null;
    const model = await (run === null ? this.source.model(null) : this.point.modelOf(run)).catch(() => null);
    const known = [...(model?.parameters ?? []), ...(model?.states ?? [])].map(({ name }) => name);
    return Object.keys({ ...parameters, ...initial }).every((name) => known.includes(name)) ? model : null;
  }

  private async compute(text: string): Promise<StartedJob> {
    const { workshop } = this.source;
    if (!workshop) throw new Error("nothing can be computed here");
    const started = await workshop.start({ text });
    this.awaited.push(...started.runs);
    return started;
  }

  /** Computes runs of the study, and shows what was asked for; of many runs the first picture that can be drawn. */
  private async computeRuns(names: string[], picture?: StudyPicture): Promise<void> {
    try {
      await this.source.workshop?.start({ runs: names });
    } catch (error) {
      this.workspace.announce(String(error));
      return;
    }
    if (picture) this.awaitedPicture = picture;
    else if (names.length === 1) this.awaited.push(...names);
    else this.awaitsAny = true;
  }

  /** Takes a run out of the results and out of the study, after a confirmation. */
  private async removeRun(name: string): Promise<void> {
    const { workshop } = this.source,
      run = this.workspace.run(name);
    if (!workshop || !run) return;
    const points = run.points > 0 ? ` and its ${run.points} points from the results, for good` : "";
    if (!window.confirm(`Remove the run ${name} from the study${points}?`)) return;
    try {
      const study = await workshop.study(),
        text = withoutRun(study.text, name);
      if (text !== study.text) {
        const { errors } = await workshop.check("study", text);
        if (errors.length > 0 && (study.errors ?? []).length === 0) throw new Error(errors[0].problem);
      }
      if (run.status !== "missing") await workshop.remove(name);
      if (text !== study.text)
        await workshop.keepStudy(text, study.revision, { save: study.has_file && study.saved, replace: false });
      if (this.workspace.selection?.run === name) this.workspace.select(null);
      this.workspace.announce(`${name} is removed`);
    } catch (error) {
      window.alert(`${name} stays: ${messageOf(error)}`);
    }
    this.refreshSoon();
  }

  private awaitedPicture: StudyPicture | null = null;
  private awaitsAny = false;
  /** Runs that were started from this page, to be shown as soon as they have points. */
  private readonly awaited: string[] = [];

  private listen(): void {
    const { workshop } = this.source,
      { workspace } = this;
    if (!workshop) return;
    workshop.jobs().then(
      (jobs) => workspace.setJobs(jobs),
      () => undefined,
    );
    workshop.listen({
      runs: () => this.refreshSoon(),
      job: (job) => this.jobChanged(job),
      study: (revision) => {
        void this.study.reload(revision);
        void this.readOpened();
        this.refreshSoon();
      },
      connection: (state) => {
        this.banner.show(state);
        if (state === "open") this.refreshSoon();
      },
    });
    workspace.on("runs", () => this.showAwaited());
    window.addEventListener("beforeunload", (event) => this.study.hasUnsavedText && event.preventDefault());
  }

  private jobChanged(job: Job): void {
    const others = this.workspace.jobs.filter(({ id }) => id !== job.id);
    this.workspace.setJobs([...others, job].sort((one, other) => Number(one.id) - Number(other.id)));
    const words: Partial<Record<Job["state"], string>> = {
      complete: "is complete",
      failed: "failed",
      stopped: "was stopped",
    };
    const ended = words[job.state];
    if (ended) this.workspace.announce(`${job.runs.join(", ")} ${ended}`);
    if (ended) this.refreshSoon();
  }

  private showAwaited(): void {
    const drawable = (name: string) => (this.workspace.run(name)?.points ?? 0) > 0;
    if (this.awaitedPicture?.runs.every(drawable)) {
      this.grid.showPicture(this.awaitedPicture.name);
      this.awaitedPicture = null;
    }
    if (this.awaitsAny && this.workspace.runs.some(({ name }) => drawable(name))) {
      this.awaitsAny = false;
      this.openUsual();
    }
    for (const name of [...this.awaited]) {
      const run = this.workspace.run(name);
      if (!run?.points) continue;
      this.awaited.splice(this.awaited.indexOf(name), 1);
      this.grid.follow(name);
      if (standsAlone(run)) void this.selectOrbit(name);
    }
  }

  /** A run that finds one orbit has one point, which is what was looked for. */
  private async selectOrbit(run: string): Promise<void> {
    const [first] = await this.source.specialPoints(run).catch(() => []);
    this.workspace.select({ run, number: first?.number ?? 0 });
  }

  /** Reads the lists again. What is shown stays where the results cannot be read, or are gone, and the page says so. */
  private async refreshNow(): Promise<void> {
    const hasResults = () => this.workspace.runs.some(({ points }) => points > 0);
    const had = hasResults() || !this.trouble.hidden;
    let words = "";
    try {
      await this.workspace.refresh();
      if (had && !hasResults()) words = "The results are not there any more. Pictures stay as they were.";
    } catch (error) {
      if (!(error instanceof Refusal) || error.status === 0) return; // the connection's banner says it
      words = `The results cannot be read now: ${error.message}. Pictures stay as they were.`;
    }
    if (this.trouble.textContent !== words) fill(this.trouble, words);
    this.trouble.hidden = words === "";
  }

  /** The lists are read at most three times a second, however many events come, and once at a time. */
  private refreshSoon(): void {
    if (this.refreshing) return void (this.refreshAgain = true);
    this.refreshing = window.setTimeout(async () => {
      this.refreshAgain = false;
      await this.refreshNow();
      this.refreshing = 0;
      if (this.refreshAgain) this.refreshSoon();
    }, 300);
  }
}

/** The first title of what is opened: the study of a model has another one after runs were added. */
function keptTitle({ opened, title }: Session): string {
  const before = recall<{ name: string; title: string }>("title");
  if (before?.name === opened.name && opened.kind === "model") return before.title;
  remember("title", { name: opened.name, title });
  return title;
}

/** What a page shows that cannot be opened. */
export function showFailure(root: HTMLElement, error: unknown): void {
  fill(root, problem(messageOf(error)));
  append(root, make("p", {}, "Open the address that `graze view` prints, with its token."));
}
