# SPDX-License-Identifier: Apache-2.0
"""Occupancy maps as arrays, for the scripts of this project: read, written, cut, and laid on each other.

Poses are (x, y, theta) in metres and radians. Arrays hold row 0 at the bottom, so that rows grow with y.
"""

import dataclasses
import math
import pathlib
import re

import numpy as np
from PIL import Image

OCCUPIED, FREE, UNKNOWN = 0, 254, 205
WALL_NEAR = 0.2  # [m] two walls this near to each other match

Pose = tuple[float, float, float]


@dataclasses.dataclass(frozen=True)
class Grid:
    cells: np.ndarray  # OCCUPIED, FREE or UNKNOWN
    resolution: float  # [m]
    x: float  # lower-left corner of the lower-left cell [m]
    y: float

    @property
    def known(self) -> np.ndarray:
        return self.cells != UNKNOWN

    @property
    def walls(self) -> np.ndarray:
        return self.cells == OCCUPIED

    @property
    def known_area(self) -> float:
        return float(np.count_nonzero(self.known)) * self.resolution**2


def compose(a: Pose, b: Pose) -> Pose:
    c, s = math.cos(a[2]), math.sin(a[2])
    theta = math.remainder(a[2] + b[2], 2.0 * math.pi)
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], theta)


def inverse(a: Pose) -> Pose:
    c, s = math.cos(a[2]), math.sin(a[2])
    return (-(c * a[0] + s * a[1]), -(-s * a[0] + c * a[1]), -a[2])


def transformed(pose: Pose, points: np.ndarray) -> np.ndarray:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return points @ np.array([[c, s], [-s, c]]) + np.array(pose[:2])


def read_grid(path: pathlib.Path) -> Grid:
    """A map_server YAML of cells of the three values, with an origin that is not turned."""
    entries = dict(re.findall(r"^(\w+):[ \t]*(.*?)[ \t]*$", path.read_text(), re.MULTILINE))
    x, y, theta = (float(number) for number in entries["origin"].strip("[]").split(","))
    if theta != 0.0:
        raise ValueError(f"{path}: the origin is turned")
    pixels = np.asarray(Image.open(path.parent / entries["image"].strip("'\"")).convert("L"))[::-1]
    cells = np.where(pixels < 89, OCCUPIED, np.where(pixels > 206, FREE, UNKNOWN)).astype(np.uint8)
    return Grid(cells, float(entries["resolution"]), x, y)


def write_grid(path: pathlib.Path, grid: Grid) -> None:
    """`path` is the YAML; the image, a PGM, is beside it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    height, width = grid.cells.shape
    image = path.with_suffix(".pgm")
    image.write_bytes(f"P5\n{width} {height}\n255\n".encode() + grid.cells[::-1].tobytes())
    path.write_text(
        f"image: {image.name}\nresolution: {grid.resolution}\norigin: [{float(grid.x)!r}, {float(grid.y)!r}, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


def cropped(grid: Grid) -> Grid:
    """The part that holds all that is known; the frame stays."""
    rows, columns = np.nonzero(grid.known.any(axis=1))[0], np.nonzero(grid.known.any(axis=0))[0]
    cells = grid.cells[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].copy()  # lets go of the rest
    return Grid(
        cells,
        grid.resolution,
        round(grid.x + columns[0] * grid.resolution, 6),
        round(grid.y + rows[0] * grid.resolution, 6),
    )


def centres(grid: Grid, mask: np.ndarray) -> np.ndarray:
    """Where the cells of `mask` are [m], one per row."""
    rows, columns = np.nonzero(mask)
    return np.column_stack(
        [grid.x + (columns + 0.5) * grid.resolution, grid.y + (rows + 0.5) * grid.resolution]
    )


def at(grid: Grid, layer: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The values of a boolean layer of the grid at points; false outside."""
    cells = np.floor((points - [grid.x, grid.y]) / grid.resolution).astype(np.int64)
    inside = ((cells >= 0) & (cells < [layer.shape[1], layer.shape[0]])).all(axis=1)
    values = np.zeros(len(points), bool)
    values[inside] = layer[cells[inside, 1], cells[inside, 0]]
    return values


def widened(layer: np.ndarray, radius: int) -> np.ndarray:
    """All within `radius` cells of what is true."""
    padded = np.pad(layer, radius)
    result = np.zeros_like(layer)
    height, width = layer.shape
    for dy in range(-radius, radius + 1):
        for dx in range(-radius, radius + 1):
            if dx * dx + dy * dy <= radius * radius:
                result |= padded[radius + dy : radius + dy + height, radius + dx : radius + dx + width]
    return result


def overlap(fixed: Grid, moving: Grid, T_fixed_moving: Pose) -> float:
    """The share of the smaller map's known cells that the other one knows too."""
    shared = at(fixed, fixed.known, transformed(T_fixed_moving, centres(moving, moving.known)))
    smaller = min(fixed.known_area, moving.known_area)
    return min(1.0, float(np.count_nonzero(shared)) * moving.resolution**2 / smaller) if smaller else 0.0


def shared_walls(fixed: Grid, moving: Grid, T_fixed_moving: Pose) -> tuple[float, float]:
    """How many cells of wall of each map lie where the other knows, on average, and the share of them that match."""
    counts, matches = [], []
    for a, b, T_a_b in ((fixed, moving, T_fixed_moving), (moving, fixed, inverse(T_fixed_moving))):
        walls = transformed(T_a_b, centres(b, b.walls))
        walls = walls[at(a, a.known, walls)]
        counts.append(len(walls))
        near = widened(a.walls, round(WALL_NEAR / a.resolution))
        matches.append(int(np.count_nonzero(at(a, near, walls))))
    return sum(counts) / 2.0, sum(matches) / max(1, sum(counts))
