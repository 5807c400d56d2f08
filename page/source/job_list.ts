import type { Job } from "./contract.js";
import { append, button, make } from "./dom.js";
import { counted } from "./kind_words.js";
import type { Workspace } from "./workspace.js";

const words: Record<Job["state"], string> = {
  waiting: "waits",
  running: "is being computed",
  complete: "complete",
  stopped: "stopped",
  failed: "failed",
};

/** The entry of a job. It stays while the job goes on: a button that is being pressed must not be replaced. */
class JobEntry {
  readonly root = make("li");
  private readonly words = make("p");
  private readonly bar: HTMLProgressElement;
  private readonly message = make("p", { class: "problem" });
  private readonly stop: HTMLButtonElement;

  constructor(job: Job, stop: () => void) {
    const name = job.runs.join(", ") || job.run;
    this.bar = make("progress", { max: 1, "aria-label": `Progress of ${name}` });
    this.stop = button("Stop", stop, { "aria-label": `Stop ${name}` });
    append(
      this.root,
      make("div", { class: "row" }, make("b", {}, name), this.stop),
      this.words,
      this.bar,
      this.message,
    );
  }

  show(job: Job): void {
    this.root.className = `job ${job.state}`;
    const points = job.done
      ? `: ${job.points ? `${job.done} of ` : ""}${counted(job.points || job.done, "point")}`
      : "";
    this.words.textContent = `${words[job.state]}${job.run && job.runs.length > 1 ? `, ${job.run}` : ""}${points}`;
    this.message.textContent = job.message ?? "";
    this.stop.hidden = job.state !== "running" && job.state !== "waiting";
    this.bar.hidden = job.state !== "running";
    if (job.points && job.done !== null) this.bar.value = job.done / job.points;
    else this.bar.removeAttribute("value"); // it is not known how far it is
  }
}

/** What is computed in the background, with progress and a way to stop it. The newest comes first. */
export class JobList {
  readonly root = make("div", { class: "jobs" });
  private readonly none = make("p", { class: "note" }, "Nothing has been computed yet.");
  private readonly list = make("ul");
  private readonly entries = new Map<string, JobEntry>();

  constructor(private readonly workspace: Workspace) {
    append(this.root, this.none, this.list);
    workspace.on("jobs", () => this.draw());
    this.draw();
  }

  private draw(): void {
    const { jobs, source } = this.workspace;
    this.none.hidden = jobs.length > 0;
    for (const job of jobs) {
      const key = String(job.id);
      let entry = this.entries.get(key);
      if (!entry) {
        entry = new JobEntry(job, () => void source.workshop?.stop(job.id).catch(() => undefined));
        this.entries.set(key, entry);
        this.list.prepend(entry.root);
      }
      entry.show(job);
    }
  }
}
