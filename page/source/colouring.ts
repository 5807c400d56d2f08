import type { ColourName, Figure, Series } from "./contract.js";
import type { Workspace } from "./workspace.js";

/** What the colours of a picture mean: as it came, the run, or the series that the legend names. */
export type Colouring = "picture" | "run" | "stability";

export const colourings: { value: Colouring; text: string }[] = [
  { value: "picture", text: "as in the study" },
  { value: "run", text: "run" },
  { value: "stability", text: "stability" },
];

const stable = 0,
  unstable = 12;

export function recoloured(figure: Figure, colouring: Colouring, workspace: Workspace): Figure {
  if (colouring === "picture") return figure;
  const order = new Map(workspace.runs.map((run, index) => [run.name, index]));
  const colourOf = (series: Series): ColourName => {
    if (series.colour === "grey") return "grey";
    if (colouring === "run") return series.run ? (order.get(series.run) ?? series.colour) : series.colour;
    if (series.style === "dashed") return unstable;
    return series.style === "line" ? stable : "black";
  };
  // Legends name runs by colours of the study, which then say nothing: the names of runs replace them.
  const replaced = (series: Series) =>
    !(series.only_in_legend && typeof series.colour === "number" && series.style !== "symbols");
  return {
    ...figure,
    panels: figure.panels.map((panel) => ({
      ...panel,
      series: [
        ...panel.series.filter(replaced).map((series) => ({ ...series, colour: colourOf(series) })),
        ...(colouring === "run" ? namesOfRuns(panel.series, order) : stabilityLegend),
      ],
      labels: panel.labels.map((label) => ({
        ...label,
        colour: colouring === "run" && label.run ? (order.get(label.run) ?? label.colour) : "black",
      })),
    })),
  };
}

/** What only stands in the legend. */
export function entry(title: string, style: Series["style"], colour: ColourName): Series {
  return { title, style, colour, only_in_legend: true, x: [], y: [] };
}

const stabilityLegend = [entry("stable", "line", stable), entry("unstable", "dashed", unstable)];

function namesOfRuns(series: Series[], order: Map<string, number>): Series[] {
  const runs = new Set(series.map((one) => one.run).filter((run): run is string => !!run));
  return [...runs].map((run) => entry(run, "line", order.get(run) ?? 0));
}
