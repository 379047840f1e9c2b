#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `merge --transform` makes of maps of another scale, or with sheared axes.

Writes stretched.md. Robots map an invented building, and one of their maps is written with a false resolution, or drawn
anew with shear. The truth is known for every cell: where each map has a place of the building.
"""

from __future__ import annotations

import argparse
import csv
import re
import statistics
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from bent import Merged, merge, place, transform, untransform

TRANSFORMS = ("rigid", "similarity", "affine", "elastic")
CHANGED = "robot_2.yaml"
UNKNOWN = 205
CASES = {
    "straight": np.eye(2),
    "1 % long": 1.01 * np.eye(2),
    "2 % long": 1.02 * np.eye(2),
    "3 % long": 1.03 * np.eye(2),
    "4 % short": 0.96 * np.eye(2),
    "5 % long": 1.05 * np.eye(2),
    "8 % long": 1.08 * np.eye(2),
    "2 % of shear": np.array([[1.0, 0.02], [0.0, 1.0]]),
    "3 % along one axis": np.diag([1.03, 1.0]),
}


@dataclass
class Map:
    """The grey values of a map, row 0 at the bottom, with its entries."""

    grey: np.ndarray
    resolution: float
    corner: np.ndarray  # [m]

    @classmethod
    def read(cls, path: Path) -> Map:
        entries = dict(line.split(": ", 1) for line in path.read_text().splitlines() if ": " in line)
        data = (path.parent / entries["image"]).read_bytes()
        header = re.match(rb"P5\s+(?:#[^\n]*\n\s*)*(\d+)\s+(\d+)\s+255\s", data)
        assert header is not None, path
        width, height = int(header[1]), int(header[2])
        grey = np.frombuffer(data, np.uint8, width * height, header.end()).reshape(height, width)[::-1]
        x, y, theta = (float(value) for value in entries["origin"].strip("[]").split(","))
        assert theta == 0.0, path
        return cls(grey, float(entries["resolution"]), np.array([x, y]))

    def write(self, path: Path) -> None:
        height, width = self.grey.shape
        picture = path.with_suffix(".pgm")
        picture.write_bytes(f"P5\n{width} {height}\n255\n".encode() + self.grey[::-1].tobytes())
        x, y = (repr(float(value)) for value in self.corner)
        path.write_text(
            f"image: {picture.name}\nmode: trinary\nresolution: {float(self.resolution)!r}\norigin: [{x}, {y}, 0.0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
        )

    def known(self, points: np.ndarray) -> np.ndarray:
        cells = np.floor((points - self.corner) / self.resolution).astype(int)
        height, width = self.grey.shape
        inside = ((cells >= 0) & (cells < (width, height))).all(axis=1)
        known = np.zeros(len(points), bool)
        known[inside] = self.grey[cells[inside, 1], cells[inside, 0]] != UNKNOWN
        return known

    def changed(self, matrix: np.ndarray) -> Map:
        """The map whose frame's points are matrix * p: of a scale by its resolution alone, otherwise drawn anew."""
        if np.array_equal(matrix, matrix[0, 0] * np.eye(2)):
            scale = float(matrix[0, 0])
            return Map(self.grey, self.resolution * scale, self.corner * scale)
        size = np.array(self.grey.shape[::-1]) * self.resolution
        corners = np.array([self.corner + size * (i, j) for i in (0, 1) for j in (0, 1)]) @ matrix.T
        low = corners.min(axis=0)
        columns, rows = np.ceil((corners.max(axis=0) - low) / self.resolution).astype(int)
        x, y = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
        centres = np.stack([x, y], axis=-1).reshape(-1, 2) * self.resolution + low
        cells = np.floor((centres @ np.linalg.inv(matrix).T - self.corner) / self.resolution).astype(int)
        height, width = self.grey.shape
        inside = ((cells >= 0) & (cells < (width, height))).all(axis=1)
        grey = np.full(len(cells), UNKNOWN, np.uint8)
        grey[inside] = self.grey[cells[inside, 1], cells[inside, 0]]
        return Map(grey.reshape(rows, columns), self.resolution, low)


@dataclass
class Team:
    """Maps of a building, one of them changed."""

    maps: list[Path]
    points: list[np.ndarray]  # of each map: places of the building [m] ...
    known: list[np.ndarray]  # ... that it knows
    in_map: list[np.ndarray]  # where the map has each place, known or not


def make_team(folder: Path, case: str, matrix: np.ndarray) -> Team:
    target = folder / re.sub(r"\W+", "_", case)
    target.mkdir(exist_ok=True)
    with (folder / "building.tsv").open() as table:
        poses = {
            row["moving"]: {axis: float(row[axis]) for axis in ("x", "y", "theta")}
            for row in csv.DictReader(table, delimiter="\t")
        }
    axis = np.arange(-5.0, 60.0, 0.5)
    places = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
    team = Team([], [], [], [])
    for name, pose in sorted(poses.items()):
        straight = Map.read(folder / name)
        own = matrix if name == CHANGED else np.eye(2)
        path = target / name
        straight.changed(own).write(path)
        in_map = untransform(pose, places)
        team.maps.append(path)
        team.points.append(places)
        team.known.append(straight.known(in_map))
        team.in_map.append(in_map @ own.T)
    return team


def rigid_residual(at: np.ndarray, truth: np.ndarray) -> float:
    """After the best rigid fit [m, root mean square]."""
    a, b = at - at.mean(axis=0), truth - truth.mean(axis=0)
    theta = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    turned = transform({"x": 0.0, "y": 0.0, "theta": float(theta)}, a)
    return float(np.sqrt(((turned - b) ** 2).sum(axis=1).mean()))


@dataclass
class Figures:
    """Of the merges of a case."""

    between: list[float] = field(default_factory=list)  # the maps [m]
    to_building: list[float] = field(default_factory=list)  # [m]
    doubled: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    scale: list[float] = field(default_factory=list)  # of the changed map, by the mean of the others
    moved: list[float] = field(default_factory=list)  # at most, from the rigid merge [m]


def placed(team: Team, merged: Merged) -> dict[int, np.ndarray]:
    members = merged.members()
    return {
        i: place(members[path.name], team.in_map[i])
        for i, path in enumerate(team.maps)
        if path.name in members
    }


def largest_move(team: Team, before: dict[int, np.ndarray], after: dict[int, np.ndarray]) -> float:
    return max(
        float(np.hypot(*(after[i] - at)[team.known[i]].T).max())
        for i, at in before.items()
        if team.known[i].any()
    )


def add_figures(team: Team, merged: Merged, rigid: Merged, figures: Figures) -> None:
    at = placed(team, merged)
    apart = []
    for a in at:
        for b in at:
            both = team.known[a] & team.known[b]
            if a < b and both.sum() >= 20:
                apart.append(((at[a] - at[b])[both] ** 2).sum(axis=1))
    figures.between.append(float(np.sqrt(np.concatenate(apart).mean())))
    figures.to_building.append(
        rigid_residual(
            np.concatenate([at[i][team.known[i]] for i in at]),
            np.concatenate([team.points[i][team.known[i]] for i in at]),
        )
    )
    figures.doubled.append(100.0 * merged.doubled)
    figures.seconds.append(merged.seconds)
    figures.moved.append(largest_move(team, placed(team, rigid), at))
    scales = {
        name: member.get("deformation", {}).get("scale", 1.0) for name, member in merged.members().items()
    }
    others = [scale for name, scale in scales.items() if name != CHANGED]
    if CHANGED in scales and others:
        figures.scale.append(statistics.fmean(others) / scales[CHANGED])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=Path, required=True, help="the program")
    parser.add_argument("--output", type=Path, required=True, help="directory for the results")
    parser.add_argument("--limit", type=int, default=6, help="buildings")
    arguments = parser.parse_args()
    work = arguments.output / "stretched"
    work.mkdir(parents=True, exist_ok=True)
    report = [
        "# Maps of another scale",
        "Offices mapped by four robots without drift; the second robot's map is changed. Medians over the buildings",
        "in which it joins with a rigid merge; of what moved, the most. Between maps: how far apart they put places",
        "that both know [m, root mean square]. To the building: how far all maps put them from where they are, after",
        "the best rigid fit [m, root mean square]. Moved: how far from the rigid merge, at most [m]. Scale: by how",
        "much the changed map is too large, as was found. Seconds: with the matches of all pairs in a cache.",
        "",
        "| changed | transform | joined | between maps | to the building | lie double | scale | moved | seconds |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for case, matrix in CASES.items():
        figures = {kind: Figures() for kind in TRANSFORMS}
        for seed in range(1, arguments.limit + 1):
            folder = work / f"office_{seed}"
            options = f"--kind office --robots 4 --overlap 0.7 --others 0 --clutter 0 --drift 0 --seed {seed}"
            subprocess.run(
                [arguments.gridmerge, "simulate", *options.split(), "-o", folder, "-q"],
                check=True,
                capture_output=True,
            )
            team = make_team(folder, case, matrix)
            target = team.maps[0].parent
            cache = ("--cache", str(target / "matches"))  # the same matches; the first merge has none
            rigid = merge(arguments.gridmerge, team.maps, target / "rigid", *cache)
            rigid = merge(arguments.gridmerge, team.maps, target / "rigid", *cache)
            if CHANGED not in rigid.members():
                continue
            add_figures(team, rigid, rigid, figures["rigid"])
            for kind in TRANSFORMS[1:]:
                merged = merge(arguments.gridmerge, team.maps, target / kind, "--transform", kind, *cache)
                assert merged.joins() == rigid.joins(), "a transform changes a join"
                add_figures(team, merged, rigid, figures[kind])
        for kind, of in figures.items():
            if not of.between:
                report.append(f"| {case} | {kind} | 0 of {arguments.limit} | | | | | | |")
                continue
            median = statistics.median
            report.append(
                f"| {case} | {kind} | {len(of.between)} of {arguments.limit} | {median(of.between):.3f} | "
                f"{median(of.to_building):.3f} | {median(of.doubled):.1f} % | {median(of.scale):.4f} | "
                f"{max(of.moved):.3f} | {median(of.seconds):.2f} |"
            )
        print("\n".join(report[-len(figures) :]), flush=True)
    (arguments.output / "stretched.md").write_text("\n".join(report) + "\n")


if __name__ == "__main__":
    main()
