import type { Num, Panel, Series } from "./contract.js";

/** Multipliers in the complex plane, with the unit circle; those outside are drawn in another colour. */
export function multiplierPanel(multipliers: [Num, Num][], halves: [Num, Num][]): Panel {
  const circle: Series = { title: "", style: "line", colour: "grey", x: [], y: [] };
  for (let i = 0; i <= 180; ++i) {
    circle.x.push(Math.cos((i * Math.PI) / 90));
    circle.y.push(Math.sin((i * Math.PI) / 90));
  }
  const axis = (label: string) => ({ label, unit: "", words: "", logarithmic: false, range: null });
  const size = ([re, im]: [Num, Num]) => Math.hypot(re ?? NaN, im ?? NaN);
  const group = (title: string, list: [Num, Num][], colour: number, symbol: number): Series => ({
    title,
    style: "symbols",
    colour,
    symbol,
    x: list.map(([re]) => re),
    y: list.map(([, im]) => im),
  });
  // Beyond this the circle would shrink to a dot: such multipliers are in the list only.
  const near = multipliers.filter((one) => size(one) < 20);
  return {
    title: "",
    x: axis("real part"),
    y: axis("imaginary part"),
    marks: [],
    marks_title: "",
    notes: [],
    labels: [],
    series: [
      circle,
      group(
        "inside",
        near.filter((one) => size(one) <= 1 + 1e-9),
        0,
        7,
      ),
      group(
        "outside",
        near.filter((one) => size(one) > 1 + 1e-9),
        12,
        7,
      ),
      group("of half the period", halves, 2, 6),
    ],
  };
}
