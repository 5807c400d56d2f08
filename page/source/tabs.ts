import { append, make } from "./dom.js";

interface Tab {
  name: string;
  button: HTMLButtonElement;
  panel: HTMLElement;
  shown: () => void;
}

/** Views of which one is shown, with keys as the ARIA pattern of tabs has them. */
export class Tabs {
  readonly root = make("div", { class: "tabs" });
  private readonly bar = make("div", { role: "tablist", "aria-label": "Views" });
  private readonly tabs: Tab[] = [];
  private current = "";

  constructor() {
    append(this.root, this.bar);
    this.bar.addEventListener("keydown", (event) => {
      const shift = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
      if (shift === 0) return;
      const index = this.tabs.findIndex(({ name }) => name === this.current);
      const next = this.tabs[(index + shift + this.tabs.length) % this.tabs.length];
      this.open(next.name);
      next.button.focus();
    });
  }

  add(name: string, content: HTMLElement, shown: () => void = () => undefined): void {
    const id = `tab-${name.toLowerCase()}`;
    const button = make(
      "button",
      {
        type: "button",
        role: "tab",
        id,
        "aria-controls": `${id}-panel`,
        click: () => this.open(name),
      },
      name,
    );
    const panel = make("div", { role: "tabpanel", id: `${id}-panel`, "aria-labelledby": id, tabindex: 0 }, content);
    this.tabs.push({ name, button, panel, shown });
    append(this.bar, button);
    append(this.root, panel);
    if (this.tabs.length === 1) this.open(name);
    else this.show();
  }

  get opened(): string {
    return this.current;
  }

  open(name: string): void {
    const tab = this.tabs.find((one) => one.name === name);
    if (!tab) return;
    this.current = name;
    this.show();
    tab.shown();
  }

  private show(): void {
    for (const { name, button, panel } of this.tabs) {
      const chosen = name === this.current;
      button.setAttribute("aria-selected", String(chosen));
      button.tabIndex = chosen ? 0 : -1;
      panel.hidden = !chosen;
    }
  }
}
