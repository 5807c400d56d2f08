import type { Run, StudyPicture } from "./contract.js";
import { append, button, fill, make } from "./dom.js";
import { counted, kindInWords, labelInWords } from "./kind_words.js";
import { symbolOf } from "./numbers.js";
import { varied, type Workspace } from "./workspace.js";

export interface RunActs {
  open(run: string, add: boolean): void; // in the current panel, or beside what it shows
  picture(picture: StudyPicture): void;
  remove(run: string): void; // out of the study and the results
  compute(runs: string[], picture?: StudyPicture): void; // that is to be shown
}

const marks: Record<Run["status"], [string, string]> = {
  complete: ["✓", "complete"],
  unfinished: ["◐", "unfinished"],
  failed: ["✗", "failed"],
  missing: ["○", "not computed"],
  outdated: ["↻", "out of date"],
};

/** What computes a run, by its state. */
const computing: Partial<Record<Run["status"], [string, string]>> = {
  missing: ["compute", "Compute"],
  unfinished: ["go on", "Go on with"],
  outdated: ["compute anew", "Compute anew"],
  failed: ["try again", "Try again"],
};

/** The entry of a run. It stays while the run changes: a button that is being pressed must not be replaced. */
class RunEntry {
  readonly root = make("li");
  private readonly mark = make("span", { class: "mark", "aria-hidden": "true" });
  private readonly open: HTMLButtonElement;
  private readonly add: HTMLButtonElement;
  private readonly compute: HTMLButtonElement;
  private readonly remove: HTMLButtonElement;
  private readonly state = make("p");
  private readonly outcome = make("div");
  private shown = "";

  constructor(name: string, acts: RunActs) {
    this.open = button(name, () => acts.open(name, false), { class: "entry name", title: name });
    this.compute = button("", () => acts.compute([name]), { class: "compute" });
    this.add = button("+", () => acts.open(name, true), {
      class: "add",
      "aria-label": `Add ${name} to the picture`,
      title: "Add to the picture",
    });
    this.remove = button("✕", () => acts.remove(name), {
      class: "remove",
      "aria-label": `Remove ${name}`,
      title: "Remove the run from the study and the results",
    });
    const state = make("div", { class: "row" }, this.state, this.compute, this.remove);
    append(this.root, make("div", { class: "row" }, this.mark, this.open, this.add), state, this.outcome);
  }

  /** @param canCompute whether anything can be computed, and nothing is */
  show(run: Run, isRunning: boolean, canCompute: boolean): void {
    const key = JSON.stringify([run, isRunning, canCompute]);
    if (key === this.shown) return;
    this.shown = key;
    const [text, act] = computing[run.status] ?? ["", ""];
    this.compute.hidden = text === "" || !canCompute;
    this.remove.hidden = !canCompute;
    this.compute.textContent = text;
    this.compute.setAttribute("aria-label", `${act} ${run.name}`);
    const [mark, words] = isRunning ? ["⟳", "computing"] : (marks[run.status] ?? ["?", run.status]);
    const kind = run.kind_words || run.kind,
      missing = run.status === "missing";
    this.root.className = `run ${isRunning ? "computing" : run.status}`;
    this.mark.textContent = mark;
    this.open.disabled = this.add.disabled = missing || run.points === 0;
    const planned = run.planned && run.planned > run.points ? run.planned : 0;
    const points = planned ? `${run.points} of ${counted(planned, "point")}` : counted(run.points, "point");
    const along = varied(run).map(symbolOf).join(", ");
    const first = `${words}, ${missing ? kind : `${points}${along ? ` along ${along}` : ""}`}`;
    this.state.textContent = first;
    this.state.title = kind;
    fill(this.outcome, ...outcomeLines(run).map((line) => make("p", { class: "outcome", title: line }, line)));
  }
}

function outcomeLines(run: Run): string[] {
  const one = ([label, count]: [string, number]) =>
    run.is_branch ? `${kindInWords(label)}${count > 1 ? ` (${count})` : ""}` : `${labelInWords(label)}: ${count}`;
  const labels = run.labels.map(one).join(", ");
  // What a search for equilibria says of a mode is no end of a branch.
  const ends = run.ends
    .map(([way, end]) => `${way ? `${way}: ` : ""}${run.is_followed ? "ends at " : ""}${end}`)
    .join("; ");
  const lines = [labels, ends, run.failure ?? "", run.failure ? (run.remedy ?? "") : ""];
  return lines.filter((line) => line);
}

function isMissing(run: Run | undefined): boolean {
  return run !== undefined && ["missing", "unfinished", "outdated"].includes(run.status);
}

/** Runs with their outcomes, and the pictures of the study. */
export class RunList {
  readonly root = make("nav", { class: "runs", "aria-label": "Runs and pictures" });
  private readonly pictures = make("details", { open: true });
  private readonly runs = make("ul");
  private readonly empty = make("p", { class: "note" }, "There are no runs yet.");
  private readonly missing = button("", () => this.acts.compute(this.missingRuns()), { class: "all primary" });
  private readonly entries = new Map<string, RunEntry>();
  private shownPictures = "";

  constructor(
    private readonly workspace: Workspace,
    private readonly acts: RunActs,
  ) {
    append(this.root, this.missing, this.pictures, make("h2", {}, "Runs"), this.empty, this.runs);
    workspace.on("runs", () => this.draw());
    workspace.on("jobs", () => this.draw());
    this.draw();
  }

  private missingRuns(): string[] {
    const { runs } = this.workspace;
    return runs.filter(isMissing).map(({ name }) => name);
  }

  private draw(): void {
    const { runs, jobs, source, session } = this.workspace;
    const running = jobs.find((job) => job.state === "running")?.run;
    const canCompute = source.workshop !== null && session.can_compute;
    const awaited = new Set(
      jobs.filter(({ state }) => state === "running" || state === "waiting").flatMap((job) => job.runs),
    );
    this.drawPictures(canCompute && awaited.size === 0);
    const names = runs.map(({ name }) => name);
    for (const [name, entry] of this.entries)
      if (!names.includes(name)) {
        entry.root.remove();
        this.entries.delete(name);
      }
    runs.forEach((run, index) => {
      let entry = this.entries.get(run.name);
      if (!entry) this.entries.set(run.name, (entry = new RunEntry(run.name, this.acts)));
      entry.show(run, run.name === running, canCompute && !awaited.has(run.name));
      if (this.runs.children[index] !== entry.root)
        this.runs.insertBefore(entry.root, this.runs.children[index] ?? null);
    });
    this.empty.hidden = runs.length > 0;
    const missing = this.missingRuns().length;
    this.missing.hidden = missing === 0 || !canCompute || awaited.size > 0;
    this.missing.textContent = `Compute all that is missing (${counted(missing, "run")})`;
  }

  private drawPictures(canCompute: boolean): void {
    // Pictures that only bear the name of their run are behind that.
    const pictures = this.workspace.pictures.filter(({ name, title }) => title || !this.workspace.run(name));
    const missing = (picture: StudyPicture) =>
      canCompute ? picture.runs.filter((name) => isMissing(this.workspace.run(name))) : [];
    const key = JSON.stringify(pictures.map((picture) => [picture, missing(picture)]));
    if (key === this.shownPictures) return;
    this.shownPictures = key;
    const entries = pictures.map((picture) => {
      const title = picture.title || picture.name,
        runs = missing(picture);
      const compute = button("compute", () => this.acts.compute(runs, picture), {
        class: "compute",
        "aria-label": `Compute what is missing of ${title}`,
        title: `Compute ${runs.join(", ")}`,
      });
      const open = button(title, () => this.acts.picture(picture), { class: "entry" });
      return make("li", { class: "picture" }, open, runs.length > 0 && compute);
    });
    this.pictures.hidden = pictures.length === 0;
    fill(this.pictures, make("summary", {}, `Pictures (${pictures.length})`), make("ul", {}, ...entries));
  }
}

/** "computing: sweep 43 %", or what is at rest. */
export function stateWords(workspace: Workspace): string {
  const running = workspace.jobs.filter((job) => job.state === "running");
  const waiting = workspace.jobs.filter((job) => job.state === "waiting").length;
  if (running.length === 0) return waiting > 0 ? `${waiting} waiting` : "";
  const [job] = running;
  const { done, points: planned } = job;
  const part = done && planned ? ` ${Math.min(100, Math.round((100 * done) / planned))} %` : "";
  const points = !part && done ? `, ${done} points` : "";
  return `computing: ${job.run || job.runs[0] || "…"}${part || points}${waiting > 0 ? `, ${waiting} waiting` : ""}`;
}
