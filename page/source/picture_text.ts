import type { PictureWish } from "./contract.js";

const literal = (value: string) => JSON.stringify(value).replace(/\u007f/g, "\\u007f");
const number = (value: number) => (Number.isInteger(value) ? value.toFixed(1) : String(value));

/** A table [pictures.NAME] for a study that draws the same picture. */
export function pictureText(name: string, wish: PictureWish): string {
  const lines = [`[pictures.${/^[A-Za-z0-9_-]+$/.test(name) ? name : literal(name)}]`];
  const list = (values: string[]) => `[${values.map(literal).join(", ")}]`;
  const pair = ([low, high]: [number, number]) => `[${number(low)}, ${number(high)}]`;
  if (wish.kind) lines.push(`kind = ${literal(wish.kind)}`);
  if (wish.title) lines.push(`title = ${literal(wish.title)}`);
  if (wish.runs?.length) lines.push(`runs = ${list(wish.runs)}`);
  if (wish.over?.length) lines.push(`over = ${list(wish.over)}`);
  if (wish.x) lines.push(`x = ${literal(wish.x)}`);
  if (wish.y?.length) lines.push(`y = ${list(wish.y)}`);
  if (wish.samples?.length) lines.push(`samples = ${list(wish.samples)}`);
  if (wish.directions?.length) lines.push(`directions = ${list(wish.directions)}`);
  if (wish.points?.length) lines.push(`points = ${list(wish.points)}`);
  if (wish.logarithmic?.length) lines.push(`logarithmic = ${list(wish.logarithmic)}`);
  if (wish.x_range) lines.push(`x_range = ${pair(wish.x_range)}`);
  if (wish.y_range) lines.push(`y_range = ${pair(wish.y_range)}`);
  return lines.join("\n") + "\n";
}
