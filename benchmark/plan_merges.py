#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Merges maps with a plan of another scale, and counts those that hang on it in their place and those that must not.

usage: benchmark/plan_merges.py --gridmerge GRIDMERGE --output DIR [--data DATA] [--jobs N] [--transform KIND]

Writes DIR/plan_merges.md and DIR/plan_merges.tsv. Teams of simulated robots are merged with plans of their building and
of others. Where DATA has them, real maps of E5 and HIH are merged with both layouts, and so are sets of laser maps. A
map is right if the plan's scale is within 3 % and the map lies within 1.5 m (root mean square, of its marks or its
known cells); plans.py tells more. Maps are judged by their rigid poses, also where --transform bends them.
"""

import concurrent.futures
import dataclasses
import json
import math
import pathlib
import statistics
import subprocess
import tempfile
import time

import numpy as np
from peer_maps import read_map, transformed, write_map
from plans import (
    PAPERS,
    SCALE_TOLERANCE,
    SCALES,
    SIMULATED,
    TOLERANCE,
    Scaled,
    by_table,
    evenly,
    known_points,
    on_paper,
    parser_of,
    read_options,
    real_cases,
    simulate,
)
from poses import read_pose

OVERLAPS = (None, 0.15)  # wherever robots can go, and hardly any
ROBOTS = 4
FIRST_SEED = 700


@dataclasses.dataclass(frozen=True)
class Truth:
    """Where a map lies on its plan: between their frames, as plans.py has it."""

    plan_map: Scaled
    points: np.ndarray  # of the map [m]


@dataclasses.dataclass(frozen=True)
class Team:
    table: str
    plan: pathlib.Path
    maps: list[pathlib.Path]
    truth: dict[str, Truth]  # by map, of those that belong on the plan


@dataclasses.dataclass(frozen=True)
class Outcome:
    team: Team
    right: int
    wrong: int
    errors: list[float]  # of the maps of the plan's building that hang on it [m of the map]
    joined: int  # by the plan alone: parts that are one component now, less one
    probability: float  # of the most probable part that is wrong, or would be
    seconds: float


def simulated_teams(gridmerge: pathlib.Path, folder: pathlib.Path) -> list[Team]:
    teams, strangers = [], []
    names = list(PAPERS)
    for number, (kind, size, drift, scale) in enumerate(SIMULATED):
        for variant, overlap in enumerate(OVERLAPS):
            made = folder / f"{number}_{variant}"
            share = [] if overlap is None else ["--overlap", str(overlap)]
            seed = FIRST_SEED + len(OVERLAPS) * number + variant
            plan, truth = simulate(gridmerge, made, kind, size, drift, seed, ROBOTS, share)
            name = names[(number + variant) % len(names)]
            path = made / "plan.yaml"
            write_map(path, on_paper(plan, scale, PAPERS[name]))
            places = {
                str(made / moving): Truth(
                    Scaled((scale * x, scale * y, theta), scale), known_points(read_map(made / moving))
                )
                for moving, (x, y, theta) in truth.items()
            }
            how = "far apart" if overlap is not None else "anywhere"
            teams.append(Team(f"simulated, {how}", path, [pathlib.Path(one) for one in places], places))
    for number, team in enumerate(teams):
        other = teams[(number + len(OVERLAPS)) % len(teams)]  # of the same overlap
        strangers.append(Team("simulated, plan of another building", other.plan, team.maps, {}))
        both = team.maps + other.maps
        strangers.append(Team("simulated, two buildings at once", team.plan, both, team.truth))
    return teams + strangers


def real_teams(data: pathlib.Path, most_sets: int) -> list[Team]:
    truths: dict[pathlib.Path, dict[str, Truth]] = {}
    for case in real_cases(data, 0):
        if case.truth is not None and case.points is not None:
            truths.setdefault(case.fixed, {})[str(case.moving)] = Truth(case.truth, case.points)
    groups = [[pathlib.Path(one) for one in truth] for truth in truths.values()]
    every = [one for group in groups for one in group]
    teams = []
    for layout, truth in truths.items():
        for group in groups:
            belongs = str(group[0]) in truth
            table = f"real, {layout.name[:-12]}" if belongs else "real, layout of another building"
            teams.append(Team(table, layout, group, truth if belongs else {}))
        teams.append(Team("real, both buildings at once", layout, every, truth))
    folders = sorted(one for one in (data / "radish" / "sets").glob("*") if one.is_dir())
    for layout in truths:
        teams += [
            Team("real, laser sets", layout, sorted(folder.glob("*.yaml")), {})
            for folder in evenly(folders, most_sets)
        ]
    return teams


def error(truth: Truth, transform: Scaled) -> float:
    """How far off a map is [m of the map]."""
    apart = transform.apply(truth.points) - truth.plan_map.apply(truth.points)
    return math.sqrt(float((apart**2).sum(axis=1).mean())) / truth.plan_map.scale


def is_right(truth: Truth, transform: Scaled) -> bool:
    off = abs(transform.scale / truth.plan_map.scale - 1.0)
    return off <= SCALE_TOLERANCE and error(truth, transform) <= TOLERANCE


def merge(gridmerge: pathlib.Path, team: Team, transform: str) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "merged"
        asked = [*team.maps, "--plan", team.plan, "--plan-scale", SCALES, "--transform", transform]
        start = time.monotonic()
        done = subprocess.run(
            [gridmerge, "merge", *asked, "--threads", "1", "--quiet", "-o", output],
            capture_output=True,
            text=True,
            check=False,
        )
        seconds = time.monotonic() - start
        if done.returncode not in (0, 3):
            raise RuntimeError(f"{team.plan} and {team.maps[0]}: {done.stderr}")
        result = json.loads((output / "transforms.json").read_text())
    plan = result["plan"]
    hung = [part for part in plan["parts"] if part["reason"] is None]
    poses = {
        member["source"]: read_pose(member["transform"])
        for component in result["components"]
        if component["map"] == plan["component"]
        for member in component["members"]
    }
    if plan["component"] is None:  # one map at most
        poses = {part["maps"][0]: read_pose(part["transform"]) for part in hung}
    right, errors = 0, []
    for map_, pose in poses.items():
        # To the plan's own metres.
        x, y = transformed(pose, np.zeros((1, 2)))[0] / plan["scale"]
        answer = Scaled((float(x), float(y), pose[2]), 1.0 / plan["scale"])
        if map_ in team.truth:
            right += is_right(team.truth[map_], answer)
            errors.append(error(team.truth[map_], answer))
    wrong = [
        part["probability"] for part in plan["parts"] if not any(map_ in team.truth for map_ in part["maps"])
    ]
    return Outcome(
        team,
        right,
        len(plan["maps"]) - right,
        errors,
        max(0, len(hung) - 1),
        max(wrong, default=0.0),
        seconds,
    )


def report(outcomes: list[Outcome]) -> str:
    tables = by_table(outcomes, lambda outcome: outcome.team.table)
    lines = [
        "| merges | teams | maps of the plan's building | right on it | wrong on it | joins by the plan alone | "
        "errors [m], median and largest | most probable stranger | seconds, median |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, of_table in tables.items():
        maps = sum(map_ in one.team.truth for one in of_table for map_ in map(str, one.team.maps))
        errors = [off for one in of_table for off in one.errors]
        off = f"{statistics.median(errors):.2f}, {max(errors):.2f}" if errors else ""
        lines.append(
            f"| {name} | {len(of_table)} | {maps} | {sum(one.right for one in of_table)} | "
            f"{sum(one.wrong for one in of_table)} | {sum(one.joined for one in of_table)} | {off} | "
            f"{max(one.probability for one in of_table):.3f} | "
            f"{statistics.median(one.seconds for one in of_table):.0f} |"
        )
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = parser_of(__doc__, "sets of laser maps for each layout", "merges")
    parser.add_argument(
        "--transform",
        choices=("rigid", "similarity", "affine", "elastic"),
        default="rigid",
        help="as of gridmerge merge",
    )
    options = read_options(parser)
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        teams = real_teams(options.data, options.limit)
        teams += simulated_teams(options.gridmerge, pathlib.Path(folder))
        outcomes = []
        with (options.output / "plan_merges.tsv").open("w") as file:
            print("table", "plan", "maps", "right", "wrong", "joined", "stranger", sep="\t", file=file)
            for one in pool.map(lambda team: merge(options.gridmerge, team, options.transform), teams):
                outcomes.append(one)
                maps = f"{one.team.maps[0].parent.name}/{one.team.maps[0].name}"
                print(
                    one.team.table,
                    f"{one.team.plan.parent.name}/{one.team.plan.name}",
                    f"{maps} and {len(one.team.maps) - 1} more",
                    one.right,
                    one.wrong,
                    one.joined,
                    f"{one.probability:.4f}",
                    sep="\t",
                    file=file,
                    flush=True,
                )
    text = report(outcomes)
    (options.output / "plan_merges.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
