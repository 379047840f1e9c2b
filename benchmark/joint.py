#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges all maps of one building at once and holds the result against the truth of every pair; then once more in
other orders, which must not matter.

usage: benchmark/joint.py GRIDMERGE PAIRS.tsv PREFIX [--orders N]

PAIRS is a table as `gridmerge evaluate` takes it; of its maps those are merged whose names begin with PREFIX.
"""

import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import tempfile

from poses import Pose, compose, inverse, read_pose


def merge(gridmerge: str, folder: pathlib.Path, maps: list[str]) -> list[dict[str, Pose]]:
    """The poses of each component's members."""
    with tempfile.TemporaryDirectory() as output:
        subprocess.run(
            [gridmerge, "merge", "-o", output, "--quiet", *(str(folder / name) for name in maps)],
            stdout=subprocess.DEVNULL,
        )
        merged = json.loads((pathlib.Path(output) / "transforms.json").read_text())
    return [
        {
            pathlib.Path(member["source"]).name: read_pose(member["transform"])
            for member in component["members"]
        }
        for component in merged["components"]
    ]


def known_moments(gridmerge: str, path: pathlib.Path) -> tuple[float, float, float]:
    """The middle of a map's known area and its radius, from the map's own outline (gridmerge info --json)."""
    info = json.loads(
        subprocess.run([gridmerge, "info", "--json", path], capture_output=True, check=True).stdout
    )["maps"][0]
    origin = info["origin"]
    width, height = info["width"] * info["resolution"], info["height"] * info["resolution"]
    middle = compose((origin["x"], origin["y"], origin["theta"]), (width / 2, height / 2, 0.0))
    return middle[0], middle[1], math.hypot(width, height) / math.sqrt(12.0)


def displacement(moments: tuple[float, float, float], a: Pose, b: Pose) -> float:
    """Root mean square, as of a map that knows all of its outline: an upper bound for one that knows its middle."""
    at_a, at_b = compose(a, (*moments[:2], 0.0)), compose(b, (*moments[:2], 0.0))
    turned = 2.0 * (1.0 - math.cos(a[2] - b[2])) * moments[2] ** 2
    return math.sqrt((at_a[0] - at_b[0]) ** 2 + (at_a[1] - at_b[1]) ** 2 + turned)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gridmerge")
    parser.add_argument("pairs", type=pathlib.Path)
    parser.add_argument("prefix")
    parser.add_argument("--orders", type=int, default=1)
    arguments = parser.parse_args()
    with arguments.pairs.open(newline="") as file:
        rows = [
            row
            for row in csv.DictReader(file, delimiter="\t")
            if row["fixed"].startswith(arguments.prefix) and row["moving"].startswith(arguments.prefix)
        ]
    maps = sorted({row["fixed"] for row in rows} | {row["moving"] for row in rows})
    folder = arguments.pairs.parent
    components = merge(arguments.gridmerge, folder, maps)
    poses = max(components, key=len)
    print(f"{len(maps)} maps; components of {', '.join(str(len(component)) for component in components)}")

    errors, within = [], 0
    moments = {name: known_moments(arguments.gridmerge, folder / name) for name in maps}
    for row in rows:
        if row["fixed"] in poses and row["moving"] in poses:
            found = compose(inverse(poses[row["fixed"]]), poses[row["moving"]])
            truth = (float(row["x"]), float(row["y"]), float(row["theta"]))
            errors.append(displacement(moments[row["moving"]], found, truth))
            within += errors[-1] <= float(row["tolerance"])
    errors.sort()
    print(
        f"{within} of {len(rows)} pairs within their tolerance; "
        f"median {errors[len(errors) // 2]:.2f} m, most {errors[-1]:.2f} m"
    )

    dice, partitions, shift, turn = random.Random(3), set(), 0.0, 0.0
    for _ in range(arguments.orders):
        order = maps[:]
        dice.shuffle(order)
        other = merge(arguments.gridmerge, folder, order)
        partitions.add(tuple(sorted(tuple(sorted(component)) for component in other)))
        same = max(other, key=len)
        for name in poses.keys() & same.keys():
            first = next(iter(sorted(poses)))
            here, there = (compose(inverse(where[first]), where[name]) for where in (poses, same))
            shift = max(shift, math.hypot(here[0] - there[0], here[1] - there[1]))
            turn = max(turn, abs(math.remainder(here[2] - there[2], 2 * math.pi)))
    print(
        f"{arguments.orders} orders: {len(partitions)} partition(s), "
        f"relative poses within {shift:.1e} m and {turn:.1e} rad"
    )


if __name__ == "__main__":
    main()
