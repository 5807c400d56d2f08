import type { FigureMemory } from "./figure_view.js";
import { recall, remember } from "./memory.js";
import type { SimulationStart } from "./simulation_view.js";
import type { Selection } from "./workspace.js";

/** What is shown, to be shown again after the page was loaded anew or the server has another address. */
export interface KeptView {
  figures: FigureMemory[];
  selection: Selection | null;
  tab: string;
  simulation?: SimulationStart | null; // that goes along to another address
}

export function keep(view: KeptView): void {
  remember("view", view);
}

/** As a part of an address. */
export function addressOf(view: KeptView): string {
  return `view=${encodeURIComponent(JSON.stringify(view))}`;
}

/** From the address, which it then leaves, or from the memory of the tab. */
export function kept(): KeptView | null {
  const given = /^#view=(.*)$/.exec(location.hash)?.[1];
  if (given !== undefined) {
    history.replaceState(null, "", location.pathname + location.search);
    try {
      return checked(JSON.parse(decodeURIComponent(given)));
    } catch {
      return null;
    }
  }
  return checked(recall<KeptView>("view"));
}

function checked(view: KeptView | null): KeptView | null {
  const valid =
    view && Array.isArray(view.figures) && view.figures.every((one) => one && typeof one.wish === "object" && one.wish);
  return valid ? view : null;
}
