import { appearance } from "./appearance.js";
import type { DrawnShape, Drawing, Motion, Pair } from "./contract.js";
import { make } from "./dom.js";
import { arcOf } from "./motion_rows.js";
import { colourText, hex } from "./palette.js";

type Number2 = [number, number];

/** All expressions of a drawing, which are asked for together with a motion. Numbers need no asking. */
export function expressionsOf(drawing: Drawing): string[] {
  const all = new Set<string>();
  const add = (value: string | number | undefined) => {
    if (typeof value === "string" && Number.isNaN(Number(value))) all.add(value);
  };
  for (const shape of drawing.shapes) {
    for (const pair of [...pointsOf(shape), ...(shape.size ? [shape.size] : [])]) pair.forEach(add);
    add(shape.radius);
  }
  return [...all];
}

function pointsOf(shape: DrawnShape): Pair[] {
  if (shape.points && shape.points.length > 0) return shape.points;
  return [shape.from, shape.to, shape.at].filter((pair): pair is Pair => pair !== undefined);
}

const colours: Record<string, number> = { blue: 0, orange: 1, green: 2, red: 12 };

/** The scene that a model declares, at one moment of a motion. */
export class ModelDrawing {
  readonly canvas: HTMLCanvasElement;
  private pixel = 1; // a unit of length on the screen, in pixels of the canvas
  private unit = 1; // of the scene
  private left = 0;
  private bottom = 0;
  private readonly drifting: { name: string; pattern: RegExp }[];
  private value: (expression: string | number | undefined) => number = Number;

  /** @param drifting states that wander off: what moves with them comes back where the scene ends */
  constructor(
    private readonly drawing: Drawing,
    drifting: string[] = [],
  ) {
    this.drifting = drifting.map((name) => ({ name, pattern: new RegExp(`\\b${name}\\b`) }));
    this.canvas = make("canvas", { class: "scene", role: "img", "aria-label": drawing.text || "drawing of the model" });
  }

  draw(motion: Motion, row: number, values: number[]): void {
    const context = this.canvas.getContext("2d");
    const { clientWidth, clientHeight } = this.canvas;
    if (!context || clientWidth === 0) return;
    this.fit(clientWidth, clientHeight);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    const places = new Map(motion.columns.map((column, index) => [column.name, index]));
    this.value = (expression) => {
      const place = typeof expression === "string" ? places.get(expression) : undefined;
      return place === undefined ? Number(expression) : values[place];
    };
    const mode = motion.modes?.[arcOf(motion, row)];
    for (const shape of this.drawing.shapes)
      if (!shape.modes || shape.modes.length === 0 || mode === undefined || shape.modes.includes(mode))
        this.drawShape(context, shape);
  }

  private fit(width: number, height: number): void {
    this.pixel = devicePixelRatio;
    const size = { width: Math.round(width * this.pixel), height: Math.round(height * this.pixel) };
    // A canvas whose size is set gets new memory, even if it is the same size.
    if (size.width !== this.canvas.width || size.height !== this.canvas.height) Object.assign(this.canvas, size);
    const { x, y } = this.drawing;
    this.unit = Math.min(this.canvas.width / (x[1] - x[0]), this.canvas.height / (y[1] - y[0]));
    this.left = this.canvas.width / 2 - (this.unit * (x[0] + x[1])) / 2;
    this.bottom = this.canvas.height / 2 + (this.unit * (y[0] + y[1])) / 2;
  }

  private place(pair: Pair): Number2 {
    const x = this.value(pair[0]) - this.returned(pair[0]);
    return [this.left + this.unit * x, this.bottom - this.unit * this.value(pair[1])];
  }

  /** How far what an expression places has to come back to be in the middle third of the scene. */
  private returned(expression: string | number): number {
    const width = (this.drawing.x[1] - this.drawing.x[0]) / 3;
    const moving = this.drifting.find(({ pattern }) => typeof expression === "string" && pattern.test(expression));
    const value = moving ? this.value(moving.name) : 0;
    return Number.isFinite(value) ? width * Math.round(value / width) : 0;
  }

  private drawShape(context: CanvasRenderingContext2D, shape: DrawnShape): void {
    const points = pointsOf(shape).map((pair) => this.place(pair));
    if (points.length === 0 || points.flat().some((value) => !Number.isFinite(value))) return;
    const look = appearance.look;
    const colour =
      shape.colour === "grey"
        ? hex(look.dark ? 0xa0a6ad : 0x808080)
        : shape.colour !== undefined && shape.colour in colours
          ? colourText(colours[shape.colour], look)
          : hex(look.ink);
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 2 * this.pixel;
    context.lineJoin = context.lineCap = "round";
    const [first] = points,
      last = points[points.length - 1];
    switch (shape.kind) {
      case "line":
      case "path":
        return strokeThrough(context, points);
      case "spring":
        return strokeThrough(context, coils(first, last, 0.12 * Math.min(this.canvas.width, this.canvas.height)));
      case "arrow":
        return drawArrow(context, first, last, 8 * this.pixel);
      case "wall":
        return drawWall(context, first, last, 8 * this.pixel);
      case "box": {
        const width = this.unit * this.value(shape.size?.[0]),
          height = this.unit * this.value(shape.size?.[1]);
        return drawBody(context, () => context.rect(first[0] - width / 2, first[1] - height / 2, width, height));
      }
      case "circle": {
        const radius = Math.max(0, this.unit * this.value(shape.radius));
        return drawBody(context, () => context.arc(first[0], first[1], radius, 0, 2 * Math.PI));
      }
      case "text":
        context.font = `${13 * this.pixel}px ${appearance.font}`;
        context.textAlign = "center";
        context.textBaseline = "middle";
        return context.fillText(shape.text ?? "", first[0], first[1]);
    }
  }
}

function strokeThrough(context: CanvasRenderingContext2D, points: Number2[]): void {
  context.beginPath();
  points.forEach(([x, y], index) => (index === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
  context.stroke();
}

function drawBody(context: CanvasRenderingContext2D, outline: () => void): void {
  context.beginPath();
  outline();
  context.globalAlpha = 0.35;
  context.fill();
  context.globalAlpha = 1;
  context.stroke();
}

function coils(from: Number2, to: Number2, width: number): Number2[] {
  const turns = 6,
    dx = to[0] - from[0],
    dy = to[1] - from[1],
    length = Math.hypot(dx, dy) || 1;
  const half = Math.min(width / 2, length / 3),
    nx = (-dy / length) * half,
    ny = (dx / length) * half;
  const points: Number2[] = [from];
  for (let i = 0; i <= 2 * turns; ++i) {
    const part = 0.1 + (0.8 * i) / (2 * turns),
      side = i === 0 || i === 2 * turns ? 0 : i % 2 === 0 ? 1 : -1;
    points.push([from[0] + part * dx + side * nx, from[1] + part * dy + side * ny]);
  }
  return [...points, to];
}

function drawArrow(context: CanvasRenderingContext2D, from: Number2, to: Number2, head: number): void {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  const size = Math.min(head, Math.hypot(to[0] - from[0], to[1] - from[1]));
  const wing = (turn: number): Number2 => [
    to[0] - size * Math.cos(angle + turn),
    to[1] - size * Math.sin(angle + turn),
  ];
  strokeThrough(context, [from, to]);
  strokeThrough(context, [wing(0.45), to, wing(-0.45)]);
}

/** A line that is hatched on its right, seen in its direction; y points down on a canvas. */
function drawWall(context: CanvasRenderingContext2D, from: Number2, to: Number2, depth: number): void {
  strokeThrough(context, [from, to]);
  const dx = to[0] - from[0],
    dy = to[1] - from[1],
    length = Math.hypot(dx, dy);
  const ux = dx / length,
    uy = dy / length,
    count = Math.floor(length / depth);
  context.save();
  context.lineWidth /= 2;
  for (let i = 1; i <= count; ++i) {
    const x = from[0] + i * depth * ux,
      y = from[1] + i * depth * uy;
    strokeThrough(context, [
      [x, y],
      [x - depth * ux - depth * uy, y - depth * uy + depth * ux],
    ]);
  }
  context.restore();
}
