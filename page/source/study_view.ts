import type { Job, Model, StudyText } from "./contract.js";
import { append, button, fill, labelled, make, messageOf } from "./dom.js";
import { studyHelp } from "./editor_help.js";
import { mistakeList, mistakesInWords } from "./mistake_list.js";
import { Refusal } from "./source.js";
import { TextEditor } from "./text_editor.js";
import type { Workspace } from "./workspace.js";

/** The text of the study: shown, edited, saved, computed. */
export class StudyView {
  readonly root = make("div", { class: "text-view" });
  private readonly heading = make("div", { class: "row" });
  private readonly message = make("div", { role: "status" });
  private readonly place = make("div", { class: "editor-place" });
  private readonly fileName = make("input", { type: "text", size: 28 });
  private editor: TextEditor | null = null;
  private study: StudyText | null = null;
  private changed = false;
  private conflict = false;
  private forget: () => void = () => undefined; // the job that is awaited

  constructor(
    private readonly workspace: Workspace,
    private readonly model: () => Model | null,
  ) {
    append(this.root, this.heading, this.message, this.place);
  }

  get hasUnsavedText(): boolean {
    return this.changed;
  }

  /** Loads the text when it is shown for the first time. */
  async show(): Promise<void> {
    const { workshop } = this.workspace.source;
    if (!workshop || this.editor) return;
    try {
      const study = await workshop.study();
      const help = await studyHelp(workshop, this.model, () => this.edited());
      if (this.editor) return;
      this.editor = new TextEditor(study.text, help);
      fill(this.place, this.editor.root);
      this.take(study);
    } catch (error) {
      this.say(messageOf(error), true);
    }
  }

  /** Somebody else, or a button of this page, has changed the study. */
  async reload(revision: number): Promise<void> {
    const { workshop } = this.workspace.source;
    if (!this.editor || !workshop || revision === this.study?.revision) return;
    if (this.changed) return this.refuse();
    const study = await workshop.study().catch(() => null);
    if (!study) return;
    this.editor.text = study.text;
    this.take(study);
  }

  private take(study: StudyText): void {
    const named = this.study?.has_file;
    this.study = study;
    this.changed = this.conflict = false;
    this.tell(study, "");
    if (named === study.has_file && this.heading.childElementCount > 0) return;
    // A text without a file gets one when it is saved for the first time.
    this.fileName.value = study.name.endsWith(".toml") ? study.name : `${study.name}.toml`;
    fill(
      this.heading,
      study.has_file ? make("b", {}, study.name) : labelled("file", this.fileName),
      button("Save", () => void this.keep(true), { class: "primary" }),
      button("Save and compute", () => void this.compute()),
    );
  }

  private edited(): void {
    if (!this.editor || this.editor.text === this.study?.text) return;
    this.changed = true;
    if (!this.conflict) this.say("changed, not saved");
  }

  private refuse(): void {
    this.conflict = true;
    const take = button("Take the other text", async () => {
      const study = await this.workspace.source.workshop?.study().catch(() => null);
      if (!study || !this.editor) return;
      this.study = study; // before the text, which is then no change
      this.editor.text = study.text;
      this.take(study);
    });
    const keep = button("Keep mine", async () => {
      const study = await this.workspace.source.workshop?.study().catch(() => null);
      if (study) this.study = study;
      this.conflict = false;
      await this.keep(true, true);
    });
    fill(this.message, "The study was changed elsewhere while you edited it. ", take, keep);
    this.message.className = "problem";
  }

  private async keep(save: boolean, replace = false): Promise<boolean> {
    const { workshop } = this.workspace.source,
      { editor, study } = this;
    if (!workshop || !editor || !study) return false;
    try {
      const name = this.fileName.value.trim(),
        file = study.has_file ? undefined : name.endsWith(".toml") ? name : `${name}.toml`;
      this.take(await workshop.keepStudy(editor.text, study.revision, { save, file, replace }));
      return true;
    } catch (error) {
      // The text may be as it was: then the file is what cannot be written.
      const conflict = error instanceof Refusal && error.status === 409;
      const now = conflict && !study.has_file ? await workshop.study().catch(() => null) : null;
      if (conflict && now?.revision !== study.revision) this.refuse();
      else this.say(messageOf(error), true);
      return false;
    }
  }

  private async compute(): Promise<void> {
    if (!(await this.keep(true))) return;
    const { workshop } = this.workspace.source,
      { study } = this;
    if (!workshop || !study) return;
    if (study.errors && study.errors.length > 0) return this.tell(study, ", but nothing is computed");
    try {
      await this.workspace.refresh();
      const { runs: own } = await workshop.check("study", study.text);
      const wanted = this.workspace.runs.filter(({ name, status }) => status !== "complete" && own.includes(name));
      if (own.length === 0) return this.tell(study, "; it has no runs yet");
      if (wanted.length === 0) return this.tell(study, "; all its runs are complete");
      const job = await workshop.start({ runs: wanted.map(({ name }) => name) });
      this.forget();
      this.forget = this.workspace.on("jobs", (jobs) => this.tellJob(jobs.find(({ id }) => id === job.id)));
      this.tell(
        study,
        `; ${job.runs.length === 1 ? "one run is" : `${job.runs.length} runs are`} being computed: ${job.runs.join(", ")}`,
      );
      this.tellJob(this.workspace.jobs.find(({ id }) => id === job.id));
    } catch (error) {
      this.say(`Saved, but not computed: ${messageOf(error)}`, true);
    }
  }

  /** What has become of the runs, unless the text was changed meanwhile. */
  private tellJob(job: Job | undefined): void {
    if (!job || job.state === "running" || job.state === "waiting") return;
    this.forget();
    if (!this.study || this.changed || this.conflict) return;
    const runs = job.runs.join(", ");
    if (job.state === "failed") this.say(`Saved, but not computed: ${job.message}`, true);
    else this.tell(this.study, job.state === "complete" ? `; computed: ${runs}` : `; stopped: ${runs}`);
  }

  /** Where the text is, and its mistakes, each of which leads to its place. */
  private tell(study: StudyText, more: string): void {
    const state = study.saved ? `Saved in ${study.name}` : "Not saved yet";
    const mistakes = study.errors ?? [];
    if (mistakes.length === 0) return this.say(`${state}${more}.`);
    fill(
      this.message,
      make("p", {}, `${state}${more}: ${mistakesInWords(mistakes)}.`),
      mistakeList(mistakes, () => this.editor),
    );
    this.message.className = "problem";
  }

  private say(text: string, isProblem = false): void {
    this.message.textContent = text;
    this.message.className = isProblem ? "problem" : "note";
  }
}
