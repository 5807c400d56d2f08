import uPlot from "uplot";
import { axisTitle } from "./axis_text.js";
import type { Panel } from "./contract.js";
import { bindInput, moved } from "./diagram_input.js";
import { make } from "./dom.js";
import { DotBuffer } from "./dot_buffer.js";
import { Frame, sameView, type View } from "./frame.js";
import { hitAt, nearestPoint, placeOf, type Hit } from "./nearest.js";
import { drawPanel, type DrawingStyle } from "./panel_drawing.js";
import { PreparedPanel } from "./prepared_panel.js";
import { appearance } from "./appearance.js";
import { ticksOf } from "./ticks.js";
import { Tooltip } from "./tooltip.js";

export interface DiagramOptions {
  name: string; // for those who do not see it
  equalAspect?: boolean;
  typeOf?: DrawingStyle["typeOf"];
  pick?: (hit: Hit) => void; // a click on a drawn point
  step?: (key: string) => boolean; // arrow keys; true if they meant something
  enter?: () => boolean; // to what can be done with the chosen point; true if there is one
  viewed?: (view: View) => void; // the user zoomed or moved
}

export interface Marker {
  x: number;
  y: number;
  kind: "selected" | "moving" | "near";
}

function wantedTicks(length: number, vertical: boolean): number {
  return Math.max(vertical ? 3 : 2, Math.min(10, length / ((vertical ? 50 : 75) * appearance.size)));
}

/** One panel with two axes: uPlot draws axes and grid and knows the pointer; the data are drawn by `drawPanel`. */
export class Diagram {
  readonly root: HTMLElement;
  private plot: uPlot | null = null;
  private prepared: PreparedPanel;
  private view: View;
  private whole: View;
  private readonly dots = new DotBuffer();
  private readonly tooltip = new Tooltip();
  private readonly markers = new Map<Marker["kind"], { marker: Marker; element: HTMLElement }>();
  private readonly observer: ResizeObserver;
  private readonly forget: () => void;
  private awaited = 0;
  private releaseInput: () => void = () => undefined;

  constructor(
    panel: Panel,
    readonly options: DiagramOptions,
    [x, y] = [panel.x.logarithmic, panel.y.logarithmic],
  ) {
    this.prepared = new PreparedPanel(panel, x, y);
    this.view = this.whole = this.prepared.wholeView();
    this.root = make("div", {
      class: "diagram",
      tabindex: 0,
      role: "application",
      "aria-roledescription": "diagram",
      "aria-label": options.name,
    });
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.root);
    this.forget = appearance.onChange(() => this.build());
  }

  get panel(): Panel {
    return this.prepared.panel;
  }
  get logarithmic(): [boolean, boolean] {
    return [this.prepared.logarithmicX, this.prepared.logarithmicY];
  }
  get data(): PreparedPanel {
    return this.prepared;
  }
  get currentView(): View {
    return this.view;
  }
  get showsAll(): boolean {
    return sameView(this.view, this.whole);
  }
  get canvas(): HTMLCanvasElement | null {
    return this.plot?.ctx.canvas ?? null;
  }

  /**
   * Shows other data. The view stays, unless everything was shown: then it shows everything again.
   * @param sameQuantities whether the axes mean the same even if their titles differ
   */
  setPanel(panel: Panel, logarithmic?: [boolean, boolean], sameQuantities = false): void {
    const [x, y] = logarithmic ?? [panel.x.logarithmic, panel.y.logarithmic];
    const before = this.prepared,
      followed = this.showsAll;
    this.prepared = new PreparedPanel(panel, x, y);
    const sameAxes =
      x === before.logarithmicX &&
      y === before.logarithmicY &&
      axisTitle(panel.x) === axisTitle(before.panel.x) &&
      axisTitle(panel.y) === axisTitle(before.panel.y);
    this.whole = this.wholeView();
    if (followed || !(sameAxes || sameQuantities)) this.view = this.whole;
    if (sameAxes && this.plot) this.redraw();
    else this.build();
  }

  setName(name: string): void {
    this.root.setAttribute("aria-label", name);
  }

  setView(view: View, byUser = false): void {
    const valid = (low: number, high: number, logarithmic: boolean) => high > low && (!logarithmic || low > 0);
    if (!valid(view.x.low, view.x.high, this.prepared.logarithmicX)) return;
    if (!valid(view.y.low, view.y.high, this.prepared.logarithmicY)) return;
    this.view = view;
    this.redraw();
    if (byUser) this.options.viewed?.(view);
  }

  showAll(byUser = false): void {
    this.setView(this.whole, byUser);
  }

  /** Moves the view if this point lies outside. */
  reveal(at: { x: number; y: number }): void {
    const place = this.screenPlace(at);
    if (!place || !this.plot) return;
    const { clientWidth, clientHeight } = this.plot.over;
    if (place.x >= 0 && place.y >= 0 && place.x <= clientWidth && place.y <= clientHeight) return;
    this.setView(moved(this, place.x / clientWidth - 0.5, 0.5 - place.y / clientHeight), true);
  }

  mark(kind: Marker["kind"], at: { x: number; y: number } | null): void {
    const known = this.markers.get(kind);
    if (!at) {
      known?.element.remove();
      this.markers.delete(kind);
      return;
    }
    const element = known?.element ?? make("div", { class: `marker ${kind}` });
    this.markers.set(kind, { marker: { ...at, kind }, element });
    this.placeMarker(kind);
  }

  markPoint(run: string | null, number: number | null): Hit | null {
    const hit = run === null || number === null ? null : placeOf(this.prepared, run, number);
    this.mark("selected", hit);
    return hit;
  }

  /** The part of the canvas in which data are drawn, in pixels of the canvas. */
  frame(): Frame | null {
    if (!this.plot) return null;
    const { left, top, width, height } = this.plot.bbox;
    return new Frame(left, top, width, height, this.view, this.prepared.logarithmicX, this.prepared.logarithmicY);
  }

  /** The drawn point near a place in the frame, in pixels of the screen. */
  hitAt(x: number, y: number, reach = 14): Hit | null {
    const frame = this.frame();
    if (!frame) return null;
    const ratio = uPlot.pxRatio;
    return nearestPoint(this.prepared, frame, frame.left + x * ratio, frame.top + y * ratio, reach * ratio);
  }

  showHit(hit: Hit | null, x = 0, y = 0): void {
    this.mark("near", hit && hit.one.series.style !== "cells" ? hit : null);
    if (this.plot) this.tooltip.show(this.plot.over, hit, this.panel, x, y, this.options.typeOf);
  }

  /** Centre of a drawn point in the frame, in pixels of the screen. */
  screenPlace(at: { x: number; y: number }): { x: number; y: number } | null {
    const frame = this.frame();
    if (!frame) return null;
    const ratio = uPlot.pxRatio;
    return { x: (frame.x(at.x) - frame.left) / ratio, y: (frame.y(at.y) - frame.top) / ratio };
  }

  /** Any drawn point with a number, to begin with when the keyboard is used. */
  firstPoint(): Hit | null {
    const one = this.prepared.drawn.find(({ series }) => series.run && series.numbers && series.numbers.length > 0);
    return one ? hitAt(this.prepared, one, 0) : null;
  }

  destroy(): void {
    cancelAnimationFrame(this.awaited);
    this.observer.disconnect();
    this.forget();
    this.releaseInput();
    this.plot?.destroy();
    this.root.remove();
  }

  style(): DrawingStyle {
    const scale = uPlot.pxRatio * appearance.size;
    const fontSize = 12 * scale;
    return {
      look: appearance.look,
      scale,
      fontSize,
      font: `${fontSize}px ${appearance.font}`,
      typeOf: this.options.typeOf ?? (() => ""),
    };
  }

  redraw(): void {
    if (this.awaited) return;
    this.awaited = requestAnimationFrame(() => {
      this.awaited = 0;
      this.applyView();
    });
  }

  private wholeView(): View {
    const whole = this.prepared.wholeView();
    if (!this.options.equalAspect || !this.plot) return whole;
    const { width, height } = this.plot.bbox;
    const spanX = whole.x.high - whole.x.low,
      spanY = whole.y.high - whole.y.low;
    const unit = Math.max(spanX / width, spanY / height);
    const around = (low: number, high: number, span: number) => ({
      low: (low + high - span) / 2,
      high: (low + high + span) / 2,
    });
    return { x: around(whole.x.low, whole.x.high, unit * width), y: around(whole.y.low, whole.y.high, unit * height) };
  }

  private applyView(): void {
    const { plot, view } = this;
    if (!plot) return;
    this.root.dataset.view = [view.x.low, view.x.high, view.y.low, view.y.high].join(" "); // for tests
    plot.batch(() => {
      plot.setScale("x", { min: view.x.low, max: view.x.high });
      plot.setScale("y", { min: view.y.low, max: view.y.high });
    });
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    if (width < 40 || height < 40) return;
    if (!this.plot || this.titles().join() !== this.plot.axes.map(({ label }) => label).join()) this.build();
    else if (this.plot.width !== width || this.plot.height !== height) this.plot.setSize({ width, height });
    if (!this.options.equalAspect) return;
    const followed = this.showsAll;
    this.whole = this.wholeView();
    if (followed) this.setView(this.whole);
  }

  private build(): void {
    const { clientWidth: width, clientHeight: height } = this.root;
    this.releaseInput();
    this.plot?.destroy();
    this.plot = null;
    if (width < 40 || height < 40) return;
    const { view } = this;
    // uPlot gets the corners of the view as data: what is drawn, and where, is decided here.
    const data: uPlot.AlignedData = [
      [view.x.low, view.x.high],
      [view.y.low, view.y.high],
    ];
    this.plot = new uPlot(this.plotOptions(width, height), data, this.root);
    this.releaseInput = bindInput(this, this.plot.over);
    for (const kind of this.markers.keys()) this.placeMarker(kind);
    if (this.options.equalAspect) {
      const followed = this.showsAll;
      this.whole = this.wholeView();
      if (followed) this.view = this.whole;
    }
    this.applyView();
  }

  private plotOptions(width: number, height: number): uPlot.Options {
    const { prepared, view } = this;
    const scale = (logarithmic: boolean, low: number, high: number): uPlot.Scale => ({
      time: false,
      auto: false,
      distr: logarithmic ? 3 : 1,
      min: low,
      max: high,
    });
    return {
      width,
      height,
      pxAlign: 0,
      legend: { show: false },
      scales: {
        x: scale(prepared.logarithmicX, view.x.low, view.x.high),
        y: scale(prepared.logarithmicY, view.y.low, view.y.high),
      },
      series: [{}, { paths: () => null, points: { show: false } }],
      axes: [this.axis(0), this.axis(1)],
      cursor: {
        points: { show: false },
        drag: { x: true, y: true, uni: 20, dist: 4, setScale: false },
        bind: {
          // Panning has the other buttons; a double click shows all.
          mousedown: (_, __, handler) => (event) => {
            if (event.button === 0 && !event.shiftKey && !this.root.dataset.panning) handler(event);
            return null;
          },
          dblclick: () => () => null,
        },
      },
      hooks: { draw: [() => this.draw()], setSelect: [(plot) => this.zoomToSelection(plot)] },
    };
  }

  /** The titles of the axes for which there is room. */
  private titles(): [string, string] {
    const { panel } = this.prepared,
      letter = 0.58 * 12 * appearance.size;
    const { clientWidth, clientHeight } = this.root;
    return [axisTitle(panel.x, (clientWidth - 80) / letter), axisTitle(panel.y, (clientHeight - 60) / letter)];
  }

  private axis(index: 0 | 1): uPlot.Axis {
    const vertical = index === 1,
      logarithmic = vertical ? this.prepared.logarithmicY : this.prepared.logarithmicX;
    const letters = 12 * appearance.size;
    const ticks = (plot: uPlot) => {
      const { min, max } = plot.scales[vertical ? "y" : "x"];
      const length = (vertical ? plot.bbox.height : plot.bbox.width) / uPlot.pxRatio;
      return ticksOf(min ?? 0, max ?? 1, logarithmic, wantedTicks(length, vertical));
    };
    const widest = (texts: string[] | null) => Math.max(2, ...(texts ?? []).map((text) => text.length));
    return {
      label: this.titles()[index],
      labelFont: `${letters}px ${appearance.font}`,
      font: `${letters}px ${appearance.font}`,
      labelSize: 1.6 * letters,
      labelGap: 2,
      size: (_, texts) => (vertical ? 12 + 0.6 * letters * widest(texts) : 8 + 1.5 * letters),
      stroke: () => appearance.ink,
      grid: { stroke: () => appearance.look.grid, width: 1 },
      ticks: { stroke: () => appearance.ink, width: 1, size: 5 },
      border: { show: true, stroke: () => appearance.ink, width: 1 },
      splits: (plot) => ticks(plot).values,
      values: (plot) => ticks(plot).texts,
      filter: (_, values) => values,
    };
  }

  private zoomToSelection(plot: uPlot): void {
    const { left, top, width, height } = plot.select;
    if (width < 4 && height < 4) return;
    const range = (key: "x" | "y", one: number, other: number) => {
      const a = plot.posToVal(one, key),
        b = plot.posToVal(other, key);
      return { low: Math.min(a, b), high: Math.max(a, b) };
    };
    const view = { x: range("x", left, left + width), y: range("y", top, top + height) };
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.setView(view, true);
  }

  private draw(): void {
    const frame = this.frame();
    if (!frame || !this.plot) return;
    drawPanel(this.plot.ctx, this.prepared, frame, this.style(), this.dots);
    for (const kind of this.markers.keys()) this.placeMarker(kind);
  }

  private placeMarker(kind: Marker["kind"]): void {
    const known = this.markers.get(kind);
    if (!known || !this.plot) return;
    if (known.element.parentElement !== this.plot.over) this.plot.over.append(known.element);
    const { x, y } = known.marker;
    const frame = this.frame(),
      place = this.screenPlace(known.marker);
    const visible = place && frame?.has(frame.x(x), frame.y(y), uPlot.pxRatio); // a pixel of the screen beyond
    known.element.hidden = !visible;
    if (visible) known.element.style.transform = `translate(${place.x}px, ${place.y}px)`;
  }
}
