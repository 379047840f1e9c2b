#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges simulated teams of all kinds, each with two maps of other buildings among theirs, and counts what comes out:
maps placed right and wrong, strangers that were joined, and how often maps of a given probability are right.

usage: benchmark/teams.py GRIDMERGE OUTPUT [--teams N] [MERGE OPTION...]

With 120 teams about six minutes on two cores, four of which make the maps; they are kept in OUTPUT for the next run.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import subprocess

from poses import Pose, compose, inverse, read_pose

KINDS = ("office", "hall", "warehouse", "apartment", "loop", "curved", "outdoor", "symmetric")
ALIKE = ("curved", "symmetric")  # rooms of one building are alike there
STRANGERS = 2
RADIUS = 8.0  # at which an angle counts as a displacement [m]


def draw_teams(count: int) -> list[tuple[str, list[str]]]:
    dice = random.Random(5)
    teams = []
    for i in range(count):
        kind = KINDS[i % len(KINDS)]
        size = "16x12" if kind == "apartment" else f"{dice.randint(30, 70)}x{dice.randint(20, 40)}"
        teams.append(
            (
                kind,
                [
                    "--kind",
                    kind,
                    "--size",
                    size,
                    "--robots",
                    str(dice.choice([4, 6, 8])),
                    "--overlap",
                    str(dice.choice([0.2, 0.3, 0.4, 0.6])),
                    "--drift",
                    str(dice.choice([0, 0.3, 1, 2])),
                    "--others",
                    str(STRANGERS),
                    "--resolution",
                    dice.choice(["0.05", "0.1"]),
                    "--seed",
                    str(1000 + i),
                ],
            )
        )
    return teams


def make(gridmerge: str, folder: pathlib.Path, options: list[str]) -> bool:
    """Whether there is such a team: some overlaps cannot be had."""
    if (folder / "sets.tsv").exists():
        return True
    command = [gridmerge, "simulate", "-o", str(folder), "--threads", "1", "--quiet", *options]
    return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def read_truth(folder: pathlib.Path) -> dict[str, tuple[Pose, float]]:
    with (folder / "sets.tsv").open(newline="") as file:
        return {
            row["map"]: ((float(row["x"]), float(row["y"]), float(row["theta"])), float(row["tolerance"]))
            for row in csv.DictReader(file, delimiter="\t")
        }


def right_members(own: dict[str, Pose], truth: dict[str, tuple[Pose, float]]) -> set[str]:
    """Those that lie where they belong, relative to the one that makes most of them do."""
    best: set[str] = set()
    for reference, pose in own.items():
        to_truth = compose(truth[reference][0], inverse(pose))
        right = set()
        for name, placed in own.items():
            (x, y, theta), tolerance = truth[name]
            at = compose(to_truth, placed)
            off = math.hypot(at[0] - x, at[1] - y) + RADIUS * abs(math.remainder(at[2] - theta, 2 * math.pi))
            if off <= max(1.0, 1.5 * tolerance):
                right.add(name)
        best = max(best, right, key=len)
    return best


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gridmerge")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--teams", type=int, default=120)
    arguments, merge_options = parser.parse_known_args()

    teams = draw_teams(arguments.teams)
    folders = [arguments.output / str(i) for i in range(len(teams))]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        made = list(
            pool.map(
                lambda job: make(arguments.gridmerge, job[0], job[1][1]), zip(folders, teams, strict=True)
            )
        )

    counts = {
        kind: dict.fromkeys(("teams", "maps", "right", "wrong", "strangers joined"), 0) for kind in KINDS
    }
    judged = []
    for (kind, _), folder, is_made in zip(teams, folders, made, strict=True):
        if not is_made:
            continue
        truth = read_truth(folder)
        maps = [folder / name for name in truth] + [
            folder / f"elsewhere_{i + 1}.yaml" for i in range(STRANGERS)
        ]
        command = [arguments.gridmerge, "merge", "-o", folder / "merged", "--quiet", *maps, *merge_options]
        subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL)
        count = counts[kind]
        count["teams"] += 1
        count["maps"] += len(truth)
        for component in json.loads((folder / "merged" / "transforms.json").read_text())["components"]:
            members = {pathlib.Path(member["source"]).name: member for member in component["members"]}
            own = {name: read_pose(member["transform"]) for name, member in members.items() if name in truth}
            right = right_members(own, truth) if len(own) > 1 else set()
            count["right"] += len(right)
            count["wrong"] += len(own) - len(right)
            count["strangers joined"] += len(members) - len(own)
            judged += [(members[name]["probability"], name in right) for name in own]

    counts["all"] = {key: sum(count[key] for count in counts.values()) for key in counts["office"]}
    counts["all but " + " and ".join(ALIKE)] = {
        key: counts["all"][key] - sum(counts[kind][key] for kind in ALIKE) for key in counts["office"]
    }
    print("| kind | " + " | ".join(counts["office"]) + " |\n|" + " --- |" * 6)
    for kind, count in counts.items():
        print(f"| {kind} | " + " | ".join(str(value) for value in count.values()) + " |")
    print("\n| probability of a member | members | mean | right |\n| --- | --- | --- | --- |")
    for low, high in ((0.0, 0.9), (0.9, 0.95), (0.95, 0.98), (0.98, 0.99), (0.99, 0.999), (0.999, 1.01)):
        inside = [(p, is_right) for p, is_right in judged if p is not None and low <= p < high]
        if inside:
            print(
                f"| {low} to {min(high, 1.0)} | {len(inside)} | {sum(p for p, _ in inside) / len(inside):.3f} "
                f"| {sum(is_right for _, is_right in inside) / len(inside):.2f} |"
            )


if __name__ == "__main__":
    main()
