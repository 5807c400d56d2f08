import { entry } from "./colouring.js";
import type { ColourName, Figure, Panel, Series } from "./contract.js";
import { pale } from "./palette.js";

/**
 * One figure of the figures of several runs, as far as their panels have the same quantities: each run gets colours of
 * its own, and the legend names the runs. Null if the runs have no panel in common.
 */
export function mergedFigure(parts: { run: string; figure: Figure }[]): Figure | null {
  let next = 0;
  const coloured = parts.map(({ run, figure }) => {
    const first = next;
    next += coloursOf(figure);
    return { run, first, figure: shifted(figure, first) };
  });
  const [base, ...others] = coloured;
  const panels: Panel[] = [];
  for (const panel of base.figure.panels) {
    const same = others.map(({ figure }) => figure.panels.find((one) => haveSameAxes(one, panel)));
    if (same.some((one) => one === undefined)) continue;
    const all = [panel, ...same.filter((one): one is Panel => one !== undefined)];
    const names = coloured.map(({ run, first }) => entry(run, "line", first));
    panels.push({
      ...panel,
      title: "",
      series: [...all.flatMap(({ series }) => series.filter((one) => !one.only_in_legend)), ...names, ...legendOf(all)],
      labels: all.flatMap(({ labels }) => labels),
      marks: all.flatMap(({ marks }) => marks),
      notes: all.flatMap(({ notes }) => notes),
    });
  }
  if (panels.length === 0) return null;
  return { ...base.figure, title: "", columns: panels.length > 1 ? 2 : 1, panels };
}

/**
 * Branches over the dots of a sweep, where both have the same horizontal axis and the same unit of y.
 * @param names of the runs of the branches
 * @param belongs whether the value of a branch belongs to one of the sweep
 */
export function drawnOver(
  base: Figure,
  branches: Figure,
  names: string,
  belongs: (value: string, ofBranch: string) => boolean,
): Figure | null {
  const first = coloursOf(base),
    several = names.includes(",");
  const over = shifted(branches, first);
  const panels: Panel[] = [];
  for (const panel of base.panels) {
    const fitting = over.panels.filter(
      ({ x, y }) => x.label === panel.x.label && y.unit === panel.y.unit && belongs(panel.y.label, y.label),
    );
    if (fitting.length === 0) continue;
    const inLegend = several
      ? fitting.flatMap(({ series }) => series.filter((one) => one.only_in_legend))
      : [entry(names, "line", first), ...legendOf(fitting)];
    const values = fitting.map(({ y }) => y.label).filter((label) => label !== panel.y.label);
    const both = values.length > 0 ? `${panel.y.label} (dots), ${values.join(", ")} (lines)` : panel.y.label;
    panels.push({
      ...panel,
      x: { ...panel.x, range: null },
      y: { ...panel.y, label: both, words: values.length > 0 ? "" : panel.y.words, range: null },
      series: [
        ...panel.series,
        ...fitting.flatMap(({ series }) => series.filter((one) => !one.only_in_legend)),
        ...inLegend,
      ],
      labels: [...panel.labels, ...fitting.flatMap(({ labels }) => labels)],
      notes: [
        ...panel.notes,
        ...(values.length > 0
          ? [
              `Dots: ${panel.y.label} where motions are sampled. Lines: ${values.map((name) => extremeWords(name)).join(", ")} along the orbit. They meet the dots only where ${panel.y.label} is sampled at that value.`,
            ]
          : []),
      ],
    });
  }
  return panels.length > 0 ? { ...base, title: "", panels } : null;
}

/** "greatest x" for max_x. */
function extremeWords(name: string): string {
  return name.replace(/^max_/, "greatest ").replace(/^min_/, "least ");
}

function haveSameAxes(one: Panel, other: Panel): boolean {
  return one.x.label === other.x.label && one.y.label === other.y.label;
}

function coloursOf(figure: Figure): number {
  const all = figure.panels.flatMap(({ series }) => series.map(({ colour }) => colour));
  return 1 + Math.max(0, ...all.map((colour) => (typeof colour === "number" ? colour % pale : 0)));
}

function shifted(figure: Figure, by: number): Figure {
  const shift = (colour: ColourName): ColourName => (typeof colour === "number" ? colour + by : colour);
  return {
    ...figure,
    panels: figure.panels.map((panel) => ({
      ...panel,
      series: panel.series.map((one) => ({ ...one, colour: shift(one.colour) })),
      // In a picture of one run labels are black.
      labels: panel.labels.map((one) => ({ ...one, colour: one.colour === "black" ? by : shift(one.colour) })),
    })),
  };
}

/** Meanings of lines and symbols, which are the same for all runs: each once, and black. */
function legendOf(panels: Panel[]): Series[] {
  const known = new Map<string, Series>();
  for (const { series } of panels)
    for (const one of series)
      if (one.only_in_legend) known.set(one.title, { ...one, colour: one.colour === "grey" ? "grey" : "black" });
  return [...known.values()];
}
