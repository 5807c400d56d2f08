import type { Mistake } from "./contract.js";
import { button, make } from "./dom.js";
import type { TextEditor } from "./text_editor.js";

/** The mistakes of a text, each of which leads to its place. */
export function mistakeList(mistakes: Mistake[], editor: () => TextEditor | null): HTMLElement {
  const entry = ({ problem, remedy, line, column }: Mistake) => {
    const words = remedy ? `${problem}: ${remedy}` : problem;
    const place = line ? button(`line ${line}`, () => editor()?.goTo(line, column)) : null;
    return make("li", {}, place, place ? ` ${words}` : words);
  };
  return make("ul", { "aria-label": "Mistakes" }, ...mistakes.map(entry));
}

/** "the text has a mistake" */
export function mistakesInWords(mistakes: Mistake[]): string {
  return `the text has ${mistakes.length === 1 ? "a mistake" : "mistakes"}`;
}
