import type { Model } from "./contract.js";
import { append, button, fill, make, offer } from "./dom.js";
import { forget, recall, remember } from "./memory.js";
import { modelHelp } from "./editor_help.js";
import { TextEditor } from "./text_editor.js";
import type { Workspace } from "./workspace.js";

/** The text of a model: shown; edited and tried at once where something can be computed. */
export class ModelView {
  readonly root = make("div", { class: "text-view" });
  private readonly heading = make("div", { class: "row" });
  private readonly place = make("div", { class: "editor-place" });
  private shownText = "";
  private editor: TextEditor | null = null;
  private model: Model | null = null;
  private readonly note = make("p", { class: "note", role: "status" });

  constructor(
    private readonly workspace: Workspace,
    private readonly simulate: (model: Model, text: string) => void,
  ) {
    append(this.root, this.heading, this.note, this.place);
    fill(this.heading, make("p", { class: "note" }, "Choose a run to see its model here."));
  }

  /** @param run whose model it is; null: the opened one */
  async show(model: Model, run: string | null): Promise<void> {
    if (model.text === this.shownText) return;
    this.shownText = model.text;
    this.editor?.destroy();
    this.editor = null;
    this.model = model;
    const { workshop } = this.workspace.source;
    const save = button("Download", () =>
      offer(`${model.name || "model"}.toml`, new Blob([this.text], { type: "application/toml" })),
    );
    const simulate = workshop
      ? button("Move parameters", () => this.simulate(model, this.text), { class: "primary" })
      : null;
    fill(this.heading, make("b", {}, model.name), simulate, save);
    if (!workshop) {
      fill(this.place, make("pre", { tabindex: 0 }, model.text));
      return;
    }
    const key = `model ${run ?? ""}`;
    const help = await modelHelp(
      workshop,
      () => this.model,
      (text) => this.keep(key, model, run, text),
    );
    if (this.model !== model) return; // another one was chosen meanwhile
    const before = recall<{ of: string; text: string }>(key);
    const text = before?.of === model.text ? before.text : model.text;
    this.editor = new TextEditor(text, help);
    this.keep(key, model, run, text);
    fill(this.place, this.editor.root);
  }

  /** Edits survive a reload of the page. They change no run, and no file. */
  private keep(key: string, model: Model, run: string | null, text: string): void {
    const edited = text !== model.text;
    if (edited) remember(key, { of: model.text, text });
    else forget(key);
    const copy =
      run === null
        ? "A copy of the model that was opened."
        : `A copy of the model of run ${run}, as graze has stored it: without comments, with its values as numbers.`;
    const words = edited
      ? "You have changed this copy: no run and no file has the changes. Try them with “Move parameters”, keep them with “Download”. "
      : `${copy} Change it to try something; runs and files stay as they are.`;
    const back = edited
      ? button("Back to the stored text", () => this.editor && (this.editor.text = model.text))
      : null;
    fill(this.note, words, back);
  }

  private get text(): string {
    return this.editor?.text ?? this.shownText;
  }
}
