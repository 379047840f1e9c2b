#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges the maps of a simulated campus: many buildings, several robots in each, all maps shuffled.

usage: benchmark/fleet.py GRIDMERGE OUTPUT [--maps N,N,...] [--campus fitted|reported] [--twin N] [MERGE OPTION...]

Prints, for each number of maps: time of processor cores, memory, the share of pairs that was matched, and how many
joins are right, wrong and lost. Up to `--twin` maps, the same maps are also merged with all pairs. A join is lost if
two maps of one building lie together there, right, and not here. The maps stay in OUTPUT for the next run.

The two campuses have other kinds of buildings and other seeds. Whatever is fitted to maps is fitted to the first one.
"""

import argparse
import concurrent.futures
import csv
import dataclasses
import json
import math
import os
import pathlib
import random
import shutil
import subprocess
import sys

from poses import Pose, compose, inverse, read_pose

# Kinds of buildings and their sizes in metres. Few sizes, so that some buildings look alike.
CAMPUSES = {
    "fitted": (
        ("office", ("44x30", "52x36")),
        ("warehouse", ("40x28",)),
        ("curved", ("46x30",)),
        ("bare", ("40x28",)),
        ("office", ("36x26",)),
        ("corridor", ("50x24",)),
        ("arena", ("36x30",)),
    ),
    "reported": (
        ("hall", ("40x30", "48x34")),
        ("apartment", ("24x18",)),
        ("loop", ("46x34",)),
        ("outdoor", ("40x32",)),
        ("symmetric", ("44x30",)),
        ("maze", ("30x24",)),
        ("hall", ("40x30",)),
    ),
}
SEEDS = {"fitted": 40_000, "reported": 70_000}
RADIUS = 8.0  # at which an angle counts as a displacement [m]


@dataclasses.dataclass(frozen=True)
class Truth:
    building: str
    pose: Pose  # in the frame of its building
    tolerance: float  # [m]


Pair = tuple[str, str]  # ascending


def options_of(campus: str, number: int) -> list[str]:
    """What `gridmerge simulate` is told of a building: robots, sensors and bending differ."""
    dice = random.Random(SEEDS[campus] + number)
    kinds = CAMPUSES[campus]
    kind, sizes = kinds[number % len(kinds)]
    return [
        "--kind",
        kind,
        "--size",
        dice.choice(sizes),
        "--robots",
        str(dice.randint(3, 8)),
        "--overlap",
        str(dice.choice((0.3, 0.5, 0.7))),
        "--drift",
        str(dice.choice((0, 0.2, 0.4))),
        "--clutter",
        str(dice.choice((0.5, 1))),
        "--range",
        str(dice.choice((8, 12))),
        "--others",
        "0",
        "--resolution",
        dice.choice(("0.1", "0.1", "0.08")),
        "--seed",
        str(SEEDS[campus] + number),
    ]


def make_building(gridmerge: str, campus: str, number: int, folder: pathlib.Path) -> list[str]:
    """The names of its maps; none where the wanted overlap cannot be had."""
    done = folder / "done"
    if not done.exists():
        shutil.rmtree(folder, ignore_errors=True)
        subprocess.run(
            [
                gridmerge,
                "simulate",
                "-o",
                str(folder),
                "--threads",
                "1",
                "--quiet",
                *options_of(campus, number),
            ],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        folder.mkdir(parents=True, exist_ok=True)
        done.touch()
    if not (folder / "sets.tsv").exists():
        return []
    with (folder / "sets.tsv").open(newline="") as file:
        return [row["map"] for row in csv.DictReader(file, delimiter="\t")]


def make_campus(gridmerge: str, campus: str, count: int, output: pathlib.Path) -> pathlib.Path:
    """A folder with so many maps, map_0001.yaml and so on in a random order, and their truth."""
    folder = output / f"{campus}_{count}"
    if (folder / "pairs.tsv").exists():
        return folder
    buildings: list[tuple[pathlib.Path, list[str]]] = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        number = 0
        while sum(len(maps) for _, maps in buildings) < count:
            folders = [output / campus / f"building_{i}" for i in range(number, number + 8)]
            made = pool.map(lambda job: make_building(gridmerge, campus, *job), enumerate(folders, number))
            buildings += zip(folders, made, strict=True)
            number += 8
    maps = [(home, name) for home, names in buildings for name in names][:count]
    random.Random(count).shuffle(maps)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    renamed = {origin: f"map_{i + 1:04}.yaml" for i, origin in enumerate(maps)}
    rows: dict[pathlib.Path, dict[str, dict[str, str]]] = {}
    for home, _ in buildings:
        if (home / "sets.tsv").exists():
            with (home / "sets.tsv").open(newline="") as file:
                rows[home] = {row["map"]: row for row in csv.DictReader(file, delimiter="\t")}
    with (folder / "sets.tsv").open("w") as sets:
        sets.write("set\tmap\tx\ty\ttheta\ttolerance\n")
        for (home, name), new in renamed.items():
            old = home / name
            image = pathlib.Path(new).with_suffix(".pgm").name
            shutil.copyfile(old.with_suffix(".pgm"), folder / image)
            text = old.read_text().replace(old.with_suffix(".pgm").name, image)
            (folder / new).write_text(text)
            row = rows[home][name]
            sets.write("\t".join([home.name, new, row["x"], row["y"], row["theta"], row["tolerance"]]) + "\n")
    lines = []
    for home in rows:
        with (home / "pairs.tsv").open(newline="") as file:
            for row in csv.DictReader(file, delimiter="\t"):
                if (home, row["fixed"]) in renamed and (home, row["moving"]) in renamed:
                    lines.append(
                        [
                            renamed[home, row["fixed"]],
                            renamed[home, row["moving"]],
                            *(row[key] for key in ("x", "y", "theta", "tolerance", "tier", "overlap")),
                        ]
                    )
    head = ["fixed", "moving", "x", "y", "theta", "tolerance", "tier", "overlap"]
    (folder / "pairs.tsv").write_text("".join("\t".join(line) + "\n" for line in [head, *lines]))
    return folder


def read_truth(folder: pathlib.Path) -> dict[str, Truth]:
    with (folder / "sets.tsv").open(newline="") as file:
        return {
            row["map"]: Truth(
                row["set"], (float(row["x"]), float(row["y"]), float(row["theta"])), float(row["tolerance"])
            )
            for row in csv.DictReader(file, delimiter="\t")
        }


@dataclasses.dataclass
class Outcome:
    seconds: float  # of processor cores
    megabytes: float
    looked_at: int
    components: list[dict[str, Pose]]


def merge(
    gridmerge: str, folder: pathlib.Path, output: pathlib.Path, names: list[str], options: list[str]
) -> Outcome:
    command = [
        gridmerge,
        "merge",
        "-o",
        str(output),
        "--quiet",
        *(str(folder / name) for name in names),
        *options,
    ]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = usage.ru_utime + usage.ru_stime
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 3):
        sys.exit(f"gridmerge merge ended with exit code {process.returncode}")
    merged = json.loads((output / "transforms.json").read_text())
    components = [
        {pathlib.Path(member["source"]).name: read_pose(member["transform"]) for member in one["members"]}
        for one in merged["components"]
    ]
    looked_at = len(merged["joins"]) + merged.get("refused", {}).get("count", 0)
    return Outcome(seconds, usage.ru_maxrss / 1024, looked_at, components)


def is_right(a: str, b: str, own: dict[str, Pose], truth: dict[str, Truth]) -> bool:
    """Whether two maps of a component lie to each other as they should."""
    if truth[a].building != truth[b].building:
        return False
    x, y, theta = compose(inverse(own[a]), own[b])
    at = compose(inverse(truth[a].pose), truth[b].pose)
    off = math.hypot(at[0] - x, at[1] - y) + RADIUS * abs(math.remainder(at[2] - theta, 2 * math.pi))
    return off <= max(1.0, 1.5 * max(truth[a].tolerance, truth[b].tolerance))


@dataclasses.dataclass
class Judged:
    right: set[Pair]  # pairs of maps that lie together and belong so
    wrong: set[Pair]
    placed: int  # maps that lie right with most of their component
    misplaced: int


def judge(outcome: Outcome, truth: dict[str, Truth]) -> Judged:
    judged = Judged(set(), set(), 0, 0)
    for own in outcome.components:
        names = sorted(own)
        best = 0
        for a in names:
            together = [b for b in names if b != a and is_right(a, b, own, truth)]
            best = max(best, len(together) + 1 if together else 0)
            for b in names:
                if a < b:
                    (judged.right if b in together else judged.wrong).add((a, b))
        judged.placed += best
        judged.misplaced += len(names) - best
    return judged


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gridmerge")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--maps", default="100,300,1000", help="how many; several with commas")
    parser.add_argument("--campus", choices=CAMPUSES, default="reported")
    parser.add_argument("--twin", type=int, default=100, help="up to so many maps, match all pairs too")
    parser.add_argument("--max-missed", type=float, default=0.25, help="as of gridmerge merge")
    parser.add_argument("--make-only", action="store_true", help="make the maps, merge nothing")
    arguments, options = parser.parse_known_args()

    columns = (
        "maps",
        "core seconds",
        "MB",
        "pairs",
        "matched",
        "placed right",
        "wrong",
        "joins right",
        "joins wrong",
        "joins lost",
    )
    print("| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    for count in map(int, arguments.maps.split(",")):
        folder = make_campus(arguments.gridmerge, arguments.campus, count, arguments.output)
        if arguments.make_only:
            continue
        truth = read_truth(folder)
        twin: Judged | None = None
        chosen = ("", [*options, "--max-missed", str(arguments.max_missed)])
        every = (" (all pairs)", [*options, "--max-missed", "0"])
        runs = [every, chosen] if count <= arguments.twin else [chosen]
        for label, some in runs:
            output = arguments.output / f"merged_{arguments.campus}_{count}{'_all' if label else ''}"
            outcome = merge(arguments.gridmerge, folder, output, sorted(truth), some)
            judged = judge(outcome, truth)
            pairs = count * (count - 1) // 2
            lost = "" if twin is None else str(len(twin.right - judged.right))
            print(
                f"| {count}{label} | {outcome.seconds:.1f} | {outcome.megabytes:.0f} | {pairs} | "
                f"{outcome.looked_at} ({100 * outcome.looked_at / pairs:.1f} %) | "
                f"{judged.placed} | {judged.misplaced} | {len(judged.right)} | {len(judged.wrong)} | {lost} |",
                flush=True,
            )
            if label:
                twin = judged


if __name__ == "__main__":
    main()
