import { aboutDialog } from "./about_dialog.js";
import { appearance } from "./appearance.js";
import { append, button, make } from "./dom.js";
import { stateWords } from "./run_list.js";
import type { Workspace } from "./workspace.js";

/** The title, what is being computed, and how the page looks. */
export function pageHeader(workspace: Workspace, ...more: HTMLElement[]): HTMLElement {
  const { session } = workspace;
  const state = make("span", { class: "state", role: "status", "aria-live": "off" });
  const spoken = make("div", { class: "unseen", role: "status", "aria-live": "polite" });
  const show = () => {
    const words = stateWords(workspace);
    state.textContent = words || (session.stored ? "stored results" : "");
    state.classList.toggle("busy", words !== "");
  };
  workspace.on("jobs", show);
  workspace.on("announce", (text) => (spoken.textContent = text));
  show();
  const theme = button("", () => appearance.toggleTheme());
  const projector = button("Projector", () => appearance.toggleProjector(), { title: "Larger letters and lines" });
  const update = () => {
    theme.textContent = appearance.theme === "dark" ? "Light" : "Dark";
    projector.setAttribute("aria-pressed", String(appearance.projector));
  };
  appearance.onChange(update);
  update();
  const about = aboutDialog(session);
  const header = make(
    "header",
    { class: "page-header" },
    make("h1", {}, session.title || session.opened.name || "graze"),
    state,
  );
  append(
    header,
    spoken,
    make("span", { class: "space" }),
    ...more,
    theme,
    projector,
    button("About", () => about.showModal()),
    about,
  );
  return header;
}
