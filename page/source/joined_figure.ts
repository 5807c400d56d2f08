import type { Figure, FigureAnswer, PictureWish, Run } from "./contract.js";
import { drawnOver } from "./merged_figure.js";
import { Refusal } from "./source.js";
import { standsAlone, varied, type Workspace } from "./workspace.js";

/** Whether two runs can be drawn in the same axes: they vary the same. */
export function haveSameAxes(one: Run, other: Run): boolean {
  const names = (run: Run) => varied(run).sort().join();
  // An orbit is drawn as a portrait, and so would be what stands beside it.
  if (standsAlone(one) || standsAlone(other))
    return standsAlone(one) && standsAlone(other) && one.model === other.model;
  if (one.is_branch !== other.is_branch) return names(one) === names(other) && commonValues(one, other).length > 0;
  return names(one) === names(other) && (varied(one).length > 0 || one.kind === other.kind);
}

/**
 * The values of a branch that belong to a value of a sweep: the same, or else its greatest and least one along an orbit.
 * Dots of a sweep that is sampled where the value is greatest lie on that branch.
 */
function valuesFor(value: string, branches: Run[]): string[] {
  const has = (name: string) => branches.every((run) => run.values.some((one) => one.name === name));
  if (has(value)) return [value];
  return [`max_${value}`, `min_${value}`].filter(has);
}

function commonValues(one: Run, other: Run): string[] {
  const [branch, sweep] = one.is_branch ? [one, other] : [other, one];
  return sweep.values.map(({ name }) => name).filter((name) => valuesFor(name, [branch]).length > 0);
}

/** The wishes for branches and for other runs, if a picture asks for both. */
export function partsOf(
  workspace: Workspace,
  wish: PictureWish,
): { others: PictureWish; branches: PictureWish } | null {
  const runs = workspace.runsOf(wish.runs ?? []);
  const branches = runs.filter((run) => run.is_branch),
    others = runs.filter((run) => !run.is_branch);
  if (branches.length === 0 || others.length === 0) return null;
  if (wish.kind && !["branch", "bifurcation"].includes(wish.kind)) return null;
  const own = others[0].values.map(({ name }) => name),
    common = own.filter((name) => valuesFor(name, branches).length > 0);
  // An expression is drawn of both; if it is wrong, the server says why.
  const expressions = (wish.y ?? []).filter((name) => !own.includes(name));
  const chosen = wish.y?.length ? [...common.filter((name) => wish.y?.includes(name)), ...expressions] : common;
  const ofBranch = (name: string) => (expressions.includes(name) ? [name] : valuesFor(name, branches));
  const names = (list: Run[]) => list.map(({ name }) => name);
  const { x, x_range, y_range, logarithmic, samples, directions } = wish;
  const axes = { x, x_range, y_range, logarithmic };
  return {
    others: { ...axes, samples, directions, runs: names(others), y: chosen },
    branches: { ...axes, runs: names(branches), y: chosen.flatMap(ofBranch) },
  };
}

/** What is drawn for a wish. The server draws branches and other runs apart: here branches are drawn over the others. */
export async function figureOf(workspace: Workspace, wish: PictureWish, signal: AbortSignal): Promise<FigureAnswer> {
  const { source } = workspace;
  const parts = source.workshop ? partsOf(workspace, wish) : null;
  if (!parts) return source.figure(wish, signal);
  const names = (list: string[] | undefined) => (list ?? []).join(", ");
  if (!parts.others.y?.length)
    throw new Refusal(
      `${names(parts.branches.runs)} and ${names(parts.others.runs)} have no value in common`,
      "let the branch record the greatest ones (max_NAME) of the values of the other run",
      400,
    );
  const [others, branches] = await Promise.all([
    source.figure(parts.others, signal),
    source.figure(parts.branches, signal),
  ]);
  const belongs = (value: string, ofBranch: string) => [value, `max_${value}`, `min_${value}`].includes(ofBranch);
  const figure: Figure | null = drawnOver(others.figure, branches.figure, names(parts.branches.runs), belongs);
  if (!figure) throw new Refusal("the pictures of these runs have no axes in common", "make a picture of each", 400);
  return { figure, table: others.table };
}
