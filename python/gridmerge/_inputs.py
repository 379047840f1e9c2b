# SPDX-License-Identifier: Apache-2.0
"""Maps as arguments."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterable, Mapping

import numpy as np

from . import _arguments
from ._grid import OccupancyGrid, load


class MapWarning(UserWarning):
    """What a map's file says that its author may not have meant. load() keeps it in the map's `warnings` instead."""


def to_map(name: str, value: object) -> OccupancyGrid:
    """What a MapLike holds. Warnings of files are issued. Errors of what is no map begin with `name`."""
    if isinstance(value, OccupancyGrid):
        return value
    if isinstance(value, (str, os.PathLike)):
        grid = load(value)
        warn(f"{grid.source}: {warning}" for warning in grid.warnings)
        return grid
    if (
        isinstance(value, Mapping)
        or hasattr(value, "info")
        or (hasattr(value, "data") and not hasattr(value, "dtype"))
    ):
        return OccupancyGrid._from_msg(value, name)
    if isinstance(value, np.ndarray):
        raise TypeError(f"{name}: is an array; OccupancyGrid(array, resolution=...) makes a map of it")
    raise TypeError(
        f"{name}: must be an OccupancyGrid, a path, or a message with the fields of nav_msgs/OccupancyGrid, "
        f"is {_arguments.kind_of(value)}"
    )


def to_maps(name: str, values: object) -> list[OccupancyGrid]:
    return [grid for grid, _ in to_maps_and_files(name, values)]


def to_maps_and_files(name: str, values: object) -> list[tuple[OccupancyGrid, bool]]:
    """The maps, and of each whether it was given as a path."""
    if isinstance(values, (str, bytes, os.PathLike, OccupancyGrid, Mapping)) or not isinstance(
        values, Iterable
    ):
        raise TypeError(f"{name}: must be a sequence of maps, is {_arguments.kind_of(values)}")
    return [
        (to_map(f"{name}[{i}]", value), isinstance(value, (str, os.PathLike)))
        for i, value in enumerate(values)
    ]


def warn(messages: Iterable[str], category: type[Warning] = MapWarning) -> None:
    level = _level_of_caller()
    for message in messages:
        warnings.warn(message, category, stacklevel=level)


def _level_of_caller() -> int:
    """warn()'s stack level of the code that called this package."""
    level = 1
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        frame = frame.f_back
        level += 1
    return level
