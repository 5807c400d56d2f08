import type { ColourName, Label } from "./contract.js";
import type { Frame } from "./frame.js";
import { lineDashes, type PreparedPanel } from "./prepared_panel.js";

export interface PlacedLabel {
  text: string;
  colour: ColourName;
  x: number; // left end of the text
  y: number; // middle of its height
  anchorX: number;
  anchorY: number;
  leader: { x: number; y: number } | null;
}

interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

interface Group {
  x: number;
  y: number;
  labels: Label[];
}

const mostGroups = 150; // more cannot be read anyway
const mostCells = 40000; // of lines that are marked as occupied
const cell = 6; // pixels

/** Finds places for labels: beside their points, over no other label and no symbol, and not over lines if possible. */
export function placeLabels(
  prepared: PreparedPanel,
  frame: Frame,
  fontSize: number,
  scale: number,
  width: (text: string) => number,
): PlacedLabel[] {
  const groups = groupsOf(prepared.labels, frame, 7 * scale);
  const taken: Box[] = groups.map(({ x, y }) => around(x, y, 5 * scale));
  const lines = new Occupied(prepared, frame);
  const placed: PlacedLabel[] = [];
  for (const group of groups) {
    const text = textOf(group.labels);
    const w = width(text),
      h = 1.15 * fontSize;
    let best: { box: Box; cost: number; far: boolean } | null = null;
    for (const { box, cost, far } of candidates(group.x, group.y, w, h, scale)) {
      if (best && cost >= best.cost) continue;
      if (!frame.has(box.left, box.top) || !frame.has(box.right, box.bottom)) continue;
      if (taken.some((other) => overlap(box, other))) continue;
      const total = cost + lines.within(box);
      if (!best || total < best.cost) best = { box, cost: total, far };
    }
    if (!best) continue; // it is in the list of special points beside the diagram
    taken.push(best.box);
    const { box } = best;
    const leader = best.far
      ? { x: Math.max(box.left, Math.min(group.x, box.right)), y: group.y < box.top ? box.top : box.bottom }
      : null;
    placed.push({
      text,
      colour: colourOf(group.labels),
      x: box.left,
      y: (box.top + box.bottom) / 2,
      anchorX: group.x,
      anchorY: group.y,
      leader,
    });
  }
  return placed;
}

/** Labels whose points cannot be told apart share a place. Those of lower rank come first. */
function groupsOf(labels: Label[], frame: Frame, distance: number): Group[] {
  const groups: Group[] = [];
  const visible = labels
    .map((label) => ({ label, x: frame.x(label.x ?? NaN), y: frame.y(label.y ?? NaN) }))
    .filter(({ x, y }) => frame.has(x, y))
    .sort((one, other) => one.label.rank - other.label.rank);
  for (const { label, x, y } of visible) {
    const near = groups.find((group) => Math.hypot(group.x - x, group.y - y) < distance);
    if (near) near.labels.push(label);
    else if (groups.length < mostGroups) groups.push({ x, y, labels: [label] });
  }
  return groups;
}

function textOf(labels: Label[]): string {
  const texts = [...new Set(labels.map(({ text }) => text))];
  return texts.length <= 3 ? texts.join(", ") : `${texts[0]}, ${texts[1]} + ${texts.length - 2}`;
}

function colourOf(labels: Label[]): ColourName {
  return labels.every(({ colour }) => colour === labels[0].colour) ? labels[0].colour : "black";
}

function around(x: number, y: number, half: number): Box {
  return { left: x - half, top: y - half, right: x + half, bottom: y + half };
}

function overlap(one: Box, other: Box): boolean {
  return one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;
}

function* candidates(x: number, y: number, w: number, h: number, scale: number) {
  const gap = 7 * scale;
  const at = (left: number, top: number): Box => ({ left, top, right: left + w, bottom: top + h });
  const near: Box[] = [
    at(x + gap, y - gap - 0.7 * h),
    at(x - gap - w, y - gap - 0.7 * h),
    at(x + gap, y + gap - 0.3 * h),
    at(x - gap - w, y + gap - 0.3 * h),
    at(x - w / 2, y - gap - h),
    at(x - w / 2, y + gap),
    at(x + gap + scale, y - h / 2),
    at(x - gap - scale - w, y - h / 2),
  ];
  for (let i = 0; i < near.length; ++i) yield { box: near[i], cost: 0.2 * i, far: false };
  for (const distance of [2.2 * h, 3.6 * h, 5 * h])
    for (const side of [-0.5, 0.1, -1.1])
      for (const way of [-1, 1]) {
        const top = way < 0 ? y - distance - h : y + distance;
        yield { box: at(x + side * w, top), cost: 3 + distance / h, far: true };
      }
}

/** A coarse grid of the cells through which lines pass. */
class Occupied {
  private readonly columns: number;
  private readonly rows: number;
  private readonly cells: Uint8Array;
  private marked = 0;

  constructor(
    prepared: PreparedPanel,
    private readonly frame: Frame,
  ) {
    this.columns = Math.ceil(frame.width / cell) + 1;
    this.rows = Math.ceil(frame.height / cell) + 1;
    this.cells = new Uint8Array(this.columns * this.rows);
    for (const { series, line } of prepared.drawn) {
      const { x, y } = line;
      if (!(series.style in lineDashes)) continue;
      for (let i = 1; i < x.length && this.marked < mostCells; ++i)
        this.mark(frame.x(x[i - 1]), frame.y(y[i - 1]), frame.x(x[i]), frame.y(y[i]));
    }
  }

  private mark(x0: number, y0: number, x1: number, y1: number): void {
    const { frame } = this;
    const left = frame.left,
      right = left + frame.width,
      top = frame.top,
      bottom = top + frame.height;
    if (!Number.isFinite(x0 + y0 + x1 + y1)) return;
    if (Math.max(x0, x1) < left || Math.min(x0, x1) > right) return;
    if (Math.max(y0, y1) < top || Math.min(y0, y1) > bottom) return;
    const steps = Math.min(400, 1 + Math.floor(Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0)) / cell));
    for (let i = 0; i <= steps; ++i) {
      const column = Math.floor((x0 + ((x1 - x0) * i) / steps - left) / cell);
      const row = Math.floor((y0 + ((y1 - y0) * i) / steps - top) / cell);
      if (column < 0 || row < 0 || column >= this.columns || row >= this.rows) continue;
      this.cells[row * this.columns + column] = 1;
    }
    this.marked += steps;
  }

  /** Number of occupied cells in a box, up to a limit beyond which a place is as bad as any. */
  within(box: Box): number {
    let count = 0;
    const first = Math.max(0, Math.floor((box.left - this.frame.left) / cell));
    const last = Math.min(this.columns - 1, Math.floor((box.right - this.frame.left) / cell));
    const low = Math.max(0, Math.floor((box.top - this.frame.top) / cell));
    const high = Math.min(this.rows - 1, Math.floor((box.bottom - this.frame.top) / cell));
    for (let row = low; row <= high; ++row)
      for (let column = first; column <= last; ++column) count += this.cells[row * this.columns + column];
    return Math.min(count, 6);
  }
}
