#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How alike simulated maps are to real ones: statistics of their character, and a picture of both.

usage: experiments/side_by_side.py --gridmerge BINARY --output DIR [--data DIR]

Prints the tables of docs/simulator.md and writes DIR/side_by_side.png: real maps above, simulated ones below. Without
real maps it does the simulated half alone. The picture shows the real maps, whose licence is not this project's; so it
stays in DIR, a build folder. Needs numpy and matplotlib, and some two minutes.
"""

import argparse
import csv
import pathlib
import random
import re
import shutil
import statistics
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.image
import matplotlib.pyplot as plt
import numpy as np

OCCUPIED, FREE, UNKNOWN = 0, 254, 205
SEEDS = range(1, 11)
DRIFTS = ("0", "0.5", "1", "2")
SPECK = 5  # cells: what is smaller is a speck
SHOWN = 3  # maps of a group in the picture
LASER_KINDS = ("office", "loop", "curved", "hall")


def hand_held(seed: int) -> dict:
    """A depth camera carried through an office floor: sees narrowly and not far."""
    dice = random.Random(seed)
    return {
        "--kind": "office",
        "--size": "60x30",
        "--overlap": "0.6",
        "--drift": "1",
        "--clutter": "0.3",
        "--range": f"{dice.uniform(4, 5):.2f}",
        "--field-of-view": f"{dice.uniform(60, 120):.0f}",
    }


def laser(seed: int) -> dict:
    """A robot with a laser of 180 beams, whose log was put right afterwards: sees far, and sparsely there."""
    dice = random.Random(seed)
    return {
        "--kind": LASER_KINDS[seed % len(LASER_KINDS)],
        "--size": "60x40",
        "--resolution": "0.1",
        "--longest-way": "40",
        "--clutter": "0.5",
        "--angular-step": "1",
        "--drift": f"{dice.uniform(0, 0.2):.2f}",
        "--range": f"{dice.uniform(15, 30):.1f}",
        "--field-of-view": "180",
    }


# Each group: its name, metres per cell, the real maps, and the options of the simulated ones.
GROUPS = [
    ("hand-held", 0.05, "halmstad/E5_[0-9]*.png", hand_held),
    ("laser", 0.1, "radish/pairs/*/map?.pgm", laser),
]


def read_cells(path: pathlib.Path) -> np.ndarray:
    if path.suffix == ".png":
        return np.rint(matplotlib.image.imread(path) * 255).astype(np.uint8)
    data = path.read_bytes()
    _, width, height, _ = data.split(None, 4)[:4]
    return np.frombuffer(data[-int(width) * int(height) :], np.uint8).reshape(int(height), int(width))


def read_map(path: pathlib.Path) -> np.ndarray:
    """The cells that hold anything known, and nothing around them."""
    cells = read_cells(path)
    rows, columns = np.nonzero(cells != UNKNOWN)
    return cells[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]


def simulate(gridmerge: pathlib.Path, folder: pathlib.Path, options: dict, seed: int) -> list[float]:
    """Two robots' maps in `folder`; by how much each is bent [m]."""
    words = [word for option in options.items() for word in option]
    result = subprocess.run(
        [
            gridmerge,
            "simulate",
            "--robots",
            "2",
            "--others",
            "0",
            "--seed",
            str(seed),
            "--threads",
            "1",
            "--quiet",
            "-o",
            folder,
            *words,
        ],
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    return [float(bend) for bend in re.findall(r"bent by ([0-9.]+) m", result.stdout)]


def robots(folders: list[pathlib.Path]) -> list[pathlib.Path]:
    return [path for folder in folders for path in sorted(folder.glob("robot_*.pgm"))]


def edges(inside: np.ndarray, outside: np.ndarray) -> int:
    """How many sides of cells lie between the two; what is beyond the picture is `outside`."""
    a, b = np.pad(inside, 1), np.pad(outside, 1, constant_values=True)
    return int(sum(np.count_nonzero(a & np.roll(b, step, axis)) for axis in (0, 1) for step in (1, -1)))


def specks(occupied: np.ndarray) -> tuple[np.ndarray, int]:
    """The occupied cells of 8-connected components of fewer than SPECK cells, and how many components these are."""
    left = {(int(y), int(x)) for y, x in np.argwhere(occupied)}
    small, count = np.zeros_like(occupied), 0
    while left:
        component = [left.pop()]
        for y, x in component:  # grows while it is walked through
            near = {(y + j, x + i) for j in (-1, 0, 1) for i in (-1, 0, 1)} & left
            left -= near
            component += near
        if len(component) < SPECK:
            small[tuple(zip(*component, strict=True))] = True
            count += 1
    return small, count


def character(cells: np.ndarray, resolution: float) -> dict[str, float]:
    known, occupied = cells != UNKNOWN, cells == OCCUPIED
    area = np.count_nonzero(known) * resolution**2
    small, count = specks(occupied)
    walls = occupied & ~small
    # Sides of cells are longer than the line that they follow: at a random angle by 4 / pi.
    thickness = 2 * np.count_nonzero(walls) / (np.pi / 4 * edges(walls, ~walls))
    outline = edges(known, ~known)
    return {
        "known area [m^2]": area,
        "known cells that are occupied [%]": 100 * occupied.sum() / known.sum(),
        "wall thickness [m]": thickness * resolution,
        "wall thickness [cells]": thickness,
        "occupied cells in specks [%]": 100 * small.sum() / occupied.sum(),
        "specks on 100 m^2": 100 * count / area,
        "outline of the known / square root of its area": outline * resolution / area**0.5,
        "outline of the known that is not wall [%]": 100 * edges(known & ~occupied, ~known) / outline,
    }


def clean(folder: pathlib.Path) -> pathlib.Path:
    """Copies of the maps with the looks of the real hand-held ones: no specks, and thick walls."""
    copy = folder.with_name(f"{folder.name}_cleaned")
    shutil.copytree(folder, copy, dirs_exist_ok=True)
    for path in robots([copy]):
        cells = np.pad(read_cells(path), 1, constant_values=UNKNOWN)
        small, _ = specks(cells == OCCUPIED)
        cells[small] = FREE
        occupied = cells == OCCUPIED
        for axis in (0, 1):
            occupied = np.logical_or.reduce([np.roll(occupied, step, axis) for step in range(-1, 2)])
        cells[occupied] = OCCUPIED
        height, width = cells.shape
        path.write_bytes(f"P5\n{width - 2} {height - 2}\n255\n".encode() + cells[1:-1, 1:-1].tobytes())
    return copy


def spread(values: list[float]) -> str:
    """The median, and the range."""
    if not values:
        return ""
    digits = 0 if max(values) >= 100 else 1 if max(values) >= 5 else 2
    return f"{statistics.median(values):.{digits}f} ({min(values):.{digits}f} to {max(values):.{digits}f})"


def table(rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([lines[0], "|" + " --- |" * len(rows[0]), *lines[1:]])


def character_table(columns: dict[str, list[dict[str, float]]]) -> str:
    rows = [["", *(f"{name}: {len(maps)} maps" for name, maps in columns.items())]]
    for key in next(iter(columns.values()))[0]:
        rows.append([key, *(spread([figures[key] for figures in maps]) for maps in columns.values())])
    return table(rows)


def meetings(
    gridmerge: pathlib.Path, pairs: list[pathlib.Path], output: pathlib.Path
) -> tuple[list[float], list[float]]:
    """Shares of the walls that meet rigidly, and patch by patch, of the pairs whose best hypothesis
    is the true pose."""
    rigid, local = [], []
    for path in pairs:
        features = output / "features.tsv"
        subprocess.run(
            [gridmerge, "evaluate", path, "--features", features, "--threads", "1", "--quiet"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        with features.open(newline="") as file:
            for row in csv.DictReader(file, delimiter="\t"):
                if row["hypothesis"] == "1" and row["truth"] == "right":
                    rigid.append(100 * float(row["walls_met"]))
                    local.append(100 * float(row["walls_met_locally"]))
    return rigid, local


def largest_residuals(pairs: list[pathlib.Path]) -> list[float]:
    """What the best rigid fit of two simulated maps leaves is at most this [m]: see the tolerance in src/simulate."""
    residuals = []
    for path in pairs:
        with path.open(newline="") as file:
            residuals += [(float(row["tolerance"]) - 0.3) / 2 for row in csv.DictReader(file, delimiter="\t")]
    return residuals


def bending_table(arguments: argparse.Namespace) -> str:
    rows = [
        [
            "maps",
            "one map, bent by [m]",
            "two maps, left by the best rigid fit, at most [m]",
            "best right",
            "walls that meet rigidly [%]",
            "patch by patch [%]",
        ]
    ]

    def add(name: str, bends: str, residuals: str, pairs: list[pathlib.Path]) -> None:
        rigid, local = meetings(arguments.gridmerge, pairs, arguments.output)
        count = sum(len(path.read_text().splitlines()) - 1 for path in pairs)
        rows.append([name, bends, residuals, f"{len(rigid)} of {count}", spread(rigid), spread(local)])

    for drift in DRIFTS:
        bends, folders = [], [arguments.output / f"drift_{drift}_{seed}" for seed in SEEDS]
        for seed, folder in zip(SEEDS, folders, strict=True):
            bends += simulate(arguments.gridmerge, folder, hand_held(seed) | {"--drift": drift}, seed)
        pairs = [folder / "pairs.tsv" for folder in folders]
        add(f"`--drift {drift}`", spread(bends), spread(largest_residuals(pairs)), pairs)
        add("the same, cleaned", "", "", [clean(folder) / "pairs.tsv" for folder in folders])
    truth = arguments.data / "halmstad" / "pairs.tsv"
    if truth.is_file():
        add("hand-held, real", "", "0.3 to 1.3 (marked by hand)", [truth])
    return table(rows)


def draw(picture: list[list[tuple[str, np.ndarray]]], path: pathlib.Path) -> None:
    """One row of maps above the other."""
    columns = max(len(row) for row in picture)
    figure, axes = plt.subplots(
        len(picture), columns, figsize=(3.4 * columns, 3.4 * len(picture)), squeeze=False
    )
    for axis in axes.flat:
        axis.axis("off")
    for row, maps in zip(axes, picture, strict=True):
        for axis, (name, cells) in zip(row, maps, strict=False):  # not every row is full
            axis.imshow(cells, cmap="gray", vmin=0, vmax=255, interpolation="antialiased")
            axis.set_title(name, fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=80)
    plt.close(figure)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)

    columns, picture = {}, [[], []]
    for name, resolution, pattern, options in GROUPS:
        real = sorted(arguments.data.glob(pattern))
        if not real:
            print(f"No real maps at {arguments.data / pattern}: only simulated ones.", file=sys.stderr)
        folders = [arguments.output / f"{name}_{seed}" for seed in SEEDS]
        for seed, folder in zip(SEEDS, folders, strict=True):
            simulate(arguments.gridmerge, folder, options(seed), seed)
        groups = [(f"{name}, real", real), (f"{name}, simulated", robots(folders))]
        if options is hand_held:
            groups.append((f"{name}, simulated, cleaned", robots([clean(folder) for folder in folders])))
        for row, (label, paths) in enumerate(groups):
            if not paths:
                continue
            maps = [read_map(path) for path in paths]
            columns[label] = [character(cells, resolution) for cells in maps]
            if row < len(picture):
                picture[row] += [(label, cells) for cells in maps[:: -(-len(maps) // SHOWN)]]
    print(character_table(columns), end="\n\n")
    print(bending_table(arguments), end="\n\n")
    draw([row for row in picture if row], arguments.output / "side_by_side.png")
    print(f"wrote {arguments.output / 'side_by_side.png'}", file=sys.stderr)


if __name__ == "__main__":
    main()
