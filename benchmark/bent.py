#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What `merge --elastic` makes of bent maps: marks of the Halmstad maps, thickness of walls, simulated maps.

The marks are also those of maps that have a scale of their own, or shear: `merge --transform`.

Writes bent.md. The marks are for this program alone: the engine never sees them.
"""

from __future__ import annotations

import argparse
import collections
import json
import re
import statistics
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib import image

SETS = ("E5", "HIH")
TRANSFORMS = ("rigid", "similarity", "affine", "elastic")
DRIFTS = (0.0, 0.5, 1.0, 2.0)
FARTHEST = 2.0  # [m]: a wall farther from every true one is no wall of the building


def transform(pose: dict[str, float], points: np.ndarray) -> np.ndarray:
    c, s = np.cos(pose["theta"]), np.sin(pose["theta"])
    x, y = points[:, 0], points[:, 1]
    return np.stack([c * x - s * y + pose["x"], s * x + c * y + pose["y"]], axis=1)


def untransform(pose: dict[str, float], points: np.ndarray) -> np.ndarray:
    c, s = np.cos(pose["theta"]), np.sin(pose["theta"])
    x, y = points[:, 0] - pose["x"], points[:, 1] - pose["y"]
    return np.stack([c * x + s * y, -s * x + c * y], axis=1)


def basis(t: np.ndarray) -> np.ndarray:
    s = 1.0 - t
    return np.stack([s**3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3], axis=1) / 6.0


def bend(lattice: dict, points: np.ndarray) -> np.ndarray:
    """The formula of docs/merging.md, apart from the library."""
    columns, rows = lattice["columns"], lattice["rows"]
    shifts = np.array(lattice["shifts"]).reshape(rows, columns, 2)
    q = untransform(lattice["frame"], points)
    x = np.clip(q[:, 0] / lattice["spacing"], 0.0, columns - 3.0)
    y = np.clip(q[:, 1] / lattice["spacing"], 0.0, rows - 3.0)
    i = np.minimum(x.astype(int), columns - 4)
    j = np.minimum(y.astype(int), rows - 4)
    of_x, of_y = basis(x - i), basis(y - j)
    bent = q.copy()
    for b in range(4):
        for a in range(4):
            bent += (of_x[:, a] * of_y[:, b])[:, None] * shifts[j + b, i + a]
    return transform(lattice["frame"], bent)


@dataclass
class Merged:
    """What a merge has written."""

    directory: Path
    seconds: float
    doubled: float  # share of the walls that several maps saw

    def members(self) -> dict[str, dict]:
        record = json.loads((self.directory / "transforms.json").read_text())
        components = record["components"]
        return {Path(one["source"]).name: one for one in components[0]["members"]} if components else {}

    def joins(self) -> list:
        return json.loads((self.directory / "transforms.json").read_text())["joins"]

    def walls(self) -> tuple[np.ndarray, float, tuple[float, float]]:
        return read_map(self.directory / "merged.yaml")


def place(member: dict, points: np.ndarray) -> np.ndarray:
    if "deformation" in member:
        points = bend(member["deformation"], points)
    return transform(member["transform"], points)


def read_map(path: Path) -> tuple[np.ndarray, float, tuple[float, float]]:
    """Whether a cell is occupied, row 0 at the bottom; metres per cell; the lower-left corner."""
    entries = dict(line.split(": ", 1) for line in path.read_text().splitlines() if ": " in line)
    picture = path.parent / entries["image"]
    if picture.suffix == ".pgm":
        data = picture.read_bytes()
        header = re.match(rb"P5\s+(?:#[^\n]*\n\s*)*(\d+)\s+(\d+)\s+255\s", data)
        assert header is not None, picture
        width, height = int(header[1]), int(header[2])
        grey = np.frombuffer(data, np.uint8, width * height, header.end()).reshape(height, width) / 255.0
    else:
        grey = image.imread(picture)
        grey = grey if grey.ndim == 2 else grey[:, :, 0]
    x, y, _ = json.loads(entries["origin"])
    return grey[::-1] < 0.2, float(entries["resolution"]), (x, y)


def thickness(occupied: np.ndarray, resolution: float) -> float:
    """Twice the area of what is occupied by its outline [m]."""
    padded = np.pad(occupied, 1).astype(np.int8)
    outline = np.abs(np.diff(padded, axis=0)).sum() + np.abs(np.diff(padded, axis=1)).sum()
    return 2.0 * float(occupied.sum()) * resolution / float(outline)


def merge(gridmerge: Path, maps: list[Path], output: Path, *options: str) -> Merged:
    started = time.monotonic()
    run = subprocess.run(
        [gridmerge, "merge", *maps, "-o", output, "--verbose", *options], capture_output=True, text=True
    )
    seconds = time.monotonic() - started
    if run.returncode not in (0, 3):
        raise SystemExit(run.stderr)
    doubled = re.search(r"^merged\.yaml: ([0-9.]+) % of the walls", run.stdout, re.MULTILINE)
    return Merged(output, seconds, float(doubled[1]) / 100.0 if doubled else float("nan"))


def read_marks(path: Path) -> dict[tuple[str, str], np.ndarray]:
    marks = collections.defaultdict(list)
    for line in path.read_text().splitlines()[1:]:
        fixed, moving, *numbers = line.split("\t")
        marks[fixed, moving].append([float(number) for number in numbers])
    return {pair: np.array(values) for pair, values in marks.items()}


def gross(marks: np.ndarray) -> np.ndarray:
    """Which marks of a pair no smooth deformation meets: more than 1 m from a robust quadratic fit of them all."""
    fixed, moving = marks[:, :2], marks[:, 2:]
    x, y = ((moving - moving.mean(axis=0)) / 20.0).T
    terms = [np.ones_like(x), x, y] + ([x * x, x * y, y * y] if len(marks) >= 10 else [])
    design = np.stack(terms, axis=1)
    ridge = np.diag([0.0] * 3 + [0.05] * (len(terms) - 3))
    weight = np.ones(len(marks))
    for scale in (4.0, 2.0, 1.0) + (0.5,) * 11:
        weighted = design * weight[:, None] ** 2
        fit = design @ np.linalg.solve(design.T @ weighted + ridge, weighted.T @ fixed)
        distance = np.hypot(*(fixed - fit).T)
        weight = 1.0 / (1.0 + (distance / scale) ** 2)
    return distance > 1.0


@dataclass
class MarkResiduals:
    """Of each pair [m]."""

    all: list[float]  # root mean square
    sound: list[float]  # the same without gross marks
    median: list[float]
    gross: int
    count: int


def mark_residuals(marks: dict[tuple[str, str], np.ndarray], members: dict[str, dict]) -> MarkResiduals:
    residuals = MarkResiduals([], [], [], 0, 0)
    for (fixed, moving), values in marks.items():
        if fixed not in members or moving not in members:
            continue
        apart = place(members[fixed], values[:, :2]) - place(members[moving], values[:, 2:])
        distance = np.hypot(*apart.T)
        is_gross = gross(values)
        residuals.all.append(float(np.sqrt((distance**2).mean())))
        residuals.sound.append(float(np.sqrt((distance[~is_gross] ** 2).mean())))
        residuals.median.append(float(np.median(distance)))
        residuals.gross += int(is_gross.sum())
        residuals.count += len(values)
    return residuals


def halmstad(gridmerge: Path, data: Path, output: Path, report: list[str]) -> None:
    marks = read_marks(data / "halmstad" / "marks.tsv")
    report += [
        "## Hand-held maps",
        "Marks: points marked by hand in both maps of a pair; root mean square over a pair, median over the pairs [m].",
        "Sound marks: without those more than 1 m from a robust quadratic fit of the pair's marks. Thickness: twice",
        "the area of the walls by their outline [m], of the inputs the median.",
        "",
        "| | " + " | ".join(f"{name} {kind}" for name in SETS for kind in TRANSFORMS) + " |",
        "| --- |" + " --- |" * len(SETS) * len(TRANSFORMS),
    ]
    columns: dict[str, list[str]] = collections.defaultdict(list)
    for name in SETS:
        maps = sorted((data / "halmstad").glob(f"{name}_[0-9]*.yaml"))
        inputs = [thickness(*read_map(path)[:2]) for path in maps]
        merges = [
            merge(gridmerge, maps, output / f"{name}_{kind}", "--transform", kind) for kind in TRANSFORMS
        ]
        of_rigid = mark_residuals(marks, merges[0].members())
        for merged in merges:
            of = mark_residuals(marks, merged.members())
            worst = max(a / b for a, b in zip(of.all, of_rigid.all, strict=True))
            columns["marks"].append(f"{statistics.median(of.all):.3f}")
            columns["sound marks"].append(f"{statistics.median(of.sound):.3f}")
            columns["median mark"].append(f"{statistics.median(of.median):.3f}")
            columns["gross marks"].append(f"{of.gross} of {of.count}")
            columns["worst pair, by rigid"].append(f"{worst:.2f}")
            columns["thickness"].append(f"{thickness(*merged.walls()[:2]):.3f}")
            columns["thickness of inputs"].append(f"{statistics.median(inputs):.3f}")
            columns["walls that lie double"].append(f"{100.0 * merged.doubled:.1f} %")
            columns["seconds"].append(f"{merged.seconds:.1f}")
    report += [f"| {name} | " + " | ".join(values) + " |" for name, values in columns.items()] + [""]


def wall_points(path: Path) -> np.ndarray:
    occupied, resolution, (x, y) = read_map(path)
    rows, columns = np.nonzero(occupied)
    return np.stack([(columns + 0.5) * resolution + x, (rows + 0.5) * resolution + y], axis=1)


def nearest(points: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of each point the nearest of the others, and how far that is."""
    index, distance = [], []
    for part in np.array_split(points, max(1, len(points) // 500)):
        squares = ((part[:, None, :] - others[None, :, :]) ** 2).sum(axis=2)
        index.append(squares.argmin(axis=1))
        distance.append(np.sqrt(squares.min(axis=1)))
    return np.concatenate(index), np.concatenate(distance)


def residual_to_building(gridmerge: Path, merged: Path, building: Path) -> float | None:
    """How far the walls of a merged map lie from the building's, after the best rigid fit [m, root mean square]."""
    run = subprocess.run([gridmerge, "match", building, merged, "--json"], capture_output=True, text=True)
    if run.returncode not in (0, 3):
        raise SystemExit(run.stderr)
    walls, truth = wall_points(merged), wall_points(building)
    walls, truth = walls[:: max(1, len(walls) // 4000)], truth[:: max(1, len(truth) // 6000)]
    at = transform(json.loads(run.stdout)["transform"], walls)
    for _ in range(8):
        index, distance = nearest(at, truth)
        near = distance < max(0.3, 2.0 * float(np.median(distance)))
        p, q = at[near], truth[index[near]]
        a, b = p - p.mean(axis=0), q - q.mean(axis=0)
        theta = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
        turn = {"x": 0.0, "y": 0.0, "theta": theta}
        at = transform(turn, at - p.mean(axis=0)) + q.mean(axis=0)
    _, distance = nearest(at, truth)
    distance = distance[distance < FARTHEST]
    return float(np.sqrt((distance**2).mean())) if len(distance) else None


def largest_shift(rigid: Merged, elastic: Merged) -> float:
    """How far bending moves a place of a map at most, but for a common rigid motion [m]."""
    before, after = rigid.members(), elastic.members()
    largest = 0.0
    origin = None
    for name, member in before.items():
        axis = np.linspace(-15.0, 15.0, 16)
        points = np.stack(np.meshgrid(axis, axis), axis=-1).reshape(-1, 2)
        moved = place(after[name], points) - place(member, points)
        origin = moved.mean(axis=0) if origin is None else origin
        largest = max(largest, float(np.median(np.hypot(*(moved - origin).T))))
    return largest


def simulated(gridmerge: Path, output: Path, seeds: int, report: list[str]) -> None:
    report += [
        "## Simulated maps",
        "Offices mapped by four robots. Residual: how far the walls of the merged map lie from the building's, after",
        "the best rigid fit [m, root mean square]; median over the buildings in which all four maps join.",
        "",
        "| drift | buildings | rigid | elastic | elastic by rigid | largest shift | lie double, rigid | elastic |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for drift in DRIFTS:
        residuals, shifts, doubled = [], [], []
        for seed in range(1, seeds + 1):
            folder = output / f"drift_{drift:g}_{seed}"
            options = (
                f"--kind office --robots 4 --overlap 0.7 --others 0 --clutter 0 --drift {drift} --seed {seed}"
            )
            subprocess.run(
                [gridmerge, "simulate", *options.split(), "-o", folder, "-q"], check=True, capture_output=True
            )
            maps = sorted(folder.glob("robot_[0-9].yaml"))
            rigid = merge(gridmerge, maps, folder / "rigid")
            elastic = merge(gridmerge, maps, folder / "elastic", "--elastic")
            if len(rigid.members()) < len(maps):
                continue
            assert rigid.joins() == elastic.joins(), "bending changes a join"
            pair = [
                residual_to_building(gridmerge, one.directory / "merged.yaml", folder / "building.yaml")
                for one in (rigid, elastic)
            ]
            residuals.append(pair)
            shifts.append(largest_shift(rigid, elastic))
            doubled.append((rigid.doubled, elastic.doubled))
        if not residuals:
            report.append(f"| {drift:g} | 0 | | | | | | |")
            continue
        before, after = (statistics.median(one[i] for one in residuals) for i in (0, 1))
        share = statistics.median(one[1] / one[0] for one in residuals)
        twice = [100.0 * statistics.median(one[i] for one in doubled) for i in (0, 1)]
        report.append(
            f"| {drift:g} | {len(residuals)} | {before:.3f} | {after:.3f} | {share:.2f} | {max(shifts):.3f} | "
            f"{twice[0]:.1f} % | {twice[1]:.1f} % |"
        )
    report.append("")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=Path, required=True, help="the program")
    parser.add_argument("--output", type=Path, required=True, help="directory for the results")
    parser.add_argument("--data", type=Path, required=True, help="with halmstad/; skipped where it is absent")
    parser.add_argument("--limit", type=int, default=6, help="buildings for each amount of drift")
    arguments = parser.parse_args()
    work = arguments.output / "bent"
    work.mkdir(parents=True, exist_ok=True)
    report = ["# Bent maps", ""]
    if (arguments.data / "halmstad" / "marks.tsv").exists():
        halmstad(arguments.gridmerge, arguments.data, work, report)
    else:
        report += [f"{arguments.data}/halmstad is absent: hand-held maps are skipped.", ""]
    simulated(arguments.gridmerge, work, arguments.limit, report)
    text = "\n".join(report)
    (arguments.output / "bent.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
