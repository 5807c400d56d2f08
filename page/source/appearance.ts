import { looks, hex, type Look } from "./palette.js";
import { recall, remember } from "./memory.js";

type Theme = "light" | "dark";

/** How the page looks: its theme, and the larger letters and lines for a projector. */
class Appearance {
  private readonly system = matchMedia("(prefers-color-scheme: dark)");
  private chosen: Theme | null = recall<Theme>("theme");
  private large = recall<boolean>("projector") ?? false;
  private readonly listeners = new Set<() => void>();

  constructor() {
    this.system.addEventListener("change", () => this.apply());
    this.apply();
  }

  readonly font = '"DejaVu Sans", "Segoe UI", "Helvetica Neue", sans-serif';

  get theme(): Theme {
    return this.chosen ?? (this.system.matches ? "dark" : "light");
  }
  get look(): Look {
    return looks[this.theme];
  }
  get ink(): string {
    return hex(this.look.ink);
  }
  get projector(): boolean {
    return this.large;
  }
  /** Factor for letters, lines and symbols in diagrams. */
  get size(): number {
    return this.large ? 1.5 : 1;
  }

  toggleTheme(): void {
    this.chosen = this.theme === "dark" ? "light" : "dark";
    remember("theme", this.chosen);
    this.apply();
  }

  toggleProjector(): void {
    this.large = !this.large;
    remember("projector", this.large);
    this.apply();
  }

  onChange(act: () => void): () => void {
    this.listeners.add(act);
    return () => this.listeners.delete(act);
  }

  private apply(): void {
    document.documentElement.dataset.theme = this.theme;
    document.documentElement.classList.toggle("projector", this.large);
    for (const act of this.listeners) act();
  }
}

export const appearance = new Appearance();
