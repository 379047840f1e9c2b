# SPDX-License-Identifier: Apache-2.0
"""Maps as the peers beside this file see them, and the error of a pose as `gridmerge evaluate` takes it.

Poses are (x, y, theta): T_fixed_moving in metres and radians of the map frames.
"""

import dataclasses
import math
import pathlib
import re

import numpy as np
from PIL import Image
from poses import Pose, compose

UNKNOWN, FREE, OCCUPIED = 0, 1, 2


@dataclasses.dataclass(frozen=True)
class Map:
    cells: np.ndarray  # UNKNOWN, FREE or OCCUPIED; row 0 at the bottom, so that rows grow with y
    resolution: float  # [m]
    origin: Pose  # of the lower-left corner of the lower-left cell

    def points(self, pixels: np.ndarray) -> np.ndarray:
        """(N, 2) columns and rows, of which whole numbers are the middles of cells, to metres of the map frame."""
        return transformed(self.origin, (np.asarray(pixels, float) + 0.5) * self.resolution)


@dataclasses.dataclass(frozen=True)
class Answer:
    pose: Pose | None  # the best one, whether accepted or not; None: the peer gives none
    accepted: bool
    score: float  # what the acceptance rests on; each peer has its own scale


def transformed(pose: Pose, points: np.ndarray) -> np.ndarray:
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return points @ np.array([[c, s], [-s, c]]) + np.array(pose[:2])


def read_map(path: pathlib.Path) -> Map:
    """A map_server YAML in trinary mode with an image of 8 gray bits."""
    entries = dict(re.findall(r"^(\w+):[ \t]*(.*?)[ \t]*$", path.read_text(), re.MULTILINE))
    if entries.get("mode", "trinary") != "trinary" or entries["negate"] not in ("0", "false"):
        raise ValueError(f"{path}: only trinary maps that are not negated are read here")
    with Image.open(path.parent / entries["image"].strip("'\"")) as image:
        if image.mode != "L":
            raise ValueError(f"{path}: only images of 8 gray bits are read here")
        pixels = np.asarray(image)[::-1]
    grays = np.arange(256)
    occupancy = (255 - grays) / 255.0
    kinds = np.select(
        [
            grays == 205,  # what map savers write for unknown
            occupancy > float(entries["occupied_thresh"]),
            occupancy < float(entries["free_thresh"]),
        ],
        [UNKNOWN, OCCUPIED, FREE],
        UNKNOWN,
    ).astype(np.uint8)
    cells = kinds[pixels]
    x, y, theta = (float(number) for number in entries["origin"].strip("[]").split(","))
    return Map(cells, float(entries["resolution"]), (x, y, theta))


def write_map(path: pathlib.Path, map_: Map) -> None:
    """`path` is the YAML; the image, a PGM, is beside it."""
    image = path.with_suffix(".pgm")
    Image.fromarray(np.array([205, 254, 0], np.uint8)[map_.cells[::-1]]).save(image)
    x, y, theta = map_.origin
    path.write_text(
        f"image: {image.name}\nresolution: {map_.resolution}\norigin: [{x!r}, {y!r}, {theta!r}]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


def coarsened(map_: Map, factor: int) -> Map:
    """Cells of `factor` times the size, occupied where any of theirs is, else free where any is; the frame stays."""
    height, width = map_.cells.shape
    cells = np.pad(map_.cells, ((0, -height % factor), (0, -width % factor)), constant_values=UNKNOWN)
    blocks = cells.reshape(cells.shape[0] // factor, factor, cells.shape[1] // factor, factor)
    return Map(blocks.max(axis=(1, 3)), map_.resolution * factor, map_.origin)  # UNKNOWN < FREE < OCCUPIED


def common_resolution(fixed: Map, moving: Map) -> float:
    if not math.isclose(fixed.resolution, moving.resolution, rel_tol=1e-6):
        raise ValueError("the peers compare maps of one resolution alone")
    return fixed.resolution


class KnownCells:
    """Centroid [m, map frame] and mean square radius [m²] of a map's known cells."""

    def __init__(self, map_: Map):
        rows, columns = np.nonzero(map_.cells != UNKNOWN)
        points = map_.points(np.column_stack([columns, rows]))
        self.centroid = points.mean(axis=0)
        self.mean_square_radius = float(((points - self.centroid) ** 2).sum(axis=1).mean())

    def displacement(self, estimate: Pose, truth: Pose) -> float:
        """Root mean square over the cells of how far the two poses lay them apart [m]."""
        at_estimate, at_truth = (compose(pose, (*self.centroid, 0.0)) for pose in (estimate, truth))
        turned = 2.0 * math.sin(0.5 * (estimate[2] - truth[2])) * math.sqrt(self.mean_square_radius)
        return math.hypot(at_estimate[0] - at_truth[0], at_estimate[1] - at_truth[1], turned)


def rigid_fit(moving: np.ndarray, fixed: np.ndarray) -> Pose:
    """The pose that takes the (N, 2) points `moving` to `fixed` with the least sum of squares
    (Umeyama 1991, no scale)."""
    middle_moving, middle_fixed = moving.mean(axis=0), fixed.mean(axis=0)
    a, b = moving - middle_moving, fixed - middle_fixed
    theta = math.atan2(float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()), float((a * b).sum()))
    x, y = middle_fixed - transformed((0.0, 0.0, theta), middle_moving[None])[0]
    return float(x), float(y), theta
