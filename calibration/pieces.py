# SPDX-License-Identifier: Apache-2.0
"""Maps whose relation is known, and pieces cut out of them: such as share some place, and such as share none."""

import dataclasses
import math
import random

import numpy as np
from grids import UNKNOWN, Grid, Pose, at, centres, compose, cropped, inverse, transformed

OVERLAP_OFF = 0.04  # a piece's overlap may be this far from the wanted one
LEAST_WALLS = 0.03  # share of a piece's known cells
GAP = 3.0  # [m] between what maps know that share no place
SAMPLES = 6000  # known cells of a map that stand for all while windows are tried
TRIES = 300  # windows, before another pair of maps is tried
BENT = ("E5", "HIH")  # domains of maps that are bent


@dataclasses.dataclass(frozen=True)
class Map:
    name: str  # relative to the output
    domain: str
    grid: Grid


@dataclasses.dataclass(frozen=True)
class Relation:
    """Two maps of one building whose poses are known. Any map is related to itself."""

    kind: str
    fixed: Map
    moving: Map
    pose: Pose  # T_fixed_moving
    tolerance: float  # [m]
    tier: str = ""
    marks: tuple = ()  # rows of x, y in the fixed map and x, y in the moving one

    @property
    def domain(self) -> str:
        return self.fixed.domain


@dataclasses.dataclass(frozen=True)
class Window:
    """A rectangle whose length is in direction `angle`, or the disc of this diameter."""

    x: float
    y: float
    angle: float
    length: float
    width: float
    disc: bool

    def holds(self, points: np.ndarray) -> np.ndarray:
        inside = transformed(inverse((self.x, self.y, self.angle)), points) / [
            0.5 * self.length,
            0.5 * self.width,
        ]
        return (inside**2).sum(axis=1) <= 1.0 if self.disc else (np.abs(inside) <= 1.0).all(axis=1)


def sample(points: np.ndarray, dice: random.Random) -> np.ndarray:
    return points[dice.sample(range(len(points)), min(SAMPLES, len(points)))]


def draw_window(points: np.ndarray, longest: float, dice: random.Random) -> Window:
    """Around one of the points."""
    x, y = points[dice.randrange(len(points))]
    length, width = (math.exp(dice.uniform(math.log(7.0), math.log(longest))) for _ in range(2))
    disc = dice.random() < 0.4
    return Window(float(x), float(y), dice.uniform(0.0, math.pi), length, length if disc else width, disc)


def least_area(domain: str) -> float:
    """Of what a piece knows [m^2]."""
    return 100.0 if domain in BENT else 60.0


def piece(whole: Map, window: Window, least: float, name: str) -> Map | None:
    """What the map knows within the window, if this is worth a map: `least` square metres of it, and walls among them.
    `name` is that of the piece within its domain."""
    inside = window.holds(centres(whole.grid, whole.grid.known))
    cells = whole.grid.cells.copy()
    cells[whole.grid.known] = np.where(inside, cells[whole.grid.known], UNKNOWN)
    cut = dataclasses.replace(whole.grid, cells=cells)
    known = int(np.count_nonzero(cut.known))
    if cut.known_area < least or np.count_nonzero(cut.walls) < LEAST_WALLS * known:
        return None
    return Map(f"maps/{whole.domain}/{name}.yaml", whole.domain, cropped(cut))


def marks_agree(relation: Relation, fixed: Window, moving: Window) -> bool:
    """Whether the pose holds for the pieces too: bent maps are laid right as a whole, and less so here and there."""
    marks = np.array(relation.marks).reshape(-1, 4)
    at_fixed, at_moving = marks[:, :2], transformed(relation.pose, marks[:, 2:])
    both = fixed.holds(at_fixed) & moving.holds(at_moving)
    if not both.any():
        return True
    return float(np.mean(((at_fixed - at_moving)[both] ** 2).sum(axis=1))) ** 0.5 <= 0.5 * relation.tolerance


def turned(window: Window, pose: Pose) -> Window:
    x, y, angle = compose(pose, (window.x, window.y, window.angle))
    return dataclasses.replace(window, x=x, y=y, angle=angle)


def cut_pair(relation: Relation, a: Window, b: Window, least: float, name: str) -> tuple[Map, Map] | None:
    """The pieces of the fixed and the moving map within windows in the fixed map's frame."""
    fixed = piece(relation.fixed, a, least, f"{name}_a")
    moving = fixed and piece(relation.moving, turned(b, inverse(relation.pose)), least, f"{name}_b")
    return (fixed, moving) if fixed and moving else None


def cut_overlapping(relation: Relation, wanted: float, name: str, dice: random.Random) -> Relation | None:
    """Pieces of the two maps whose overlap is about the wanted one."""
    fixed, moving, least = relation.fixed.grid, relation.moving.grid, least_area(relation.domain)
    in_fixed = sample(centres(fixed, fixed.known), dice)
    in_moving = transformed(relation.pose, sample(centres(moving, moving.known), dice))
    share_fixed, share_moving = fixed.known_area / len(in_fixed), moving.known_area / len(in_moving)
    shared = at(fixed, fixed.known, in_moving)
    if not shared.any():
        return None
    for _ in range(TRIES):
        a = draw_window(in_moving[shared], 1.2 * max(fixed.cells.shape) * fixed.resolution, dice)
        b = draw_window(in_moving, 1.2 * max(moving.cells.shape) * moving.resolution, dice)
        inside_b = b.holds(in_moving)
        area_a, area_b = (
            share_fixed * np.count_nonzero(a.holds(in_fixed)),
            share_moving * np.count_nonzero(inside_b),
        )
        if min(area_a, area_b) < least:
            continue
        common = share_moving * np.count_nonzero(inside_b & shared & a.holds(in_moving))
        if abs(common / min(area_a, area_b) - wanted) > OVERLAP_OFF or not marks_agree(relation, a, b):
            continue
        pieces = cut_pair(relation, a, b, least, name)
        if pieces:
            # How much wall bent maps share cannot be told at a rigid pose.
            tier = "sensor" if relation.domain in BENT else ""
            return Relation("piece", *pieces, relation.pose, relation.tolerance, tier)
    return None


def squares_of(points: np.ndarray) -> np.ndarray:
    """The lower left corners of the squares of 1 m that hold points."""
    low = np.floor(points.min(axis=0))
    squares = (points - low).astype(np.int64)
    taken = np.zeros(squares.max(axis=0) + 1, bool)
    taken[squares[:, 0], squares[:, 1]] = True
    return np.argwhere(taken) + low


def apart(a: np.ndarray, b: np.ndarray, gap: float) -> bool:
    """Whether no point of the one is within `gap` of a point of the other."""
    a, b = squares_of(a), squares_of(b)
    squares = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2.0 * a @ b.T
    return bool(squares.min() >= (gap + math.sqrt(2.0)) ** 2)


def gap_of(relation: Relation) -> float:
    """Bent maps may lie as far from the truth as the tolerance says."""
    return GAP + (
        relation.tolerance if relation.domain in BENT and relation.fixed is not relation.moving else 0.0
    )


def draw_facing_windows(
    points: np.ndarray, gap: float, longest: float, dice: random.Random
) -> tuple[Window, Window]:
    """One on each side of a strip of width `gap` through one of the points."""
    x, y = points[dice.randrange(len(points))]
    angle = dice.uniform(0.0, 2.0 * math.pi)
    windows = []
    for side in (1.0, -1.0):
        length, width = (math.exp(dice.uniform(math.log(8.0), math.log(longest))) for _ in range(2))
        disc = dice.random() < 0.3
        along, across = side * 0.5 * (gap + length), dice.uniform(-0.25, 0.25) * width
        centre = compose((float(x), float(y), angle), (along, across, 0.0))
        windows.append(Window(*centre, length, length if disc else width, disc))
    return windows[0], windows[1]


def cut_apart(relation: Relation, least: float, name: str, dice: random.Random) -> tuple[Map, Map] | None:
    """Pieces of the two maps, or of the one, that share no place."""
    fixed, moving, gap = relation.fixed.grid, relation.moving.grid, gap_of(relation)
    in_fixed = sample(centres(fixed, fixed.known), dice)
    in_moving = transformed(relation.pose, sample(centres(moving, moving.known), dice))
    longest = 1.5 * max(max(grid.cells.shape) * grid.resolution for grid in (fixed, moving))
    for _ in range(TRIES // 10):
        # Places are compared by squares of 1 m, so there must be more between them.
        a, b = draw_facing_windows(in_fixed, gap + 3.0, longest, dice)
        areas = (
            np.mean(a.holds(in_fixed)) * fixed.known_area,
            np.mean(b.holds(in_moving)) * moving.known_area,
        )
        if min(areas) < least:
            continue
        pieces = cut_pair(relation, a, b, least, name)
        if pieces and places_apart(dataclasses.replace(relation, fixed=pieces[0], moving=pieces[1]), gap):
            return pieces
    return None


def places_apart(relation: Relation, gap: float) -> bool:
    fixed, moving = relation.fixed.grid, relation.moving.grid
    return apart(centres(fixed, fixed.known), transformed(relation.pose, centres(moving, moving.known)), gap)
