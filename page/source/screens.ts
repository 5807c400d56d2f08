import { button, make } from "./dom.js";

/**
 * Where there is no room for three columns, the list of runs or the chosen point is shown; these buttons choose which.
 * The style hides them on wide screens.
 */
export class Screens {
  readonly root = make("div", { class: "screens", role: "group", "aria-label": "What stands beside the pictures" });
  private readonly runs = button("Runs", () => this.showSide(false));
  private readonly side: HTMLButtonElement;

  constructor(
    private readonly columns: HTMLElement,
    nameOfSide: string,
  ) {
    this.side = button(nameOfSide, () => this.showSide(true));
    this.root.append(this.runs, this.side);
    this.showSide(false);
  }

  showSide(on: boolean): void {
    this.columns.classList.toggle("side-shown", on);
    this.runs.setAttribute("aria-pressed", String(!on));
    this.side.setAttribute("aria-pressed", String(on));
  }
}
