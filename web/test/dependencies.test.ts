// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import lock from "../package-lock.json";

type Version = [number, number, number];

interface Package {
  version?: string;
  engines?: { node?: string };
}
const packages: Record<string, Package> = lock.packages;

function parse(text: string): Version {
  const parts = text.split(".").map(Number);
  assert.ok(parts.length <= 3 && parts.every((part) => Number.isInteger(part)), `'${text}' is not a version`);
  return [parts[0], parts[1] ?? 0, parts[2] ?? 0];
}

/** Below zero where a is the older one. */
function compare(a: Version, b: Version): number {
  return a[0] - b[0] || a[1] - b[1] || a[2] - b[2];
}

/** One comparator of a range, e.g. ">=18.3". What this does not know is a mistake: it is to be learnt, not guessed. */
function meets(version: Version, comparator: string): boolean {
  if (["", "*", "x"].includes(comparator)) return true;
  const match = /^(>=|>|<=|<|=|\^|~|)v?(\d+(?:\.\d+){0,2})(?:\.[x*])*$/.exec(comparator);
  assert.ok(match, `'${comparator}' is not a comparator`);
  const [, operator, text] = match;
  const bound = parse(text);
  const order = compare(version, bound);
  switch (operator) {
    case ">=": return order >= 0;
    case "<": return order < 0;
    // "<=18" takes in 18.20, and ">18" does not.
    case "<=": return order <= 0 || isPart(version, text);
    case ">": return order > 0 && !isPart(version, text);
    case "^": return order >= 0 && version[0] === bound[0] && (bound[0] > 0 || version[1] === bound[1]);
    case "~": return order >= 0 && isPart(version, text.split(".").slice(0, 2).join("."));
    default: return isPart(version, text);
  }
}

/** Whether "18.20.4" is one of the versions "18.20". */
function isPart(version: Version, text: string): boolean {
  return `${version.join(".")}.`.startsWith(`${text}.`);
}

/** Whether a range of package.json's kind, e.g. "^18.18 || >=20", takes in the version. */
function admits(range: string, version: Version): boolean {
  return range.split("||").some((all) =>
    all.trim().replace(/(>=|>|<=|<|=|\^|~)\s+/g, "$1").split(/\s+/).every((comparator) => meets(version, comparator)));
}

test("ranges of versions are read as npm reads them", () => {
  const node: Version = [18, 19, 0];
  for (const range of ["", "*", ">=18", ">= 14.17", ">=14 <20", "^18.18.0 || ^20.9.0 || >=21.1.0", "18", "18.x", "~18.19", "~18",
    "<=18", ">18.18", "<18.19.1", "16 || >=18"]) {
    assert.ok(admits(range, node), range);
  }
  for (const range of [">=20", ">=18.20", "^18.20.0 || >=20", "20 || 22", "<18", ">18", "~18.18", "^16.9", ">=14 <18", ">=18.19.1"]) {
    assert.ok(!admits(range, node), range);
  }
  assert.throws(() => admits("latest", node));
});

test("every package of the page's tests runs on the Node that package.json asks for, Debian's own", () => {
  const asked = packages[""].engines!.node!;
  assert.match(asked, /^>=18\.\d+$/);
  const oldest = parse(asked.slice(2));
  const dependencies = Object.entries(packages).filter(([name]) => name !== "");
  assert.ok(dependencies.length >= 3);
  const refusing = dependencies.filter(([, { engines }]) => !admits(engines?.node ?? "*", oldest));
  assert.deepEqual(refusing.map(([name, { engines }]) => `${name}: ${engines!.node}`), []);
  // The type checker then knows nothing that this Node has not.
  assert.equal(parse(packages["node_modules/@types/node"].version!)[0], oldest[0]);
});
