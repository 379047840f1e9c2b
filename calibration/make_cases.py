#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the cases that the verdict's model is fitted to and checked on: simulated buildings, true pairs and unrelated
ones, and what the engine makes of each (gridmerge evaluate --features).

usage: calibration/make_cases.py GRIDMERGE OUTPUT [--buildings N] [--seed N] [--jobs N]

The kinds of buildings are split: the model is fitted to the kinds of `fit` and never sees those of `check`. `symmetric` is
apart: its two wings have the same walls, and maps of one wing each cannot be told from two maps of one wing. Every building
is made at random: its size, how much robots share, how far maps bend, their resolution, clutter, range and noise.
Unrelated pairs are maps of different buildings of one kind and resolution, and robots of one building that share no place.
Writes a table of features for each split. With 60 buildings a kind: about 20 minutes on two cores.
"""

import argparse
import concurrent.futures
import csv
import pathlib
import random
import subprocess
import sys

SPLITS = {"fit": ["office", "hall", "apartment", "loop"], "check": ["warehouse", "curved", "outdoor"], "symmetric": ["symmetric"]}
NEGATIVES_A_MAP = 3
FEATURES = ["lead", "acceptance_index", "wall_lines", "score", "nats_per_wall", "overlap", "common_area", "spread", "sigma",
            "outliers", "walls_met", "walls_met_locally"]
COLUMNS = ["kind", "truth", "tier"] + FEATURES


def draw_options(kind: str, dice: random.Random) -> dict[str, str]:
    """The options of one building."""
    if kind == "apartment":
        width, height = dice.uniform(10, 22), dice.uniform(8, 16)
    else:
        width, height = dice.uniform(22, 75), dice.uniform(16, 45)
    overlap = dice.choice([0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9])
    return {
        "--kind": kind, "--size": f"{width:.1f}x{height:.1f}", "--robots": "3", "--overlap": f"{overlap}",
        "--drift": f"{dice.choice([0.0, dice.uniform(0, 0.5), dice.uniform(0.5, 2.0), dice.uniform(1.0, 3.5)]):.2f}",
        "--clutter": f"{dice.uniform(0, 2):.2f}", "--resolution": dice.choice(["0.05", "0.1"]),
        "--range": f"{dice.uniform(5, 15):.1f}", "--noise": f"{dice.uniform(0.005, 0.04):.3f}",
        "--angular-step": dice.choice(["0.5", "1"]), "--seed": str(dice.randrange(1 << 32)), "--others": "0",
    }


def make_building(gridmerge: str, folder: pathlib.Path, options: dict[str, str]) -> bool:
    """Whether there is one: some overlaps cannot be had in some buildings."""
    if (folder / "pairs.tsv").exists():
        return True
    command = [gridmerge, "simulate", "-o", str(folder), "--threads", "1", "--quiet"]
    command += [word for option in options.items() for word in option]
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def read_rows(path: pathlib.Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def write_rows(path: pathlib.Path, columns: list[str], rows: list[dict[str, str]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, delimiter="\t", lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


def tables_of(folder: pathlib.Path, buildings: list[tuple[str, dict[str, str]]],
              dice: random.Random) -> tuple[list[dict[str, str]], list[dict[str, str]]]:
    """All true pairs, and the unrelated ones."""
    pairs, negatives, maps = [], [], {}
    for name, options in buildings:
        for table, rows in (("pairs.tsv", pairs), ("negatives.tsv", negatives)):
            for row in read_rows(folder / name / table):
                row["fixed"], row["moving"] = f"{name}/{row['fixed']}", f"{name}/{row['moving']}"
                rows.append(row)
        alike = maps.setdefault((options["--kind"], options["--resolution"]), [])
        alike += [(name, f"{name}/robot_{robot}.yaml") for robot in (1, 2, 3)]
    for alike in maps.values():
        for name, path in alike:
            others = [other for other in alike if other[0] != name]
            for _, other in dice.sample(others, min(NEGATIVES_A_MAP, len(others))):
                negatives.append({"fixed": path, "moving": other})
    return pairs, negatives


def compact(row: dict[str, str]) -> dict[str, str]:
    """What the fit needs of a match, in six digits."""
    return {"kind": row["fixed"].split("_")[0], "truth": row["truth"], "tier": row["tier"] or "-"} | {
        name: f"{float(row[name]):.6g}" for name in FEATURES}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("gridmerge")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--buildings", type=int, default=60, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()

    for split, kinds in SPLITS.items():
        dice = random.Random(f"{arguments.seed} {split}")
        folder = arguments.output / split
        folder.mkdir(parents=True, exist_ok=True)
        wanted = [(f"{kind}_{i}", draw_options(kind, dice)) for kind in kinds for i in range(arguments.buildings)]
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            made = list(pool.map(lambda one: make_building(arguments.gridmerge, folder / one[0], one[1]), wanted))
        buildings = [one for one, there in zip(wanted, made) if there]
        pairs, negatives = tables_of(folder, buildings, dice)
        write_rows(folder / "pairs.tsv", ["fixed", "moving", "x", "y", "theta", "tolerance", "tier", "overlap"], pairs)
        write_rows(folder / "negatives.tsv", ["fixed", "moving"], negatives)
        print(f"{split}: {len(buildings)} of {len(wanted)} buildings could be made, {len(pairs)} true pairs, "
              f"{len(negatives)} unrelated ones", flush=True)
        subprocess.run([arguments.gridmerge, "evaluate", folder / "pairs.tsv", "--negatives", folder / "negatives.tsv",
                        "--features", folder / "features.tsv", "--quiet"], check=True)
        write_rows(arguments.output / f"{split}.tsv", COLUMNS, [compact(row) for row in read_rows(folder / "features.tsv")])


if __name__ == "__main__":
    if sys.version_info < (3, 9):
        sys.exit("make_cases: needs Python 3.9 or newer")
    main()
