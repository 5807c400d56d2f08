import { make } from "./dom.js";
import { recall, remember } from "./memory.js";

/** A border that can be moved: it sets the width of the side of the page, in percent, as a style variable. */
export function splitter(columns: HTMLElement): HTMLElement {
  const [least, most] = [18, 60];
  const bar = make("div", {
    class: "splitter",
    role: "separator",
    tabindex: 0,
    "aria-orientation": "vertical",
    "aria-label": "Width of the side",
    "aria-valuemin": least,
    "aria-valuemax": most,
  });
  let width = recall<number>("side") ?? 29;
  const set = (wanted: number) => {
    width = Math.max(least, Math.min(most, wanted));
    columns.style.setProperty("--side", `${width}%`);
    bar.setAttribute("aria-valuenow", String(Math.round(width)));
    remember("side", width);
  };
  set(width);
  bar.addEventListener("pointerdown", (event) => bar.setPointerCapture(event.pointerId));
  bar.addEventListener("pointermove", (event) => {
    if (!bar.hasPointerCapture(event.pointerId)) return;
    const box = columns.getBoundingClientRect();
    set((100 * (box.right - event.clientX)) / box.width);
  });
  bar.addEventListener("keydown", (event) => {
    const step = event.key === "ArrowLeft" ? 2 : event.key === "ArrowRight" ? -2 : 0;
    if (step === 0) return;
    event.preventDefault();
    set(width + step);
  });
  return bar;
}
