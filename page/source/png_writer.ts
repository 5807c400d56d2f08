import { appearance } from "./appearance.js";
import type { ExportLayout } from "./export_layout.js";
import { svgOf } from "./svg_writer.js";

const finest = 3; // pixels for a unit of the screen, enough for a printed page
const mostPixels = 8000; // along a side: browsers have limits

/** The picture as pixels, in the colours of the page, and finer than on the screen. */
export async function pngOf(layout: ExportLayout): Promise<Blob> {
  const ratio = Math.min(finest, mostPixels / Math.max(layout.width, layout.height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.floor(layout.width * ratio);
  canvas.height = Math.floor(layout.height * ratio);
  const context = canvas.getContext("2d");
  if (!context) throw new Error("this browser draws no pictures");
  const image = new Image();
  image.src = `data:image/svg+xml,${encodeURIComponent(svgOf(layout, appearance.look))}`;
  await image.decode();
  context.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done, failed) =>
    canvas.toBlob((blob) => (blob ? done(blob) : failed(new Error("the picture is too large"))), "image/png"),
  );
}
