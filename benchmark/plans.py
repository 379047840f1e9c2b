#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lays maps on plans of another scale, and counts those that find their place and unrelated ones that must not.

usage: benchmark/plans.py --gridmerge GRIDMERGE --output DIR [--data DATA] [--limit N] [--jobs N]

Writes DIR/plans.md and DIR/plans.tsv. Plans of simulated buildings are drawn at scales of their own: as maps, as
lines and on white paper. Where DATA has them, real maps of E5 and HIH are laid on their architects' layouts, with
marks as the truth, and on each other's. N unrelated pairs at most, 200 if not given, and half as many simulated ones.
A map is right if its scale is within 3 % and it lies within 1.5 m (root mean square, of its marks or its known cells).
"""

import argparse
import collections
import concurrent.futures
import csv
import dataclasses
import json
import math
import os
import pathlib
import statistics
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from peer_maps import FREE, OCCUPIED, UNKNOWN, Map, read_map, transformed, write_map
from poses import Pose, read_pose

One = TypeVar("One")

SCALES = "0.5:2"
SCALE_TOLERANCE = 0.03
TOLERANCE = 1.5  # [m]
LARGEST_THING = 2.5  # [m]: a plan shows no furniture
MARK_TOLERANCE = 0.2  # [m]: marks fit no better than this
SIMULATED = [  # kind, size, drift and the plan's scale
    ("office", "45x25", 0.5, 0.7),
    ("office", "50x30", 1.0, 1.3),
    ("hall", "35x25", 1.0, 0.8),
    ("hall", "40x30", 2.0, 1.2),
    ("apartment", "18x12", 0.5, 1.5),
    ("apartment", "20x14", 1.0, 0.6),
    ("loop", "40x25", 1.0, 1.1),
    ("loop", "35x30", 0.5, 0.9),
    ("curved", "40x25", 1.0, 1.25),
    ("curved", "35x25", 0.5, 0.75),
]
SEED = 500
PAPERS = {"a map": None, "lines": UNKNOWN, "white paper": FREE}


@dataclasses.dataclass(frozen=True)
class Scaled:
    """p_fixed = scale * R(theta) * p_moving + (x, y)."""

    pose: Pose
    scale: float

    def apply(self, points: np.ndarray) -> np.ndarray:
        return transformed(self.pose, self.scale * points)


@dataclasses.dataclass(frozen=True)
class Case:
    table: str
    fixed: pathlib.Path
    moving: pathlib.Path
    truth: Scaled | None = None  # none of an unrelated pair
    points: np.ndarray | None = None  # of the moving map [m]


@dataclasses.dataclass(frozen=True)
class Outcome:
    case: Case
    accepted: bool
    probability: float
    answer: Scaled
    seconds: float

    @property
    def error(self) -> float:
        """Of the position [m of the fixed map]."""
        if self.case.truth is None or self.case.points is None:
            return math.inf
        apart = self.answer.apply(self.case.points) - self.case.truth.apply(self.case.points)
        return math.sqrt(float((apart**2).sum(axis=1).mean()))

    @property
    def right(self) -> bool:
        if self.case.truth is None:
            return False
        return (
            abs(self.answer.scale / self.case.truth.scale - 1.0) <= SCALE_TOLERANCE
            and self.error <= TOLERANCE
        )


def similarity_fit(moving: np.ndarray, fixed: np.ndarray, weights: np.ndarray) -> Scaled:
    """The similarity transform of least weighted squares (Umeyama 1991)."""
    share = weights[:, None] / weights.sum()
    middle_moving, middle_fixed = (share * moving).sum(axis=0), (share * fixed).sum(axis=0)
    a, b = moving - middle_moving, fixed - middle_fixed
    along = float((share * a * b).sum())
    across = float((share[:, 0] * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])).sum())
    scale = math.hypot(along, across) / float((share * a**2).sum())
    theta = math.atan2(across, along)
    x, y = middle_fixed - transformed((0.0, 0.0, theta), scale * middle_moving[None])[0]
    return Scaled((float(x), float(y), theta), scale)


def robust_fit(moving: np.ndarray, fixed: np.ndarray) -> Scaled:
    """similarity_fit() in which marks far off weigh little (Cauchy's weights)."""
    weights = np.ones(len(moving))
    for _ in range(50):
        fitted = similarity_fit(moving, fixed, weights)
        off = np.linalg.norm(fitted.apply(moving) - fixed, axis=1)
        weights = 1.0 / (1.0 + (off / max(MARK_TOLERANCE, 1.48 * float(np.median(off)))) ** 2)
    return fitted


def without_furniture(map_: Map) -> Map:
    """Without walls that touch no other and are small."""
    cells = map_.cells.copy()
    left = {(int(row), int(column)) for row, column in zip(*np.nonzero(cells == OCCUPIED), strict=True)}
    while left:
        thing = [left.pop()]
        for row, column in thing:
            for next_ in ((row + dy, column + dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1)):
                if next_ in left:
                    left.remove(next_)
                    thing.append(next_)
        rows, columns = np.array(thing).T
        if math.hypot(np.ptp(rows), np.ptp(columns)) * map_.resolution > LARGEST_THING:
            continue
        inside = cells[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
        inside[inside != FREE] = FREE
    return Map(cells, map_.resolution, map_.origin)


def on_paper(map_: Map, scale: float, paper: int | None) -> Map:
    """The plan at its scale; on paper only walls are drawn, with a margin around them."""
    cells = map_.cells
    x, y, theta = map_.origin
    if paper is not None:
        cells = np.pad(
            np.where(cells == OCCUPIED, OCCUPIED, paper).astype(np.uint8), 20, constant_values=paper
        )
        x, y = transformed(map_.origin, np.full((1, 2), -20 * map_.resolution))[0]
    return Map(cells, map_.resolution * scale, (float(x) * scale, float(y) * scale, theta))


def known_points(map_: Map, most: int = 2000) -> np.ndarray:
    rows, columns = np.nonzero(map_.cells != UNKNOWN)
    step = max(1, len(rows) // most)
    return map_.points(np.column_stack([columns, rows])[::step])


def simulate(
    gridmerge: pathlib.Path,
    folder: pathlib.Path,
    kind: str,
    size: str,
    drift: float,
    seed: int,
    robots: int,
    more: Sequence[str] = (),
) -> tuple[Map, dict[str, Pose]]:
    """A building's plan, and where each robot's map lies on it, by file."""
    arguments = [
        "--kind",
        kind,
        "--size",
        size,
        "--drift",
        str(drift),
        "--robots",
        str(robots),
        "--others",
        "0",
    ]
    subprocess.run(
        [gridmerge, "simulate", *arguments, "--seed", str(seed), *more, "--quiet", "-o", folder],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    with (folder / "building.tsv").open(newline="") as file:
        truth = {
            row["moving"]: (float(row["x"]), float(row["y"]), float(row["theta"]))
            for row in csv.DictReader(file, delimiter="\t")
        }
    return without_furniture(read_map(folder / "building.yaml")), truth


def simulated_cases(gridmerge: pathlib.Path, folder: pathlib.Path, most_unrelated: int) -> list[Case]:
    cases, unrelated, plans = [], [], []
    for number, (kind, size, drift, scale) in enumerate(SIMULATED):
        made = folder / str(number)
        plan, truth = simulate(gridmerge, made, kind, size, drift, SEED + number, 2)
        for name, paper in PAPERS.items():
            path = made / f"plan_{name.replace(' ', '_')}.yaml"
            write_map(path, on_paper(plan, scale, paper))
            for moving, (x, y, theta) in truth.items():
                points = known_points(read_map(made / moving))
                cases.append(
                    Case(
                        f"simulated, {name}",
                        path,
                        made / moving,
                        Scaled((scale * x, scale * y, theta), scale),
                        points,
                    )
                )
        plans.append(made / "plan_a_map.yaml")
    for number, plan in enumerate(plans):
        for other in range(1, len(plans)):
            maps = plans[(number + other) % len(plans)].parent
            unrelated += [
                Case("simulated, unrelated", plan, maps / f"robot_{robot}.yaml") for robot in (1, 2)
            ]
    return cases + evenly(unrelated, most_unrelated)


def evenly(cases: list[Case], most: int) -> list[Case]:
    return cases if len(cases) <= most else [cases[i * len(cases) // most] for i in range(most)]


def real_cases(data: pathlib.Path, most_unrelated: int) -> list[Case]:
    folder = data / "halmstad"
    if not (folder / "marks.tsv").exists():
        print(f"no real maps in {data}: simulated ones alone")
        return []
    marks = collections.defaultdict(list)
    with (folder / "marks.tsv").open(newline="") as file:
        for row in csv.DictReader(file, delimiter="\t"):
            if "layout" in row["moving"]:
                marks[row["fixed"], row["moving"]].append(
                    [float(row[name]) for name in ("x_fixed", "y_fixed", "x_moving", "y_moving")]
                )
    cases = []
    for (map_, layout), rows in marks.items():
        both = np.array(rows)
        cases.append(
            Case(
                f"real, {layout[:-12]}",
                folder / layout,
                folder / map_,
                robust_fit(both[:, :2], both[:, 2:]),
                both[:, :2],
            )
        )
    layouts = sorted(folder.glob("*_layout.yaml"))
    maps = sorted(set(folder.glob("*.yaml")) - set(layouts))
    strangers = [(a, b) for a in [*layouts, *maps] for b in [*layouts, *maps] if a.name[:2] < b.name[:2]]
    strangers += [
        (layout, map_) for layout in layouts for map_ in sorted((data / "radish").glob("*/*/map*.yaml"))
    ]
    return cases + evenly([Case("real, unrelated", *pair) for pair in strangers], most_unrelated)


def match(gridmerge: pathlib.Path, case: Case) -> Outcome:
    done = subprocess.run(
        [
            gridmerge,
            "match",
            "--scale",
            SCALES,
            "--json",
            "--quiet",
            "--threads",
            "1",
            case.fixed,
            case.moving,
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode not in (0, 3):
        raise RuntimeError(f"{case.fixed} and {case.moving}: {done.stderr}")
    found = json.loads(done.stdout)
    return Outcome(
        case,
        found["verdict"] == "accepted",
        found["probability"],
        Scaled(read_pose(found["transform"]), found["scale"]),
        found["seconds"],
    )


def by_table(outcomes: list[One], table_of: Callable[[One], str]) -> dict[str, list[One]]:
    """In the order of their first ones."""
    tables: dict[str, list[One]] = {}
    for outcome in outcomes:
        tables.setdefault(table_of(outcome), []).append(outcome)
    return tables


def report(outcomes: list[Outcome]) -> str:
    tables = by_table(outcomes, lambda outcome: outcome.case.table)
    lines = [
        "| maps | cases | best right | accepted right | accepted wrong | most probable wrong | seconds, median |",
        "| --- | --- | --- | --- | --- | --- | --- |",
    ]
    for name, of_table in tables.items():
        wrong = [one for one in of_table if not one.right]
        likeliest = max((one.probability for one in wrong), default=0.0)
        right = sum(one.accepted and one.right for one in of_table)
        seconds = statistics.median(one.seconds for one in of_table)
        lines.append(
            f"| {name} | {len(of_table)} | {len(of_table) - len(wrong)} | {right} | "
            f"{sum(one.accepted for one in wrong)} | {likeliest:.3f} | {seconds:.1f} |"
        )
    return "\n".join(lines) + "\n"


def parser_of(description: str, limited: str | None, work: str) -> argparse.ArgumentParser:
    """Of the options that all benchmarks of plans have. `limited`: what --limit counts."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--limit", type=int, default=200, help=limited)
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help=f"{work} at one time")
    return parser


def read_options(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """What is asked for on the command line; the folder for it is there."""
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    return options


def main() -> None:
    options = read_options(parser_of(__doc__, None, "matches"))
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        cases = real_cases(options.data, options.limit)
        cases += simulated_cases(options.gridmerge, pathlib.Path(folder), options.limit // 2)
        outcomes = []
        with (options.output / "plans.tsv").open("w") as file:
            print(
                "table",
                "fixed",
                "moving",
                "verdict",
                "probability",
                "scale",
                "true_scale",
                "error",
                "right",
                sep="\t",
                file=file,
            )
            for one in pool.map(lambda case: match(options.gridmerge, case), cases):
                outcomes.append(one)
                true_scale = one.case.truth.scale if one.case.truth else math.nan
                print(
                    one.case.table,
                    one.case.fixed.name,
                    f"{one.case.moving.parent.name}/{one.case.moving.name}",
                    "accepted" if one.accepted else "refused",
                    f"{one.probability:.4f}",
                    f"{one.answer.scale:.4f}",
                    f"{true_scale:.4f}",
                    f"{one.error:.2f}",
                    int(one.right),
                    sep="\t",
                    file=file,
                    flush=True,
                )
    text = report(outcomes)
    (options.output / "plans.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
