// SPDX-License-Identifier: Apache-2.0
// A merge of many maps as if it had been made: parts of one large floor, with the poses that they were cut out at.
import { existsSync, mkdirSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type SE2, compose, inverse } from "../src/se2";
import { gridmerge, program, source } from "./reports";

const resolution = 0.05;
const side = 240; // cells of a map
const stride = 120; // cells between maps
const gray = { unknown: 205, free: 254, wall: 0 };

/** Rooms with doors, unlike each other. */
function drawFloor(size: number): Uint8Array {
  const cells = new Uint8Array(size * size).fill(gray.free);
  const set = (x: number, y: number, value: number) => {
    if (x >= 0 && y >= 0 && x < size && y < size) cells[y * size + x] = value;
  };
  let seed = 1;
  const random = (most: number) => {
    seed = (seed * 48271) % 2147483647;
    return seed % most;
  };
  for (let y = 0; y < size; y += 90) {
    for (let x = 0; x < size; x += 110) {
      const doors = [10 + random(70), 10 + random(60)];
      for (let i = 0; i < 110; i++) for (const t of [0, 1]) if (i < doors[0] || i > doors[0] + 18) set(x + i, y + t, gray.wall);
      for (let i = 0; i < 90; i++) for (const t of [0, 1]) if (i < doors[1] || i > doors[1] + 18) set(x + t, y + i, gray.wall);
      const [left, top, width, height] = [x + 15 + random(50), y + 15 + random(40), 6 + random(25), 6 + random(20)];
      for (let i = 0; i < width; i++) for (let j = 0; j < height; j++) set(left + i, top + j, gray.wall);
    }
  }
  return cells;
}

/** Row 0 of `cells` is at the bottom. */
function writeMap(folder: string, name: string, cells: (x: number, y: number) => number, width: number, height: number, origin: SE2): void {
  const pixels = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) for (let x = 0; x < width; x++) pixels[(height - 1 - y) * width + x] = cells(x, y);
  writeFileSync(join(folder, `${name}.pgm`), Buffer.concat([Buffer.from(`P5\n${width} ${height}\n255\n`), pixels]));
  writeFileSync(join(folder, `${name}.yaml`),
    `image: ${name}.pgm\nresolution: ${resolution}\norigin: [${origin.x}, ${origin.y}, ${origin.theta}]\n` +
    "occupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: 0\n");
}

/**
 * A folder with so many maps in it, all but five of them placed in three merged maps, and with its report. Made once for each
 * program.
 */
export function fleet(count: number): string {
  const folder = join(source, `build/web/reports/fleet_${count}`);
  const done = join(folder, "report.html");
  if (existsSync(done) && statSync(done).mtimeMs > statSync(program).mtimeMs) return folder;
  mkdirSync(folder, { recursive: true });
  const columns = Math.ceil(Math.sqrt(count));
  const size = stride * columns + side;
  const floor = drawFloor(size);
  const names = [...Array(count).keys()].map((i) => `site/robot_${i + 1}.yaml`);
  mkdirSync(join(folder, "site"), { recursive: true });
  const poses = names.map((_, i): SE2 => ({ x: 0.1 * (i % 7), y: 0.2 * (i % 5), theta: i === 0 ? 0 : (i % 9) * 0.3 - 1.2 }));
  names.forEach((_, i) => {
    const at = { column: (i % columns) * stride, row: Math.floor(i / columns) * stride };
    // Seen from the middle: corners are unknown.
    const seen = (x: number, y: number) => Math.hypot(x - side / 2, y - side / 2) < side / 2;
    writeMap(join(folder, "site"), `robot_${i + 1}`, (x, y) => (seen(x, y) ? floor[(at.row + y) * size + at.column + x] : gray.unknown),
      side, side, compose(inverse(poses[i]), { x: at.column * resolution, y: at.row * resolution, theta: 0 }));
  });
  const leftOut = names.slice(count - 5);
  const placed = count - leftOut.length;
  const cuts = [0, placed - 50, placed - 20, placed];
  const components = [0, 1, 2].map((k) => {
    const file = k === 0 ? "merged" : `merged_${k + 1}`;
    const members = [...Array(cuts[k + 1] - cuts[k]).keys()].map((i) => cuts[k] + i);
    const frame = members[0];
    writeMap(folder, file, (x, y) => floor[y * size + x], size, size, { x: 0, y: 0, theta: 0 });
    return {
      map: `${file}.yaml`, frame: names[frame],
      members: members.map((map) => ({
        source: names[map], transform: compose(inverse(poses[frame]), poses[map]), probability: 1 - 0.0001 * (map % 90),
        sd: map === frame ? { position: 0, theta: 0 } : { position: 0.02, theta: 0.001 },
      })),
      omega: null, cells: null, omega_share: null,
    };
  });
  const groupOf = (map: number) => cuts.findIndex((cut) => map < cut);
  const joins = names.flatMap((_, fixed) => [fixed + 1, fixed + columns].flatMap((moving) => {
    if (moving >= placed || groupOf(fixed) !== groupOf(moving) || (moving === fixed + 1 && moving % columns === 0)) return [];
    const transform = compose(inverse(poses[fixed]), poses[moving]);
    const rescued = moving % 11 === 0;
    return [{
      fixed: names[fixed], moving: names[moving], transform, verdict: "accepted", probability: rescued ? 0.4 : 0.99,
      outcome: rescued ? "rescued" : "accepted", reason: null,
      by_themselves: { verdict: rescued ? "refused" : "accepted", reason: rescued ? "ambiguous" : null },
      acceptance_index: 0.97, agreement: 12000, disagreement: 300, overlap: 0.4, sd: 0.1,
      hypotheses: [{ transform, score: 200, probability: rescued ? 0.4 : 0.99 }],
    }];
  }));
  const rows = [...Array(Math.min(5000, 5 * count)).keys()].map((i) =>
    [i % (placed - 60), (i % (placed - 60)) + 50 + Math.floor(i / (placed - 60)), "ambiguous", 0.01 + 0.0001 * (i % 100), 1, 2, 0.5]);
  writeFileSync(join(folder, "transforms.json"), JSON.stringify({
    maps: names, components, joins,
    refused: {
      count: 400 * count + rows.length, reasons: { ambiguous: rows.length, too_little_overlap: 400 * count },
      columns: ["fixed", "moving", "reason", "probability", "x", "y", "theta"], rows,
    },
    left_out: leftOut, left_out_maps: leftOut.map((name) => ({ source: name, reason: "ambiguous" })),
    open_ways: [
      { fixed: names[0], moving: names[cuts[1]], transform: { x: 1, y: 2, theta: 0.5 }, probability: 0.62 },
      { fixed: names[0], moving: leftOut[0], transform: { x: -1, y: 2.5, theta: 0.1 }, probability: 0.31 },
    ],
    expected_false_joins: 0.04,
  }));
  const { status, output } = gridmerge("report", folder, "--root", folder, "--quiet");
  if (status !== 0) throw new Error(output);
  return folder;
}
