/** A symbol in the square from -1 to 1, as path data: lines, and an area that is filled. */
export interface Glyph {
  lines: string;
  area: string;
}

function polygon(corners: number, radius = 1, turn = 0): string {
  const points: string[] = [];
  for (let i = 0; i < corners; ++i) {
    const angle = -Math.PI / 2 + turn + (2 * Math.PI * i) / corners;
    points.push(`${(radius * Math.cos(angle)).toFixed(3)} ${(radius * Math.sin(angle)).toFixed(3)}`);
  }
  return `M${points.join("L")}Z`;
}

function star(points: number, inner: number): string {
  const corners: string[] = [];
  for (let i = 0; i < 2 * points; ++i) {
    const angle = -Math.PI / 2 + (Math.PI * i) / points,
      radius = i % 2 === 0 ? 1.15 : inner;
    corners.push(`${(radius * Math.cos(angle)).toFixed(3)} ${(radius * Math.sin(angle)).toFixed(3)}`);
  }
  return `M${corners.join("L")}Z`;
}

const round = (radius: number) =>
  `M${radius} 0A${radius} ${radius} 0 1 1 ${-radius} 0A${radius} ${radius} 0 1 1 ${radius} 0Z`;
const square = "M-.85-.85H.85V.85H-.85Z",
  plus = "M-1 0H1M0-1V1",
  cross = "M-.8-.8L.8.8M-.8.8L.8-.8";
const bar = "M-.6 0H.6",
  upright = "M0-.6V.6",
  dot = round(0.3);
const up = polygon(3, 1.1),
  down = polygon(3, 1.1, Math.PI),
  diamond = polygon(4, 1.1),
  pentagon = polygon(5, 1.05);
const hexagon = polygon(6, 1.05),
  heptagon = polygon(7, 1.05);

const open = (lines: string, area = ""): Glyph => ({ lines, area });
const filled = (area: string, lines = ""): Glyph => ({ lines: area + lines, area });

/** Gnuplot's point types, so that pictures on paper and on the page agree. */
const byNumber: Record<number, Glyph> = {
  1: open(plus),
  2: open(cross),
  3: open(plus + cross),
  4: open(square),
  5: filled(square),
  6: open(round(0.9)),
  7: filled(round(0.9)),
  8: open(up),
  9: filled(up),
  10: open(down),
  11: filled(down),
  12: open(diamond),
  13: filled(diamond),
  14: open(pentagon),
  15: filled(pentagon),
};

/** Each kind of special point has a symbol of its own; where printed pictures use one for several, details differ. */
const byType: Record<string, Glyph> = {
  SN: byNumber[7],
  PD: byNumber[9],
  NS: byNumber[13],
  BP: byNumber[5],
  SB: open(square, "M-.85-.85L.85-.85L-.85.85Z"),
  GR: byNumber[12],
  DG: open(diamond, polygon(4, 0.6)),
  DZ: byNumber[8],
  EE: byNumber[4],
  GU: byNumber[10],
  CP: byNumber[3],
  GF: byNumber[11],
  GT: open(down, polygon(3, 0.5, Math.PI)),
  R1: byNumber[6],
  R2: open(round(0.9) + bar),
  R3: open(round(0.9) + bar + upright),
  R4: open(round(0.9), dot),
  VS: byNumber[14],
  DF: open(pentagon, dot),
  DP: open(pentagon + bar),
  ZA: open(pentagon + upright),
  FP: byNumber[15],
  FT: filled(hexagon),
  PT: filled(star(5, 0.5)),
  CH: open(heptagon, dot),
  HB: open(square, dot),
  BE: open(down + upright),
  BT: open(round(0.9) + round(0.4)),
  ZH: filled(star(3, 0.45)),
  HH: filled(star(4, 0.45)),
  GH: open(down, dot),
  HC: open(round(0.9) + cross),
  HT: open(round(0.9) + upright),
  PL: filled(star(6, 0.5)),
  EX: byNumber[1],
  UZ: byNumber[2],
};

export function glyphOf(number: number | undefined, type = ""): Glyph {
  return byType[type] ?? byNumber[number ?? 7] ?? byNumber[7];
}

/** The kind of a special point that a legend or a label names: "GR: grazing", "GR1". */
export function typeIn(text: string): string {
  const letters = /^([A-Z][A-Z0-9])(?::|-?\d|$)/.exec(text);
  return letters && letters[1] in byType ? letters[1] : "";
}

export function drawGlyph(
  context: CanvasRenderingContext2D,
  glyph: Glyph,
  x: number,
  y: number,
  size: number,
  colour: string,
  ground: string,
): void {
  const lines = pathOf(glyph.lines),
    area = pathOf(glyph.area);
  context.save();
  context.translate(x, y);
  context.scale(size, size);
  context.lineWidth = 0.34;
  context.lineJoin = "round";
  // An open symbol hides the lines below it, as on paper.
  context.fillStyle = ground;
  if (glyph.lines.includes("Z")) context.fill(lines);
  context.strokeStyle = context.fillStyle = colour;
  if (glyph.area) context.fill(area);
  context.stroke(lines);
  context.restore();
}

/** A symbol as a small picture, to be drawn many times. */
export function glyphStamp(glyph: Glyph, size: number, colour: string, ground: string): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 2 * Math.ceil(1.4 * size) + 1;
  const context = canvas.getContext("2d");
  if (context) drawGlyph(context, glyph, canvas.width / 2, canvas.height / 2, size, colour, ground);
  return canvas;
}

const paths = new Map<string, Path2D>();
function pathOf(data: string): Path2D {
  let path = paths.get(data);
  if (!path) paths.set(data, (path = new Path2D(data)));
  return path;
}
