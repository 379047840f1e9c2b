# SPDX-License-Identifier: Apache-2.0
"""Pictures of two maps laid on each other, for the scripts beside this file."""

import base64
import dataclasses
import io
import math
import pathlib
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "calibration"))
from grids import WALL_NEAR, Grid, Pose, at, centres, inverse, transformed, widened

LONGEST = 1100  # pixels of a picture's longer side
MARGIN = 1.0  # [m] around the maps
LEAST_SIDE = 12.0  # [m]
# Neither knows, the fixed map knows, the moving one, both; walls of the fixed, of the moving, and where they meet.
PALETTE = ["#ffffff", "#e3eefb", "#fdeedd", "#dcdce4", "#1f63c4", "#e2570b", "#1d1d22"]


@dataclasses.dataclass(frozen=True)
class View:
    """A picture's place in the fixed map's frame: its middle, how it is turned, and its sides [m]."""

    x: float
    y: float
    angle: float
    width: float
    height: float
    scale: float  # pixels per metre

    @property
    def size(self) -> tuple[int, int]:
        return max(1, round(self.width * self.scale)), max(1, round(self.height * self.scale))

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """Columns and rows; rows grow downwards."""
        local = transformed(inverse((self.x, self.y, self.angle)), points)
        return np.floor((local * [1, -1] + [0.5 * self.width, 0.5 * self.height]) * self.scale).astype(
            np.int64
        )

    def points(self) -> np.ndarray:
        """The pixels' middles, row by row."""
        columns, rows = self.size
        x, y = np.meshgrid(
            (np.arange(columns) + 0.5) / self.scale - 0.5 * self.width,
            0.5 * self.height - (np.arange(rows) + 0.5) / self.scale,
        )
        return transformed((self.x, self.y, self.angle), np.column_stack([x.ravel(), y.ravel()]))


def main_direction(walls: np.ndarray, points: np.ndarray) -> float:
    """In which most walls run, to a degree, and in which the points reach farther: so pictures are upright and wide."""

    def straightness(angle: float) -> float:
        local = np.floor(transformed((0.0, 0.0, -angle), walls) / 0.2).astype(np.int64)
        return float(sum((np.bincount(along - along.min()).astype(float) ** 2).sum() for along in local.T))

    angle = max((math.radians(degrees) for degrees in range(90)), key=straightness)
    width, height = np.ptp(transformed((0.0, 0.0, -angle), points), axis=0)
    return angle if width >= height else angle + math.pi / 2


def view_of(points: np.ndarray, angle: float, resolution: float) -> View:
    """Holds all the points."""
    local = transformed((0.0, 0.0, -angle), points)
    low, high = local.min(axis=0) - MARGIN, local.max(axis=0) + MARGIN
    width, height = (max(LEAST_SIDE, float(side)) for side in high - low)
    x, y = transformed((0.0, 0.0, angle), 0.5 * (low + high)[None])[0]
    return View(float(x), float(y), angle, width, height, min(LONGEST / max(width, height), 2.0 / resolution))


def layer_in(view: View, grid: Grid, layer: np.ndarray, pose: Pose, points: np.ndarray) -> np.ndarray:
    """A layer of a map at `pose` as pixels. A cell that is smaller than a pixel still shows."""
    columns, rows = view.size
    picture = at(grid, layer, transformed(inverse(pose), points)).reshape(rows, columns)
    cells = view.pixels(transformed(pose, centres(grid, layer)))
    cells = cells[((cells >= 0) & (cells < [columns, rows])).all(axis=1)]
    picture[cells[:, 1], cells[:, 0]] = True
    return picture


def picture(view: View, fixed: Grid, moving: Grid, T_fixed_moving: Pose) -> Image.Image:
    points, here = view.points(), (0.0, 0.0, 0.0)
    known = [
        layer_in(view, grid, grid.known, pose, points)
        for grid, pose in ((fixed, here), (moving, T_fixed_moving))
    ]
    walls = [
        layer_in(view, grid, grid.walls, pose, points)
        for grid, pose in ((fixed, here), (moving, T_fixed_moving))
    ]
    colours = known[0] + 2 * known[1].astype(np.uint8)
    near = max(1, round(WALL_NEAR * view.scale))
    met = (walls[0] & widened(walls[1], near)) | (walls[1] & widened(walls[0], near))
    colours[walls[0]], colours[walls[1]], colours[met] = 4, 5, 6
    image = Image.fromarray(colours.astype(np.uint8), mode="P")
    image.putpalette([int(colour[i : i + 2], 16) for colour in PALETTE for i in (1, 3, 5)])
    return image


def common_points(fixed: Grid, moving: Grid, T_fixed_moving: Pose) -> np.ndarray:
    points = transformed(T_fixed_moving, centres(moving, moving.known))
    return points[at(fixed, fixed.known, points)]


def all_points(fixed: Grid, moving: Grid, T_fixed_moving: Pose) -> np.ndarray:
    return np.vstack(
        [centres(fixed, fixed.known), transformed(T_fixed_moving, centres(moving, moving.known))]
    )


def scale_bar(view: View) -> float:
    """A round length of about a sixth of the picture's width [m]."""
    return max((length for length in (1, 2, 5, 10, 20, 50) if length <= view.width / 5), default=1)


def data_uri(image: Image.Image) -> str:
    data = io.BytesIO()
    image.save(data, "PNG", optimize=True, bits=4)
    return "data:image/png;base64," + base64.b64encode(data.getvalue()).decode()
