import {
  autocompletion,
  completionKeymap,
  type CompletionContext,
  type CompletionResult,
} from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { bracketMatching, HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { Compartment, EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { appearance } from "./appearance.js";
import type { Mistake } from "./contract.js";
import { make } from "./dom.js";
import { Refusal } from "./source.js";
import type { KnownWord } from "./schema_keys.js";

export interface EditorHelp {
  name: string;
  check(text: string): Promise<Mistake[]>;
  /** Words that can be written at a position. */
  words(text: string, position: number): KnownWord[];
  /** The meaning of a word there; empty if unknown. */
  meaning(text: string, position: number, word: string): string;
  changed(text: string): void;
  checked?(mistakes: Mistake[]): void;
}

const checkDelay = 400; // milliseconds after the last change

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
  { tag: [tags.string, tags.special(tags.string)], color: "var(--string)" },
  { tag: [tags.number, tags.bool, tags.atom], color: "var(--number)" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--accent)" },
  { tag: [tags.keyword, tags.heading], fontWeight: "bold" },
]);

const look = EditorView.theme({
  "&": { height: "100%", fontSize: "0.85rem", color: "var(--ink)", backgroundColor: "var(--ground)" },
  ".cm-scroller": { fontFamily: "DejaVu Sans Mono, Consolas, monospace" },
  ".cm-content": { caretColor: "var(--ink)" },
  ".cm-gutters": { backgroundColor: "var(--panel)", color: "var(--soft)", border: "none" },
  ".cm-activeLine": { backgroundColor: "color-mix(in srgb, var(--accent) 8%, transparent)" },
  "&.cm-focused": { outline: "2px solid var(--accent)", outlineOffset: "-2px" },
  ".cm-tooltip": {
    backgroundColor: "var(--panel)",
    color: "var(--ink)",
    border: "1px solid var(--line)",
    maxWidth: "32em",
  },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--accent)", color: "var(--on-accent)" },
  ".meaning": { padding: "0.3em 0.6em" },
});

/**
 * Replaces what is selected by what is typed. A browser that did so by itself would keep the look of the selected text
 * by inline styles, which the page's policy forbids, and says so.
 */
function typeOver(event: InputEvent, view: EditorView): boolean {
  const { selection } = view.state;
  const plain = event.inputType === "insertText" && !view.composing && !event.isComposing;
  if (!plain || !event.data || selection.main.empty) return false;
  event.preventDefault();
  view.dispatch(view.state.replaceSelection(event.data), { userEvent: "input.type", scrollIntoView: true });
  return true;
}

/** An editor of TOML with mistakes at their places, completion, and meanings of words. */
export class TextEditor {
  readonly root: HTMLElement;
  private readonly view: EditorView;
  private readonly darkness = new Compartment();
  private readonly forget: () => void;
  private timer = 0;

  constructor(
    text: string,
    private readonly help: EditorHelp,
  ) {
    this.root = make("div", { class: "editor" });
    // In a tree of its own the editor brings its styles as objects, which the page's policy for styles allows.
    const shadow = this.root.attachShadow({ mode: "open" });
    const dark = () => EditorView.theme({}, { dark: appearance.look.dark });
    this.view = new EditorView({
      parent: shadow,
      root: shadow,
      state: EditorState.create({
        doc: text,
        extensions: [
          lineNumbers(),
          history(),
          drawSelection(),
          highlightActiveLine(),
          bracketMatching(),
          lintGutter(),
          StreamLanguage.define(toml),
          syntaxHighlighting(colours),
          look,
          this.darkness.of(dark()),
          autocompletion({ override: [(context) => this.complete(context)] }),
          this.meanings(),
          keymap.of([...defaultKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap]),
          EditorView.contentAttributes.of({ "aria-label": help.name }),
          EditorView.lineWrapping,
          EditorView.domEventHandlers({ beforeinput: typeOver }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) this.changed();
          }),
        ],
      }),
    });
    this.forget = appearance.onChange(() => this.view.dispatch({ effects: this.darkness.reconfigure(dark()) }));
    this.view.scrollDOM.tabIndex = 0; // it can be scrolled by keys, too
    void this.check();
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  set text(text: string) {
    if (text !== this.text) this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
  }

  /** Shows a place, and lets it be edited. */
  goTo(line: number, column: number): void {
    const { doc } = this.view.state;
    const at = doc.line(Math.max(1, Math.min(doc.lines, line || 1)));
    const position = Math.min(at.to, at.from + Math.max(0, (column || 1) - 1));
    this.view.dispatch({
      selection: { anchor: position },
      effects: EditorView.scrollIntoView(position, { y: "center" }),
    });
    this.view.focus();
  }

  destroy(): void {
    clearTimeout(this.timer);
    this.forget();
    this.view.destroy();
    this.root.remove();
  }

  private changed(): void {
    this.help.changed(this.text);
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.check(), checkDelay);
  }

  private async check(): Promise<void> {
    const text = this.text;
    let mistakes: Mistake[];
    try {
      mistakes = await this.help.check(text);
    } catch (error) {
      if (!(error instanceof Refusal) || error.status !== 400) return;
      mistakes = [{ problem: error.problem, remedy: error.remedy, line: error.line, column: error.column }];
    }
    if (text !== this.text) return;
    this.help.checked?.(mistakes);
    this.view.dispatch(
      setDiagnostics(
        this.view.state,
        mistakes.map((mistake) => this.diagnostic(mistake)),
      ),
    );
  }

  private diagnostic({ problem, remedy, line, column }: Mistake): Diagnostic {
    const { doc } = this.view.state;
    const at = doc.line(Math.max(1, Math.min(doc.lines, line || 1)));
    const from = Math.min(at.to, at.from + Math.max(0, (column || 1) - 1));
    const word = /^[\w.-]+/.exec(at.text.slice(from - at.from))?.[0].length ?? 0;
    const to = word > 0 ? from + word : at.to;
    return { from, to: Math.max(from, to), severity: "error", message: remedy ? `${problem}: ${remedy}` : problem };
  }

  private complete(context: CompletionContext): CompletionResult | null {
    const word = context.matchBefore(/[\w-]*/);
    if (!word || (word.from === word.to && !context.explicit)) return null;
    const words = this.help.words(context.state.doc.toString(), context.pos);
    if (words.length === 0) return null;
    return {
      from: word.from,
      validFor: /^[\w-]*$/,
      options: words.map(({ name, words: info }) => ({ label: name, info: info || undefined })),
    };
  }

  private meanings() {
    return hoverTooltip((view, position) => {
      const line = view.state.doc.lineAt(position);
      const matches = [...line.text.matchAll(/[A-Za-z_][\w-]*/g)];
      const match = matches.find(
        ({ 0: word, index = 0 }) => line.from + index <= position && position <= line.from + index + word.length,
      );
      if (!match) return null;
      const from = line.from + (match.index ?? 0),
        to = from + match[0].length;
      const text = this.help.meaning(view.state.doc.toString(), to, match[0]);
      return text === ""
        ? null
        : { pos: from, end: to, above: true, create: () => ({ dom: make("div", { class: "meaning" }, text) }) };
    });
  }
}
