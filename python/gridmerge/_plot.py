# SPDX-License-Identifier: Apache-2.0
"""Pictures of maps. Only this module needs matplotlib."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._grid import OccupancyGrid
from ._measure import measure_poses, poses_between
from ._transform import Transform

try:
    from matplotlib import pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch
    from matplotlib.transforms import Affine2D
except ImportError as error:
    raise ImportError("plot() needs matplotlib: pip install 'gridmerge[plot]'") from error

if TYPE_CHECKING:
    from ._merge_result import MergeResult
    from ._random_walk import Walk

_WALL = (32, 32, 36)
_TINT = 0.25  # of a map's colour in its free space


def plot_grid(grid: OccupancyGrid, ax: Axes | None) -> Axes:
    axes = _axes(ax)
    _draw(axes, grid, Transform(0.0, 0.0, 0.0), _WALL, tint=0.0)
    _show(axes, [_corners(grid, Transform(0.0, 0.0, 0.0))])
    return axes


def plot_component(result: MergeResult, component: int, ax: Axes | None) -> Axes:
    axes = _axes(ax)
    if not result.components and component == 0:
        axes.set_title("no two maps fit together")
        return axes
    if not 0 <= component < len(result.components):
        raise IndexError(f"component: there is no component {component}")
    handles, corners = [], []
    for member in result.components[component].members:
        colour = _core.map_colour(member.map)
        grid = result.maps[member.map]
        if member.deformation is not None:
            grid = OccupancyGrid._of(_core.bent_map(grid._core, member.deformation._core))
        _draw(axes, grid, member.transform, colour, tint=_TINT)
        corners.append(_corners(grid, member.transform))
        red, green, blue = (value / 255.0 for value in colour)
        handles.append(Patch(color=(red, green, blue), label=_literal(member.name)))
    _show(axes, corners)
    # Beside the maps, which fill the axes.
    axes.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0, fontsize="small"
    )
    axes.set_title(f"{len(handles)} of {len(result.maps)} maps")
    return axes


def plot_walk(
    walk: Walk,
    fixed: OccupancyGrid,
    moving: OccupancyGrid,
    centre: Transform,
    direction: float,
    reach: float,
    count: int,
) -> Figure:
    figure = plt.figure(figsize=(11.0, 7.5), layout="constrained")
    places = figure.subplot_mosaic([["walk"] * 4, ["delta", "psi", "lock", "omega"]])
    _draw_walk(places["walk"], walk)

    dx, dy = reach * math.cos(direction), reach * math.sin(direction)
    first = Transform(centre.x - dx, centre.y - dy, centre.theta)
    last = Transform(centre.x + dx, centre.y + dy, centre.theta)
    landscape = measure_poses(fixed, moving, poses_between(moving, first, last, count))
    way = np.linspace(-reach, reach, count)
    lock = landscape["agreement"] - landscape["disagreement"]
    curves = {
        "delta": (f"Delta, c_lock {walk.c_lock:g}", landscape["psi"] - walk.c_lock * lock),
        "psi": ("psi", landscape["psi"]),
        "lock": ("agr - dis", lock),
        "omega": ("omega", landscape["omega"]),
    }
    measured = landscape["undefined_terms"] < 4
    for place, (title, values) in curves.items():
        places[place].plot(way[measured], values[measured], color="black", linewidth=1.0)
        places[place].axvline(0.0, color="tab:green", linewidth=0.8)
        places[place].set_title(title)
        places[place].set_xlabel("way along the cut [m]")
    return figure


def _draw_walk(axes: Axes, walk: Walk) -> None:
    """Delta by step: refused samples, those that the walk went to, and the best one so far."""
    trace = walk.trace[walk.trace["measured"]]
    for accepted, wide, colour, label in (
        (False, False, "lightgray", "refused"),
        (False, True, "tab:orange", "refused, wide"),
        (True, False, "tab:blue", "accepted"),
        (True, True, "tab:red", "accepted, wide"),
    ):
        chosen = trace[(trace["accepted"] == accepted) & (trace["wide"] == wide)]
        if chosen.size:
            axes.plot(chosen["step"], chosen["delta"], ".", color=colour, markersize=3.0, label=label)
    went = trace[trace["accepted"]]
    steps = np.append(went["step"], walk.proposals)
    best = np.minimum.accumulate(went["delta"])
    axes.step(steps, np.append(best, best[-1]), where="post", color="black", label="best")
    axes.set_xlabel("proposals")
    axes.set_ylabel("Delta")
    axes.legend(loc="upper right", fontsize="small")


def _literal(text: str) -> str:
    """What matplotlib shows as this text: between two dollars it would read a formula."""
    return text.replace("$", r"\$")


def _axes(ax: Axes | None) -> Axes:
    return plt.figure(figsize=(9.0, 6.0), layout="constrained").add_subplot() if ax is None else ax


def _draw(axes: Axes, grid: OccupancyGrid, place: Transform, wall: Sequence[int], tint: float) -> None:
    """Free space see-through, walls above it, each in `wall`'s colour; unknown cells are not drawn."""
    T_frame_grid = place @ grid.origin
    to_frame = Affine2D(T_frame_grid.matrix) + axes.transData
    extent = (0.0, grid.width * grid.resolution, 0.0, grid.height * grid.resolution)
    for kind, alpha, zorder in ((1, tint, 1), (2, 1.0, 2)):
        image = _coloured(grid.cells == kind, wall, alpha)
        if kind == 1 and tint == 0.0:
            image[grid.cells == kind] = (232, 232, 232, 255)
        axes.imshow(
            image, extent=extent, origin="lower", transform=to_frame, interpolation="none", zorder=zorder
        )


def _coloured(mask: NDArray[np.bool_], colour: Sequence[int], alpha: float) -> NDArray[np.uint8]:
    image = np.zeros((*mask.shape, 4), dtype=np.uint8)
    image[mask] = (*colour, round(255 * alpha))
    return image


def _corners(grid: OccupancyGrid, place: Transform) -> NDArray[np.float64]:
    """Of what the map knows, in the frame that `place` takes it to: shape (4, 2) [m]."""
    rows = np.flatnonzero((grid.cells != 0).any(axis=1))
    columns = np.flatnonzero((grid.cells != 0).any(axis=0))
    bottom, top = (rows[0], rows[-1] + 1) if rows.size else (0, grid.height)
    left, right = (columns[0], columns[-1] + 1) if columns.size else (0, grid.width)
    corners = grid.resolution * np.array([[left, bottom], [right, bottom], [left, top], [right, top]])
    return (place @ grid.origin).apply(corners)


def _show(axes: Axes, corners: Sequence[NDArray[np.float64]]) -> None:
    points = np.concatenate(list(corners))
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    margin = 0.03 * max(right - left, top - bottom)
    axes.set_xlim(float(left - margin), float(right + margin))
    axes.set_ylim(float(bottom - margin), float(top + margin))
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
