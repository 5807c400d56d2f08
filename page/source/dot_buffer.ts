import type { Frame } from "./frame.js";
import { indicesWithin, type PreparedSeries } from "./prepared_panel.js";

/** The pixels of a dot: their places from its centre, and how much of each the dot covers. */
interface Stamp {
  x: Int32Array;
  y: Int32Array;
  covers: Uint8Array; // 0 ... 255
  reach: number;
}

/**
 * Draws dots into an array of pixels, which then becomes a picture. Two hundred thousand dots take some milliseconds;
 * as paths or rectangles of the canvas they take half a second.
 */
export class DotBuffer {
  private readonly canvas = document.createElement("canvas");
  private image: ImageData | null = null;
  private pixels = new Int32Array(0); // alpha, blue, green, red; not premultiplied
  private width = 0;
  private height = 0;
  private coarse = 1;

  /** @param coarse pixels of the canvas for one of the buffer, to each side */
  begin(width: number, height: number, coarse: number): void {
    const w = Math.max(1, Math.round(width / coarse)),
      h = Math.max(1, Math.round(height / coarse));
    this.coarse = coarse;
    if (w !== this.width || h !== this.height || !this.image) {
      this.canvas.width = this.width = w;
      this.canvas.height = this.height = h;
      this.image = new ImageData(w, h);
      this.pixels = new Int32Array(this.image.data.buffer);
    } else this.pixels.fill(0);
  }

  /** @param radius in pixels of the canvas */
  add(one: PreparedSeries, frame: Frame, colour: number, radius: number, opacity: number): void {
    const { width, height, pixels, coarse } = this;
    const stamp = stampOf(radius / coarse);
    const { reach } = stamp;
    const rgb = ((colour & 255) << 16) | (colour & 0xff00) | ((colour >> 16) & 255);
    const covers = stamp.covers.map((cover) => cover * opacity);
    const values = Int32Array.from(covers, (cover) => (cover << 24) | rgb);
    const steps = stamp.y.map((y, k) => y * width + stamp.x[k]);
    const [first, last] = indicesWithin(one, frame.view.x);
    const { x, y } = one;
    for (let i = first; i < last; ++i) {
      const px = Math.round((frame.x(x[i]) - frame.left) / coarse),
        py = Math.round((frame.y(y[i]) - frame.top) / coarse);
      // Written so that NaN is left out, too.
      if (!(px >= -reach && px < width + reach && py >= -reach && py < height + reach)) continue;
      const inside = px >= reach && px < width - reach && py >= reach && py < height - reach;
      const centre = py * width + px;
      for (let k = 0; k < steps.length; ++k) {
        if (!inside) {
          const cx = px + stamp.x[k],
            cy = py + stamp.y[k];
          if (cx < 0 || cy < 0 || cx >= width || cy >= height) continue;
        }
        const at = centre + steps[k],
          old = pixels[at];
        if (old === 0) pixels[at] = values[k];
        else if ((old & 0xffffff) !== rgb) pixels[at] = blended(old, rgb, covers[k]);
        else if (covers[k] > old >>> 24) pixels[at] = values[k];
      }
    }
  }

  draw(context: CanvasRenderingContext2D, frame: Frame): void {
    if (!this.image) return;
    const own = this.canvas.getContext("2d", { willReadFrequently: true });
    own?.putImageData(this.image, 0, 0);
    const { width, height, coarse } = this;
    context.imageSmoothingEnabled = false;
    context.drawImage(this.canvas, Math.round(frame.left), Math.round(frame.top), width * coarse, height * coarse);
    context.imageSmoothingEnabled = true;
  }
}

/** A colour over a pixel that has another one already. */
function blended(old: number, rgb: number, cover: number): number {
  const rest = ((old >>> 24) * (255 - cover)) / 255,
    alpha = cover + rest;
  const mix = (shift: number) =>
    ((((rgb >> shift) & 255) * cover + ((old >> shift) & 255) * rest) / alpha + 0.5) << shift;
  return ((alpha + 0.5) << 24) | mix(16) | mix(8) | mix(0);
}

const stamps = new Map<number, Stamp>();

function stampOf(radius: number): Stamp {
  const key = Math.round(radius * 4) / 4;
  let stamp = stamps.get(key);
  if (!stamp) {
    const xs: number[] = [],
      ys: number[] = [],
      covers: number[] = [];
    const reach = Math.ceil(key);
    for (let y = -reach; y <= reach; ++y)
      for (let x = -reach; x <= reach; ++x) {
        const cover = Math.max(0, Math.min(1, key + 0.5 - Math.hypot(x, y)));
        if (cover < 0.05) continue;
        xs.push(x);
        ys.push(y);
        covers.push(Math.round(255 * cover));
      }
    stamp = { x: Int32Array.from(xs), y: Int32Array.from(ys), covers: Uint8Array.from(covers), reach };
    stamps.set(key, stamp);
  }
  return stamp;
}
