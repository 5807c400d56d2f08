import type { ColourName } from "./contract.js";

/**
 * The colours of Okabe and Ito (2008), which colour-blind readers can distinguish, with brown and grey instead of yellow
 * and black; then colours of Tol's muted scheme (2021). They are those of printed pictures.
 */
const onLight = [
  0x0072b2, 0xd55e00, 0x009e73, 0xe69f00, 0xcc79a7, 0x56b4e9, 0x7f4f24, 0x606060, 0x332288, 0x882255, 0x999933,
  0x44aa99, 0xcc3311, 0xaa4499, 0x117733, 0xbbaa66,
];
/** The same hues, light enough for a dark ground. */
const onDark = [
  0x4fa8e0, 0xf28c46, 0x2fc79b, 0xf0b440, 0xe6a0c6, 0x8ad0f5, 0xc79a6c, 0xb0b0b0, 0x9a92e0, 0xdf709f, 0xc8c870,
  0x76d3c4, 0xff8570, 0xda86da, 0x5fc07c, 0xdccf98,
];

export interface Look {
  dark: boolean;
  ink: number; // of axes and of "black"
  grey: number; // of what is unphysical
  ground: number;
  grid: string;
}

export const looks: Record<"light" | "dark", Look> = {
  light: { dark: false, ink: 0x1a1d21, grey: 0xa6a6a6, ground: 0xffffff, grid: "rgba(0,0,0,0.08)" },
  dark: { dark: true, ink: 0xe8eaed, grey: 0x7c828a, ground: 0x15181c, grid: "rgba(255,255,255,0.09)" },
};

function mixed(one: number, other: number, part: number): number {
  const channel = (shift: number) =>
    Math.round(((one >> shift) & 255) * (1 - part) + ((other >> shift) & 255) * part) << shift;
  return channel(16) | channel(8) | channel(0);
}

/** Added to a colour: a tint of it, on which lines and letters can be read. */
export const pale = 2000;

/** A colour as 0xRRGGBB. Colours beyond the end of the palette are shades of its colours. */
export function colourNumber(colour: ColourName, look: Look): number {
  if (colour === "grey") return look.grey;
  if (colour === "black") return look.ink;
  if (colour >= pale) return mixed(colourNumber(colour - pale, look), look.ground, 0.6);
  const palette = look.dark ? onDark : onLight;
  const times = Math.floor(colour / palette.length) % 3;
  return mixed(palette[colour % palette.length], look.dark ? 0xffffff : 0x000000, 0.35 * times);
}

export function hex(colour: number): string {
  return `#${colour.toString(16).padStart(6, "0")}`;
}

export function colourText(colour: ColourName, look: Look): string {
  return hex(colourNumber(colour, look));
}

/** For letters, which need more contrast than lines do. */
export function letterColour(colour: ColourName, look: Look): string {
  const part = colour === "grey" || colour === "black" ? 0.25 : 0.3;
  return hex(mixed(colourNumber(colour, look), look.ink, part));
}
