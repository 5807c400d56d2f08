import type { Axis, Panel } from "./contract.js";
import { append, fill, make } from "./dom.js";
import type { Hit } from "./nearest.js";
import { symbolOf, withUnit } from "./numbers.js";

/** What is known of the point under the pointer. */
export class Tooltip {
  private readonly element = make("div", { class: "tooltip", "aria-hidden": "true" });

  show(
    over: HTMLElement,
    hit: Hit | null,
    panel: Panel,
    x: number,
    y: number,
    typeOf?: (run: string | null | undefined, number: number | null | undefined) => string,
  ): void {
    if (!hit) {
      this.element.remove();
      return;
    }
    const heading = [hit.run ?? hit.one.series.title, hit.number === null ? "" : `point ${hit.number}`];
    fill(this.element, make("b", {}, heading.filter((text) => text).join(", ")));
    const type = typeOf?.(hit.run, hit.number) ?? "";
    const label = hit.label?.text ?? "";
    if (label || type)
      append(this.element, make("div", {}, type && !label.startsWith(type) ? `${label} (${type})` : label));
    const line = (axis: Axis, value: number) =>
      make("div", {}, `${symbolOf(axis.label || axis.words)} = ${withUnit(value, axis.unit, 8)}`);
    append(this.element, line(panel.x, hit.x), line(panel.y, hit.y));
    if (this.element.parentElement !== over) over.append(this.element);
    // Beside the pointer, on the side where there is room.
    const { offsetWidth: width, offsetHeight: height, style } = this.element;
    const right = x + width + 18 > over.clientWidth;
    const low = y + height + 14 > over.clientHeight;
    style.left = `${right ? Math.max(0, x - width - 12) : x + 14}px`;
    style.top = `${low ? Math.max(0, y - height - 8) : y + 12}px`;
  }
}
