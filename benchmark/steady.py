#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Changes what must not matter in the inputs of matches and merges, and counts what the answers do.

usage: benchmark/steady.py --gridmerge GRIDMERGE --output DIR [--data DATA] [--limit N]

Writes DIR/steady.md. The pairs and teams are simulated ones, and real ones where DATA has them.
"""

import argparse
import collections.abc
import concurrent.futures
import csv
import dataclasses
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np
from peer_maps import UNKNOWN, Answer, KnownCells, Map, read_map, transformed, write_map
from peers import match_by_gridmerge
from poses import Pose, compose, inverse, read_pose

ACCEPT = 0.95  # gridmerge's own
NEAR = 0.05  # a verdict this near to the threshold may change with the grain of a redrawn map

SIMULATED = [  # kind and drift of the teams of three that are simulated
    ("office", 0.0),
    ("office", 1.0),
    ("apartment", 0.0),
    ("apartment", 1.0),
    ("warehouse", 0.0),
    ("curved", 0.3),
]


@dataclasses.dataclass(frozen=True)
class Variant:
    """A changed pair and what takes its pose back to one of the unchanged pair."""

    name: str
    fixed: Map
    moving: Map
    back: collections.abc.Callable[[Pose], Pose]


@dataclasses.dataclass(frozen=True)
class Change:
    """What a change of the input did to an answer."""

    name: str
    flipped: bool
    flipped_far: bool  # although the probabilities are far from the threshold
    probability: float  # by which it moved
    moved: float  # metres, root mean square over the moving map; NaN unless both answers are accepted


def bounds(map_: Map) -> tuple[slice, slice]:
    rows, columns = np.nonzero(map_.cells != UNKNOWN)
    return slice(rows.min(), rows.max() + 1), slice(columns.min(), columns.max() + 1)


def cut(map_: Map, border: int) -> Map:
    """Without the outermost known rows and columns."""
    rows, columns = bounds(map_)
    cells = np.full_like(map_.cells, UNKNOWN)
    inner = (
        slice(rows.start + border, rows.stop - border),
        slice(columns.start + border, columns.stop - border),
    )
    cells[inner] = map_.cells[inner]
    return dataclasses.replace(map_, cells=cells)


def quarter_turned(map_: Map) -> Map:
    """The same map, whose columns were its rows; points keep their coordinates."""
    height = map_.cells.shape[0]
    corner = compose(map_.origin, (0.0, height * map_.resolution, -0.5 * math.pi))
    return Map(map_.cells[::-1].T, map_.resolution, corner)


def redrawn(map_: Map, angle: float) -> Map:
    """The map on a lattice that is turned by `angle` [rad], each cell taken from the one under its middle."""
    height, width = map_.cells.shape
    corners = map_.points(np.array([[-1, -1], [width, -1], [-1, height], [width, height]]))
    turned = transformed((0.0, 0.0, -angle), corners)
    low, high = turned.min(axis=0), turned.max(axis=0)
    columns, rows = (np.ceil((high - low) / map_.resolution)).astype(int)
    origin = compose((0.0, 0.0, angle), (*low, 0.0))
    grid = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    points = transformed(origin, (grid + 0.5) * map_.resolution)
    source = np.floor(transformed(inverse(map_.origin), points) / map_.resolution).astype(int)
    inside = ((source >= 0) & (source < (width, height))).all(axis=1)
    cells = np.full(rows * columns, UNKNOWN, np.uint8)
    cells[inside] = map_.cells[source[inside, 1], source[inside, 0]]
    return Map(cells.reshape(rows, columns), map_.resolution, origin)


def mirrored(map_: Map) -> Map:
    """Seen from below: y of the map frame changes its sign."""
    x, y, theta = map_.origin
    height = map_.cells.shape[0]
    corner = compose((x, -y, -theta), (0.0, -height * map_.resolution, 0.0))
    return Map(map_.cells[::-1], map_.resolution, corner)


def variants(fixed: Map, moving: Map) -> collections.abc.Iterator[Variant]:
    for border in (1, 2, 3):
        yield Variant("1 to 3 known rows and columns cut off", cut(fixed, border), moving, lambda pose: pose)
        yield Variant("1 to 3 known rows and columns cut off", fixed, cut(moving, border), lambda pose: pose)
    yield Variant("turned by 90 degrees without loss", quarter_turned(fixed), moving, lambda pose: pose)
    yield Variant("turned by 90 degrees without loss", fixed, quarter_turned(moving), lambda pose: pose)
    for degrees in (5.0, 37.3, 45.0):
        yield Variant(
            "redrawn, turned by 5, 37.3, 45 degrees",
            fixed,
            redrawn(moving, math.radians(degrees)),
            lambda pose: pose,
        )
    yield Variant(
        "both mirrored", mirrored(fixed), mirrored(moving), lambda pose: (pose[0], -pose[1], -pose[2])
    )
    yield Variant("swapped", moving, fixed, inverse)


class Runner:
    def __init__(self, gridmerge: pathlib.Path, folder: pathlib.Path):
        self.gridmerge, self.folder = gridmerge, folder

    def match(self, fixed: pathlib.Path, moving: pathlib.Path) -> Answer:
        """Its score is the probability."""
        return match_by_gridmerge(self.gridmerge, fixed, moving)[0]

    def merge(self, maps: list[pathlib.Path], output: pathlib.Path) -> list[dict[int, Pose]]:
        """The poses of each component's members, by the number of the input."""
        done = subprocess.run(
            [self.gridmerge, "merge", *maps, "-o", output, "--quiet", "--threads", "1"], capture_output=True
        )
        if done.returncode not in (0, 3):
            raise RuntimeError(done.stderr.decode())
        components = []
        for component in json.loads((output / "transforms.json").read_text())["components"]:
            names = [str(map_) for map_ in maps]
            poses = {}
            for member in component["members"]:
                poses[names.index(member["source"])] = read_pose(member["transform"])
                names[names.index(member["source"])] = ""  # one that is given twice has two members
            components.append(poses)
        return components

    def changes_of_pair(self, number: int, fixed: pathlib.Path, moving: pathlib.Path) -> list[Change]:
        before = self.match(fixed, moving)
        maps = read_map(fixed), read_map(moving)
        known = KnownCells(maps[1])
        changes = []
        folder = self.folder / str(number)
        folder.mkdir()
        for variant in variants(*maps):
            write_map(folder / "fixed.yaml", variant.fixed)
            write_map(folder / "moving.yaml", variant.moving)
            after = self.match(folder / "fixed.yaml", folder / "moving.yaml")
            flipped = before.accepted != after.accepted
            near = min(abs(one.score - ACCEPT) for one in (before, after)) <= NEAR
            moved = (
                known.displacement(variant.back(after.pose), before.pose)
                if before.accepted and after.accepted
                else math.nan
            )
            changes.append(
                Change(variant.name, flipped, flipped and not near, abs(after.score - before.score), moved)
            )
        return changes

    def change_of_itself(self, path: pathlib.Path) -> Change:
        found = self.match(path, path)
        moved = (
            KnownCells(read_map(path)).displacement(found.pose, (0.0, 0.0, 0.0)) if found.pose else math.nan
        )
        return Change("a map with itself", not found.accepted, not found.accepted, 1.0 - found.score, moved)

    def changes_of_team(self, number: int, maps: list[pathlib.Path]) -> list[Change]:
        """Of three maps that are one component: a copy is added; the first two are merged first."""
        folder = self.folder / f"team{number}"
        folder.mkdir()
        whole = self.merge(maps, folder / "whole")
        if len(whole) != 1 or len(whole[0]) != len(maps):
            return []
        changes = []

        def add(name: str, poses: dict[int, Pose]) -> None:
            lost = [i for i in range(len(maps)) if i not in poses]
            moved = [
                KnownCells(read_map(maps[i])).displacement(
                    compose(inverse(poses[0]), poses[i]), compose(inverse(whole[0][0]), whole[0][i])
                )
                for i in range(1, len(maps))
                if not lost
            ]
            changes.append(Change(name, bool(lost), bool(lost), math.nan, max(moved, default=math.nan)))

        with_copy = self.merge([*maps, maps[1]], folder / "copy")
        add("a copy added to a merge", with_copy[0] if with_copy else {})
        first = self.merge(maps[:2], folder / "first") if len(maps) > 2 else []
        if first and len(first[0]) == 2:
            then = self.merge([folder / "first" / "merged.yaml", *maps[2:]], folder / "then")
            if then and len(then[0]) == len(maps) - 1:
                poses = {i: compose(then[0][0], first[0][i]) for i in range(2)}
                add("(a + b) + c beside a + b + c", poses | {i: then[0][i - 1] for i in range(2, len(maps))})
            else:
                add("(a + b) + c beside a + b + c", {})
        return changes


def summary(changes: list[Change]) -> list[str]:
    def most(values: list[float], digits: int) -> str:
        known = [value for value in values if not math.isnan(value)]
        return f"{np.median(known):.{digits}f}, {max(known):.{digits}f}" if known else ""

    lines = [
        "| change | answers | verdict changed | of them far from the threshold | probability moved: median, most | "
        "pose moved [m]: median, most |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for name in dict.fromkeys(change.name for change in changes):
        of_name = [change for change in changes if change.name == name]
        lines.append(
            f"| {name} | {len(of_name)} | {sum(change.flipped for change in of_name)} | "
            f"{sum(change.flipped_far for change in of_name)} | "
            f"{most([change.probability for change in of_name], 3)} | {most([change.moved for change in of_name], 3)} |"
        )
    return lines


@dataclasses.dataclass
class Domain:
    name: str
    pairs: list[tuple[pathlib.Path, pathlib.Path]]
    teams: list[list[pathlib.Path]]


def simulated(gridmerge: pathlib.Path, folder: pathlib.Path) -> Domain:
    domain = Domain("simulated", [], [])
    for kind, drift in SIMULATED:
        where = folder / f"{kind}-{drift}"
        subprocess.run(
            [
                gridmerge,
                "simulate",
                "--kind",
                kind,
                "--robots",
                "3",
                "--overlap",
                "0.6",
                "--drift",
                str(drift),
                "--seed",
                "5",
                "-o",
                where,
                "--quiet",
            ],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        maps = sorted(where.glob("robot_*.yaml"))
        domain.teams.append(maps)
        domain.pairs += [(maps[0], maps[1]), (maps[1], maps[2])]
    return domain


def real(data: pathlib.Path, limit: int) -> list[Domain]:
    domains = []
    for name in ("halmstad", "radish"):
        table = data / name / "pairs.tsv"
        if not table.exists():
            continue
        with table.open(newline="") as file:
            rows = list(csv.DictReader(file, delimiter="\t"))
        step = max(1, len(rows) // limit)
        pairs = [(table.parent / row["fixed"], table.parent / row["moving"]) for row in rows[::step][:limit]]
        teams = [sorted(team.glob("*.yaml"))[:3] for team in sorted((data / name / "sets").glob("*"))[:limit]]
        if not teams:  # three maps of each building
            buildings = {path.name.split("_")[0] for pair in pairs for path in pair}
            teams = [
                sorted(table.parent.glob(f"{building}_[0-9]*.yaml"))[:3] for building in sorted(buildings)
            ]
        domains.append(Domain(name, pairs, teams))
    return domains


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--limit", type=int, default=12, help="pairs and teams of each real table")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    lines = []
    with tempfile.TemporaryDirectory() as temporary, concurrent.futures.ThreadPoolExecutor() as pool:
        domains = [simulated(arguments.gridmerge, pathlib.Path(temporary) / "simulated")]
        if arguments.data and arguments.data.exists():
            domains += real(arguments.data, arguments.limit)
        else:
            print("no real maps: simulated ones alone")
        for domain in domains:
            folder = pathlib.Path(temporary) / f"changed-{domain.name}"
            folder.mkdir()
            runner = Runner(arguments.gridmerge, folder)
            maps = list(dict.fromkeys(path for pair in domain.pairs for path in pair))
            changes = list(pool.map(runner.change_of_itself, maps))
            for found in pool.map(
                runner.changes_of_pair, range(len(domain.pairs)), *zip(*domain.pairs, strict=True)
            ):
                changes += found
            for found in pool.map(runner.changes_of_team, range(len(domain.teams)), domain.teams):
                changes += found
            order = list(dict.fromkeys(change.name for change in changes))
            changes.sort(key=lambda change: order.index(change.name))
            lines += [
                "",
                f"**{domain.name}**, {len(domain.pairs)} pairs, {len(domain.teams)} teams",
                "",
                *summary(changes),
            ]
    text = "\n".join(lines[1:]) + "\n"
    (arguments.output / "steady.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
