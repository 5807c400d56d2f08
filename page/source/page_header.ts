import { aboutDialog } from "./about_dialog.js";
import { appearance } from "./appearance.js";
import { append, button, make } from "./dom.js";
import { stateWords } from "./run_list.js";
import type { Session } from "./contract.js";
import type { Workspace } from "./workspace.js";

/** The name of what is opened: that of its file, or of the folder of results. */
function nameOf({ opened, title }: Session): string {
  const [last, folder] = opened.name
    .split("/")
    .filter((part) => part !== "")
    .reverse();
  return (last === "results.sqlite" && folder ? folder : last) || title || "graze";
}

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
    make("h1", { title: session.title || null }, nameOf(session)),
    session.title && session.title !== nameOf(session) ? make("span", { class: "about" }, session.title) : null,
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
