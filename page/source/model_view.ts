import type { Mistake, Model } from "./contract.js";
import { append, button, fill, make, messageOf, offer, problem } from "./dom.js";
import { forget, recall, remember } from "./memory.js";
import { modelHelp } from "./editor_help.js";
import { mistakeList, mistakesInWords } from "./mistake_list.js";
import { Refusal } from "./source.js";
import { TextEditor } from "./text_editor.js";
import type { Workspace } from "./workspace.js";

export interface ModelActs {
  simulate(model: Model, text: string): Promise<void>;
  stored(model: Model): void; // the stored text is back
  saved(): Promise<void>; // in the file of the opened model
}

/** The text of a model: shown; edited, tried and saved where something can be computed. */
export class ModelView {
  readonly root = make("div", { class: "text-view" });
  private readonly heading = make("div", { class: "row" });
  private readonly place = make("div", { class: "editor-place" });
  private readonly note = make("p", { class: "note", role: "status" });
  private readonly message = make("div", { role: "status" });
  private readonly simulate = button("Simulate this model", () => void this.tryIt(), { class: "primary" });
  private readonly save = button("Save", () => void this.keepInFile(false));
  private editor: TextEditor | null = null;
  private model: Model | null = null;
  private run: string | null = null;
  private mistakes: Mistake[] = [];

  constructor(
    private readonly workspace: Workspace,
    private readonly acts: ModelActs,
  ) {
    append(this.root, this.heading, this.note, this.message, this.place);
    fill(this.heading, make("p", { class: "note" }, "Choose a run to see its model here."));
  }

  /** @param run whose model it is; null: the opened one */
  async show(model: Model, run: string | null): Promise<void> {
    if (this.model && model.text === this.model.text && model.revision === this.model.revision && run === this.run)
      return;
    this.editor?.destroy();
    this.editor = null;
    this.model = model;
    this.run = run;
    this.mistakes = [];
    fill(this.message);
    const { workshop } = this.workspace.source;
    const download = button("Download", () =>
      offer(`${model.name || "model"}.toml`, new Blob([this.text], { type: "application/toml" })),
    );
    const tools = workshop ? [this.simulate, model.file ? this.save : null] : [];
    fill(this.heading, make("b", {}, model.file ?? model.name), ...tools, download);
    if (!workshop) {
      fill(this.place, make("pre", { tabindex: 0 }, model.text));
      return;
    }
    const help = await modelHelp(
      workshop,
      () => this.model,
      () => this.changed(),
      (mistakes) => this.checked(mistakes),
    );
    if (this.model !== model) return; // another one was chosen meanwhile
    const before = recall<{ of: string; text: string }>(this.key);
    this.editor = new TextEditor(before?.of === model.text ? before.text : model.text, help);
    this.changed();
    fill(this.place, this.editor.root);
  }

  private get key(): string {
    return `model ${this.run ?? ""}`;
  }

  private get text(): string {
    return this.editor?.text ?? this.model?.text ?? "";
  }

  /** Edits survive a reload of the page; they change a file only if they are saved there. */
  private changed(): void {
    const { model, run } = this;
    if (!model) return;
    const edited = this.text !== model.text;
    if (edited) remember(this.key, { of: model.text, text: this.text });
    else forget(this.key);
    const copy =
      run !== null
        ? `A copy of the model of run ${run}, as graze has stored it: without comments, with its values as numbers.`
        : model.file
          ? `The model in ${model.file}.`
          : "A copy of the model that was opened.";
    const keeping = model.file ? "keep them with “Save”" : "keep them with “Download”";
    const words = edited
      ? `You have changed this text: no run and no file has the changes. Try them with “Simulate this model”, ${keeping}. `
      : `${copy} Change it to try something${model.file ? "" : "; runs and files stay as they are"}.`;
    fill(this.note, words, edited ? button("Back to the stored text", () => this.goBack()) : null);
  }

  private checked(mistakes: Mistake[]): void {
    this.mistakes = mistakes;
    this.simulate.disabled = this.save.disabled = mistakes.length > 0;
    fill(
      this.message,
      mistakes.length > 0
        ? make(
            "div",
            { class: "problem" },
            make("p", {}, `Not to be simulated: ${mistakesInWords(mistakes)}.`),
            mistakeList(mistakes, () => this.editor),
          )
        : null,
    );
  }

  private goBack(): void {
    const { editor, model } = this;
    if (!editor || !model) return;
    editor.text = model.text;
    this.checked([]);
    this.acts.stored(model);
  }

  private async tryIt(): Promise<void> {
    if (!this.model || this.mistakes.length > 0) return;
    try {
      await this.acts.simulate(this.model, this.text);
    } catch (error) {
      fill(this.message, problem(messageOf(error)));
    }
  }

  /** @param replace what another program has written into the file */
  private async keepInFile(replace: boolean): Promise<void> {
    const { workshop } = this.workspace.source,
      { model, editor } = this;
    if (!workshop || !model || !editor) return;
    try {
      const { text, file, revision } = await workshop.keepModel(editor.text, model.revision ?? 0, replace);
      this.model = { ...model, text, revision };
      this.changed();
      await this.acts.saved();
      const outdated = this.workspace.runs.filter(({ status }) => status === "outdated").map(({ name }) => name);
      const again = outdated.length > 0 ? ` Out of date now, to be computed anew: ${outdated.join(", ")}.` : "";
      fill(this.message, make("p", { class: "note" }, `Saved in ${file}.${again}`));
    } catch (error) {
      const conflict = error instanceof Refusal && error.status === 409;
      fill(
        this.message,
        problem(messageOf(error)),
        conflict ? button("Save over it", () => void this.keepInFile(true)) : null,
        conflict ? button("Take the text of the file", () => void this.takeFile()) : null,
      );
    }
  }

  private async takeFile(): Promise<void> {
    const model = await this.workspace.source.model(null).catch(() => null);
    if (!model) return;
    forget(this.key);
    await this.show(model, null);
    this.acts.stored(model);
  }
}
