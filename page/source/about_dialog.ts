import type { Session } from "./contract.js";
import { append, button, make } from "./dom.js";

/** Keys, version and licences. The licences are put into the page when it is built. */
export function aboutDialog(session: Session): HTMLDialogElement {
  const dialog = make("dialog", { class: "about", "aria-label": "About this page" });
  const keys: [string, string][] = [
    ["drag", "zoom into a box"],
    ["wheel, + and −", "zoom"],
    ["shift, space or middle button and drag, shift and arrows", "move"],
    ["double click, 0", "show everything"],
    ["click", "show the orbit of a point"],
    ["← →", "previous or next point of the branch"],
    ["↑ ↓", "next or previous special point"],
    ["Page Up, Page Down", "another run"],
    ["Home, End", "first or last point"],
  ];
  const table = make(
    "table",
    {},
    ...keys.map(([key, words]) => make("tr", {}, make("th", { scope: "row" }, key), make("td", {}, words))),
  );
  const licences = document.getElementById("licences")?.textContent?.trim() ?? "";
  append(
    dialog,
    make("h2", {}, "graze view"),
    make("p", {}, `Version ${session.version}`),
    make("h3", {}, "Keys"),
    table,
    make("h3", {}, "Licences of what is inside"),
    make("pre", { tabindex: 0 }, licences),
    button("Close", () => dialog.close()),
  );
  return dialog;
}
