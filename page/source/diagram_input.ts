import type { Diagram } from "./diagram.js";
import { scaled, shifted, type View } from "./frame.js";

const clickDistance = 4; // pixels that a pointer may move during a click

/** Zoom at `part` of the way along each axis. */
export function zoomed(diagram: Diagram, factor: number, partX: number, partY: number): View {
  const [x, y] = diagram.logarithmic,
    view = diagram.currentView;
  return { x: scaled(view.x, factor, partX, x), y: scaled(view.y, factor, partY, y) };
}

export function moved(diagram: Diagram, partX: number, partY: number, from = diagram.currentView): View {
  const [x, y] = diagram.logarithmic;
  return { x: shifted(from.x, partX, x), y: shifted(from.y, partY, y) };
}

/** Connects pointer, wheel and keys with a diagram. A drag that zooms into a box is uPlot's. */
export function bindInput(diagram: Diagram, over: HTMLElement): () => void {
  const { root } = diagram;
  const ends = new AbortController();
  const listen = <K extends keyof HTMLElementEventMap>(
    target: HTMLElement,
    type: K,
    act: (event: HTMLElementEventMap[K]) => void,
    options: AddEventListenerOptions = {},
  ) => target.addEventListener(type, act, { ...options, signal: ends.signal });

  bindHover(diagram, over, listen);
  bindPanning(diagram, over, listen);
  listen(
    over,
    "wheel",
    (event) => {
      event.preventDefault();
      const box = over.getBoundingClientRect();
      const pixels = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
      const factor = Math.exp(Math.max(-1, Math.min(1, pixels * 0.0022)));
      const x = (event.clientX - box.left) / box.width,
        y = 1 - (event.clientY - box.top) / box.height;
      diagram.setView(zoomed(diagram, factor, x, y), true);
    },
    { passive: false },
  );
  listen(over, "dblclick", () => diagram.showAll(true));
  listen(root, "keydown", (event) => {
    if (event.target === root && act(diagram, event)) event.preventDefault();
  });
  listen(root, "keyup", (event) => {
    if (event.key === " ") delete root.dataset.panning;
  });
  listen(root, "blur", () => delete root.dataset.panning);
  return () => ends.abort();
}

type Listen = <K extends keyof HTMLElementEventMap>(
  target: HTMLElement,
  type: K,
  act: (event: HTMLElementEventMap[K]) => void,
  options?: AddEventListenerOptions,
) => void;

function bindHover(diagram: Diagram, over: HTMLElement, listen: Listen): void {
  let awaited = 0,
    x = 0,
    y = 0,
    downX = 0,
    downY = 0;
  listen(over, "pointermove", (event) => {
    if (event.buttons !== 0) return;
    const box = over.getBoundingClientRect();
    x = event.clientX - box.left;
    y = event.clientY - box.top;
    // One search for each frame, however fast the pointer moves.
    if (!awaited)
      awaited = requestAnimationFrame(() => {
        awaited = 0;
        diagram.showHit(diagram.hitAt(x, y), x, y);
      });
  });
  listen(over, "pointerleave", () => {
    cancelAnimationFrame(awaited);
    awaited = 0;
    diagram.showHit(null);
  });
  listen(over, "pointerdown", (event) => {
    downX = event.clientX;
    downY = event.clientY;
    diagram.root.focus({ preventScroll: true });
  });
  listen(over, "click", (event) => {
    if (event.shiftKey || Math.hypot(event.clientX - downX, event.clientY - downY) > clickDistance) return;
    const box = over.getBoundingClientRect();
    const hit = diagram.hitAt(event.clientX - box.left, event.clientY - box.top);
    if (hit) diagram.options.pick?.(hit);
  });
}

function bindPanning(diagram: Diagram, over: HTMLElement, listen: Listen): void {
  let from: { x: number; y: number; view: View } | null = null;
  listen(over, "pointerdown", (event) => {
    const wanted = event.button === 1 || (event.button === 0 && (event.shiftKey || diagram.root.dataset.panning));
    if (!wanted && event.pointerType !== "touch") return;
    event.preventDefault();
    over.setPointerCapture(event.pointerId);
    from = { x: event.clientX, y: event.clientY, view: diagram.currentView };
    diagram.showHit(null);
  });
  listen(over, "pointermove", (event) => {
    if (!from) return;
    const box = over.getBoundingClientRect();
    const x = (from.x - event.clientX) / box.width,
      y = (event.clientY - from.y) / box.height;
    diagram.setView(moved(diagram, x, y, from.view), true);
  });
  const stop = () => (from = null);
  listen(over, "pointerup", stop);
  listen(over, "pointercancel", stop);
}

const panning: Record<string, [number, number]> = {
  ArrowLeft: [-0.15, 0],
  ArrowRight: [0.15, 0],
  ArrowUp: [0, 0.15],
  ArrowDown: [0, -0.15],
};

function act(diagram: Diagram, event: KeyboardEvent): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  if (event.shiftKey && event.key in panning) {
    diagram.setView(moved(diagram, ...panning[event.key]), true);
    return true;
  }
  switch (event.key) {
    case "+":
    case "=":
      diagram.setView(zoomed(diagram, 0.8, 0.5, 0.5), true);
      return true;
    case "-":
    case "_":
      diagram.setView(zoomed(diagram, 1.25, 0.5, 0.5), true);
      return true;
    case "0":
      diagram.showAll(true);
      return true;
    case "Enter":
      return diagram.options.enter?.() ?? false;
    case " ":
      diagram.root.dataset.panning = "yes";
      return true;
    default:
      return diagram.options.step?.(event.key) ?? false;
  }
}
