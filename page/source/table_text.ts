import type { Job, Proposal, StartedJob } from "./contract.js";
import { append, button, fill, labelled, make, messageOf, problem } from "./dom.js";
import type { Workspace } from "./workspace.js";

const delay = 150; // milliseconds: the server is not asked at each key

/** The text of a run that is proposed: it can be changed and named, is computed, and says what became of it. */
export class TableText {
  readonly root = make("div", { class: "table-text" });
  private readonly name = make("input", { type: "text", size: 28, spellcheck: "false" });
  private readonly text = make("textarea", { spellcheck: "false", rows: 4 });
  private readonly note = make("div");
  private readonly message = make("div");
  private readonly start: HTMLButtonElement;
  private ask: (() => Promise<Proposal>) | null = null;
  private asked = 0;
  private timer = 0;
  private ownName = false;
  private edited = false;
  private forget: () => void = () => undefined;

  constructor(
    private readonly workspace: Workspace,
    private readonly compute: (text: string) => Promise<StartedJob>,
  ) {
    this.start = button("Compute", () => void this.begin(), { class: "primary" });
    this.name.addEventListener("input", () => {
      this.ownName = this.name.value.trim() !== "";
      if (this.ownName) this.text.value = renamed(this.text.value, this.name.value.trim());
      this.checkName();
    });
    this.text.addEventListener("input", () => {
      this.edited = true;
      this.name.value = nameIn(this.text.value);
      this.checkName();
      const again = button("Follow the fields again", () => {
        this.edited = false;
        this.propose(this.ask ?? (() => Promise.reject(new Error("there are no fields"))));
      });
      fill(
        this.note,
        make("p", { class: "note" }, "You have changed the text: it does not follow the fields. ", again),
      );
    });
    append(this.root, labelled("name of the run", this.name));
    append(this.root, labelled("what will be added to the study", this.text, { class: "field tall" }));
    append(this.root, this.note, this.start, this.message);
  }

  /** The text is what this answers, unless somebody has changed it by hand. */
  propose(ask: () => Promise<Proposal>): void {
    this.ask = ask;
    fill(this.message);
    if (this.edited) return;
    this.start.disabled = true;
    const asked = ++this.asked;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(
      async () => {
        try {
          const { name, text } = await ask();
          if (asked !== this.asked) return;
          if (!this.ownName) this.name.value = name;
          this.text.value = renamed(withPlainKeys(text), this.name.value.trim());
          this.text.rows = Math.min(14, this.text.value.split("\n").length + 1);
          fill(this.note);
          this.start.disabled = false;
          this.checkName();
        } catch (error) {
          if (asked === this.asked) this.refuse(messageOf(error));
        }
      },
      this.text.value === "" ? 0 : delay,
    );
  }

  /** The fields are wrong: there is no text that does what they say. */
  refuse(why: string): void {
    ++this.asked;
    clearTimeout(this.timer);
    if (!this.edited) this.text.value = "";
    this.start.disabled = !this.edited;
    fill(this.message, problem(why));
  }

  private checkName(): void {
    const name = nameIn(this.text.value);
    if (this.text.value === "") return;
    const taken = this.workspace.runs.some((run) => run.name.toLowerCase() === name.toLowerCase());
    this.start.disabled = taken;
    fill(this.message, taken && problem(`There is a run ${name} already: choose another name.`));
  }

  private async begin(): Promise<void> {
    this.start.disabled = true;
    this.forget();
    try {
      const job = await this.compute(this.text.value);
      this.say(job.runs.join(", "), "waits to be computed");
      this.forget = this.workspace.on("jobs", (jobs) =>
        this.tell(jobs.find(({ id }) => String(id) === String(job.id))),
      );
      this.tell(this.workspace.jobs.find(({ id }) => String(id) === String(job.id)));
    } catch (error) {
      this.start.disabled = false;
      fill(this.message, problem(messageOf(error)));
    }
  }

  /** What has become of the run. */
  private tell(job: Job | undefined): void {
    if (!job) return;
    const runs = job.runs.join(", ");
    if (job.state === "running") this.say(runs, "is computed; it appears in the picture as it grows");
    else if (job.state === "complete") this.say(runs, "is complete");
    else if (job.state === "stopped") this.say(runs, "was stopped; what it has stays");
    else if (job.state === "failed") fill(this.message, problem(`The run ${runs} failed: ${job.message}`));
    if (job.state !== "running" && job.state !== "waiting") this.forget();
  }

  private say(runs: string, words: string): void {
    fill(this.message, make("p", { role: "status" }, `The run ${runs} ${words}.`));
  }
}

const heading = /^\s*\[runs\.("(?:[^"\\]|\\.)*"|[^\]]+)\]/m;

function nameIn(text: string): string {
  return (heading.exec(text)?.[1] ?? "").replace(/^"|"$/g, "").trim();
}

function renamed(text: string, name: string): string {
  const key = /^[A-Za-z0-9_-]+$/.test(name) ? name : JSON.stringify(name);
  return name === "" ? text : text.replace(heading, () => `[runs.${key}]`);
}

/** Keys that need no quotation marks, without them. */
function withPlainKeys(text: string): string {
  return text.replace(/"([A-Za-z_]\w*)" = /g, "$1 = ");
}
