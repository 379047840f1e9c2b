// SPDX-License-Identifier: Apache-2.0

/** Red, green and blue, each 0 to 255. */
export type Rgb = readonly [number, number, number];

/** Of "#rrggbb". */
export function parseColor(hex: string): Rgb {
  const value = /^#[0-9a-f]{6}$/i.test(hex) ? parseInt(hex.slice(1), 16) : 0x888888;
  return [value >> 16, (value >> 8) & 255, value & 255];
}

/** `share` of b, the rest of a. */
export function mix(a: Rgb, b: Rgb, share: number): Rgb {
  return [0, 1, 2].map((i) => a[i] + (b[i] - a[i]) * share) as unknown as Rgb;
}

// What the drawing of maps uses beside the maps' own colours.
export const white: Rgb = [255, 255, 255];
export const ink: Rgb = [32, 32, 36];
/** Where one map says free and another occupied: vermilion, which no map's own colour is. */
export const disagreement: Rgb = [213, 94, 0];
/** Of a plan's walls: as far from every map's colour as can be, for every kind of colour vision. */
export const sepia: Rgb = [112, 48, 16];
/** How much of a map's colour is in its free space. */
export const tint = 0.2;
