// SPDX-License-Identifier: Apache-2.0

/** With so many decimals, and no "-0.00". */
export function fixed(value: number, decimals: number): string {
  const text = value.toFixed(decimals);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text;
}

/** With so many decimals, and where all of them are 0 for what is not, below what they can tell. */
function deviation(value: number, decimals: number): string {
  const least = 10 ** -decimals;
  return value > 0 && value < least / 2 ? `below ${fixed(least, decimals)}` : fixed(value, decimals);
}

/** Of as many numbers as there are: as arguments of Math.max() they would have to fit the stack. -Infinity if there are none. */
export function largest(numbers: number[]): number {
  return numbers.reduce((most, number) => Math.max(most, number), -Infinity);
}

/** The same; Infinity if there are none. */
export function smallest(numbers: number[]): number {
  return numbers.reduce((least, number) => Math.min(least, number), Infinity);
}

export function degrees(radians: number): number {
  return (radians * 180) / Math.PI;
}

export function radians(inDegrees: number): number {
  return (inDegrees * Math.PI) / 180;
}

/** A probability as people read it: rounded down, so that what falls short of a bound does not look as if it reached it. */
export function probability(value: number): string {
  if (value > 0.999 && value < 1) return "> 0.999";
  if (value < 0.001 && value > 0) return "< 0.001";
  return fixed(Math.floor(1000 * value + 1e-6) / 1000, 3);
}

/** How surely a pose is known. */
export function sayDeviation({ position, theta }: { position: number; theta: number }): string {
  return `± ${deviation(position, 3)} m, ± ${deviation(degrees(theta), 2)}°`;
}

/** What a factor does to what it is applied to. */
export function sayScale(scale: number): string {
  return `${scale < 1 ? "scaled" : "enlarged"} by ${fixed(scale, 4)}`;
}

export function percent(share: number): string {
  return `${fixed(100 * share, 0)} %`;
}
