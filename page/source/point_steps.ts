import type { Panel } from "./contract.js";
import type { Diagram } from "./diagram.js";
import { placeOf, type Hit } from "./nearest.js";
import { symbolOf, withUnit } from "./numbers.js";
import type { Selection } from "./workspace.js";

/** All numbers of stored points of a run that a diagram shows, in their order. */
function numbersOf(diagram: Diagram, run: string): number[] {
  const numbers = new Set<number>();
  for (const { series } of diagram.data.drawn)
    if (series.run === run) for (const number of series.numbers ?? []) if (number !== null) numbers.add(number);
  return [...numbers].sort((one, other) => one - other);
}

function labelled(diagram: Diagram, run: string): number[] {
  const numbers = diagram.data.labels.filter((label) => label.run === run).map((label) => label.number);
  return numbers.filter((number): number is number => typeof number === "number").sort((one, other) => one - other);
}

function runsOf(diagram: Diagram): string[] {
  const runs = diagram.data.drawn.map(({ series }) => series.run).filter((run): run is string => !!run);
  return [...new Set(runs)];
}

/**
 * The point to which a key leads: left and right go along the branch, up and down to the labelled points, Page Up and
 * Page Down to other runs.
 */
export function pointAfter(diagram: Diagram, from: Selection | null, key: string): Hit | null {
  const runs = runsOf(diagram);
  if (runs.length === 0) return null;
  const known = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "PageUp", "PageDown", "Home", "End"];
  if (!known.includes(key)) return null;
  if (!from || !runs.includes(from.run)) return diagram.firstPoint();
  if (key === "PageUp" || key === "PageDown") {
    const shift = key === "PageDown" ? 1 : runs.length - 1;
    const run = runs[(runs.indexOf(from.run) + shift) % runs.length];
    return placeOf(diagram.data, run, numbersOf(diagram, run)[0]);
  }
  const byLabel = key === "ArrowUp" || key === "ArrowDown";
  const numbers = byLabel ? labelled(diagram, from.run) : numbersOf(diagram, from.run);
  if (numbers.length === 0) return null;
  const after = numbers.find((number) => number > from.number);
  const before = numbers.filter((number) => number < from.number).pop();
  const next =
    key === "Home"
      ? numbers[0]
      : key === "End"
        ? numbers[numbers.length - 1]
        : key === "ArrowRight" || key === "ArrowUp"
          ? after
          : before;
  return next === undefined ? null : placeOf(diagram.data, from.run, next);
}

export function describeHit(hit: Hit, panel: Panel, type: string): string {
  const label = hit.label ? `, ${hit.label.text}` : type ? `, ${type}` : "";
  const value = (axis: Panel["x"], number: number) =>
    `${symbolOf(axis.label || axis.words)} ${withUnit(number, axis.unit)}`;
  return `${hit.run} point ${hit.number}${label}: ${value(panel.x, hit.x)}, ${value(panel.y, hit.y)}`;
}
