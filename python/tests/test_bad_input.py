# SPDX-License-Identifier: Apache-2.0
"""Whatever is wrong with an argument is said with its name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest

GOOD = np.zeros((3, 4), dtype=np.int8)
NAN, INFINITY = float("nan"), float("inf")


def one_wrong(value: int) -> Any:
    data = np.zeros((3, 4), dtype=np.int8)
    data[2, 1] = value
    return data


DATA = [
    (TypeError, np.zeros((3, 4))),
    (TypeError, np.full((3, 4), NAN)),
    (TypeError, np.zeros((3, 4), dtype=np.uint8)),
    (TypeError, np.zeros((3, 4), dtype=np.int16)),
    (TypeError, np.zeros((3, 4), dtype=bool)),
    (TypeError, np.zeros((3, 4), dtype=object)),
    (TypeError, np.zeros((3, 4), dtype="S1")),
    (TypeError, np.zeros((3, 4), dtype=[("a", np.int8)])),
    (TypeError, np.ma.masked_array(GOOD, mask=True)),
    (TypeError, [[0, 1], [2, 3]]),
    (TypeError, b"\0\0"),
    (TypeError, "map.yaml"),
    (TypeError, None),
    (TypeError, np.int8(3)),
    (ValueError, np.zeros(12, dtype=np.int8)),
    (ValueError, np.zeros((), dtype=np.int8)),
    (ValueError, np.zeros((3, 4, 1), dtype=np.int8)),
    (ValueError, np.zeros((0, 4), dtype=np.int8)),
    (ValueError, np.zeros((3, 0), dtype=np.int8)),
    (ValueError, np.broadcast_to(np.int8(0), (2**20, 2**20))),
    (ValueError, one_wrong(101)),
    (ValueError, one_wrong(-2)),
    (ValueError, one_wrong(-128)),
    (ValueError, one_wrong(127)),
]


@pytest.mark.parametrize(("error", "data"), DATA)
def test_data(error: type[Exception], data: Any) -> None:
    with pytest.raises(error, match=r"^data: "):
        gridmerge.OccupancyGrid(data, 0.05)


def test_data_tells_where_the_wrong_value_is() -> None:
    with pytest.raises(ValueError, match=r"^data: the value 101 in row 2, column 1 "):
        gridmerge.OccupancyGrid(one_wrong(101), 0.05)


RESOLUTIONS = [
    (ValueError, 0.0),
    (ValueError, -0.05),
    (ValueError, NAN),
    (ValueError, INFINITY),
    (ValueError, 1e-300),
    (ValueError, 1e300),
    (ValueError, 10**400),
    (TypeError, "0.05"),
    (TypeError, None),
    (TypeError, True),
    (TypeError, 1j),
    (TypeError, [0.05]),
    (TypeError, np.array([0.05])),
]


@pytest.mark.parametrize(("error", "resolution"), RESOLUTIONS)
def test_resolution(error: type[Exception], resolution: Any) -> None:
    with pytest.raises(error, match=r"^resolution: "):
        gridmerge.OccupancyGrid(GOOD, resolution)


ORIGINS = [
    (ValueError, (NAN, 0.0, 0.0)),
    (ValueError, (0.0, INFINITY, 0.0)),
    (ValueError, (0.0, 0.0, NAN)),
    (ValueError, (1e12, 0.0, 0.0)),
    (ValueError, np.full((3, 3), NAN)),
    (ValueError, np.zeros((3, 3))),
    (ValueError, 2.0 * np.eye(3)),
    (ValueError, np.diag([1.0, -1.0, 1.0])),
    (ValueError, np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 1.0]])),
    (ValueError, np.eye(4)),
    (TypeError, np.eye(3, dtype=complex)),
    (TypeError, (0.0, 0.0)),
    (TypeError, (0.0, 0.0, 0.0, 1.0)),
    (TypeError, ("a", "b", "c")),
    (TypeError, "abc"),
    (TypeError, 0.0),
    (TypeError, None),
    (TypeError, (0.0, 0.0, True)),
    (TypeError, {"x": 0, "y": 0, "theta": 0}),
]


@pytest.mark.parametrize(("error", "origin"), ORIGINS)
def test_origin(error: type[Exception], origin: Any) -> None:
    with pytest.raises(error, match=r"^origin(\.\w+)?: "):
        gridmerge.OccupancyGrid(GOOD, 0.05, origin)


CELLS: list[tuple[type[Exception], str, Any, Any]] = [
    (TypeError, "cells", GOOD, None),
    (ValueError, "cells", np.full((2, 2), 3, dtype=np.uint8), None),
    (ValueError, "probability", np.zeros((2, 2), dtype=np.uint8), np.zeros((2, 3), dtype=np.float32)),
    (ValueError, "probability", np.zeros((2, 2), dtype=np.uint8), np.full((2, 2), 1.5, dtype=np.float32)),
    (
        ValueError,
        "probability",
        np.zeros((2, 2), dtype=np.uint8),
        np.full((2, 2), -INFINITY, dtype=np.float32),
    ),
    (TypeError, "probability", np.zeros((2, 2), dtype=np.uint8), np.zeros((2, 2))),
]


@pytest.mark.parametrize(("error", "name", "cells", "probability"), CELLS)
def test_cells(error: type[Exception], name: str, cells: Any, probability: Any) -> None:
    with pytest.raises(error, match=f"^{name}: "):
        gridmerge.OccupancyGrid.from_cells(cells, 0.05, probability=probability)


GRID = gridmerge.OccupancyGrid(GOOD, 0.05)
Call = Callable[[], object]


def call(function: Any, *arguments: Any, **options: Any) -> Call:
    return lambda: function(*arguments, **options)


def sure(**deviations: float) -> gridmerge.InitialPose:
    return gridmerge.InitialPose((0.0, 0.0, 0.0), **deviations)


ARGUMENTS: list[tuple[type[Exception], str, Call]] = [
    (TypeError, "fixed", call(gridmerge.match, 3, GRID)),
    (TypeError, "fixed", call(gridmerge.match, None, GRID)),
    (TypeError, "moving", call(gridmerge.match, GRID, GOOD)),
    (TypeError, "moving", call(gridmerge.match, GRID, [GRID])),
    (ValueError, "path", call(gridmerge.match, "", GRID)),
    (ValueError, "path", call(gridmerge.load, "a\0b.yaml")),
    (TypeError, "path", call(gridmerge.load, 3)),
    (TypeError, "path", call(gridmerge.load, b"map.yaml")),
    (ValueError, "resolution", call(gridmerge.load, "map.pgm", 0.0)),
    (ValueError, "resolution", call(gridmerge.load, "map.pgm", NAN)),
    (TypeError, "grid", call(gridmerge.save, GOOD, "map.yaml")),
    (TypeError, "path", call(gridmerge.save, GRID, None)),
    (TypeError, "threads", call(gridmerge.match, GRID, GRID, threads=1.5)),
    (ValueError, "threads", call(gridmerge.match, GRID, GRID, threads=-1)),
    (ValueError, "threads", call(gridmerge.match, GRID, GRID, threads=2**70)),
    (ValueError, "accept", call(gridmerge.match, GRID, GRID, accept=1.5)),
    (ValueError, "accept", call(gridmerge.match, GRID, GRID, accept=NAN)),
    (TypeError, "accept", call(gridmerge.match, GRID, GRID, accept="0.8")),
    (ValueError, "max_hypotheses", call(gridmerge.match, GRID, GRID, max_hypotheses=-1)),
    (TypeError, "progress", call(gridmerge.match, GRID, GRID, progress=3)),
    (TypeError, "fixed", call(gridmerge.measure, 3, GRID, (0, 0, 0))),
    (TypeError, "pose", call(gridmerge.measure, GRID, GRID, (0, 0))),
    (ValueError, "pose.theta", call(gridmerge.measure, GRID, GRID, (0, 0, NAN))),
    (TypeError, "threads", call(gridmerge.measure, GRID, GRID, (0, 0, 0), threads=1.5)),
    (TypeError, "c_lock", call(gridmerge.measure(GRID, GRID, (0, 0, 0)).delta, "7.5")),
    (ValueError, "c_lock", call(gridmerge.measure(GRID, GRID, (0, 0, 0)).delta, -1.0)),
    (TypeError, "moving", call(gridmerge.measure_maps, GRID, GRID, [(0, 0, 0)])),
    (ValueError, "moving", call(gridmerge.measure_maps, GRID, [], [])),
    (ValueError, "poses", call(gridmerge.measure_maps, GRID, [GRID], [])),
    (TypeError, "poses", call(gridmerge.count_equal_cells, GRID, [GRID], gridmerge.Transform(0, 0, 0))),
    (TypeError, r"poses\[1\]", call(gridmerge.measure_poses, GRID, GRID, [(0, 0, 0), 3])),
    (TypeError, "pose", call(gridmerge.draw_on_lattice, GRID, GRID, "abc")),
    (ValueError, "value", call(gridmerge.distance_map, GRID, "wall")),
    (ValueError, "after", call(gridmerge.distance_map, GRID, after="third")),
    (ValueError, "count", call(gridmerge.poses_between, GRID, (0, 0, 0), (1, 0, 0), 1)),
    (TypeError, "c_locks", call(gridmerge.match_by_random_walk, GRID, GRID, c_locks=7.5)),
    (ValueError, "c_locks", call(gridmerge.match_by_random_walk, GRID, GRID, c_locks=[])),
    (ValueError, r"c_locks\[1\]", call(gridmerge.match_by_random_walk, GRID, GRID, c_locks=[0.0, -1.0])),
    (ValueError, "restarts", call(gridmerge.match_by_random_walk, GRID, GRID, restarts=0)),
    (TypeError, "start", call(gridmerge.match_by_random_walk, GRID, GRID, start=(0, 0))),
    (TypeError, "starts", call(gridmerge.match_by_random_walk, GRID, GRID, starts=(72, 1))),
    (ValueError, r"starts\[0\]", call(gridmerge.match_by_random_walk, GRID, GRID, starts=(0, 1, 100.0))),
    (ValueError, r"starts\[1\]", call(gridmerge.match_by_random_walk, GRID, GRID, starts=(72, -1, 100.0))),
    (ValueError, r"starts\[2\]", call(gridmerge.match_by_random_walk, GRID, GRID, starts=(72, 1, NAN))),
    (ValueError, "wide_share", call(gridmerge.match_by_random_walk, GRID, GRID, wide_share=1.5)),
    (ValueError, "cooling", call(gridmerge.match_by_random_walk, GRID, GRID, cooling=0.0)),
    (ValueError, "memory", call(gridmerge.match_by_random_walk, GRID, GRID, memory=3)),
    (TypeError, "patience", call(gridmerge.match_by_random_walk, GRID, GRID, patience=1.5)),
    (ValueError, "seed", call(gridmerge.match_by_random_walk, GRID, GRID, seed=-1)),
    (ValueError, "trace", call(gridmerge.match_by_random_walk, GRID, GRID, trace="every")),
    (TypeError, "walk", call(gridmerge.plot_walk, 3, GRID, GRID)),
    (TypeError, "maps", call(gridmerge.merge, "map.yaml")),
    (TypeError, "maps", call(gridmerge.merge, GRID)),
    (TypeError, "maps", call(gridmerge.merge, None)),
    (TypeError, r"maps\[1\]", call(gridmerge.merge, [GRID, 3])),
    (ValueError, "names", call(gridmerge.merge, [GRID, GRID], names=["a"])),
    (TypeError, "names", call(gridmerge.merge, [GRID, GRID], names="ab")),
    (TypeError, r"names\[1\]", call(gridmerge.merge, [GRID, GRID], names=["a", 2])),
    (ValueError, "strategy", call(gridmerge.merge, [GRID, GRID], strategy="best")),
    (ValueError, "strategy", call(gridmerge.merge, [GRID, GRID], strategy="tree", fix=0)),
    (ValueError, "output_resolution", call(gridmerge.merge, [GRID, GRID], output_resolution=0.0)),
    (TypeError, "init", call(gridmerge.merge, [GRID, GRID], init=3)),
    (ValueError, "init", call(gridmerge.merge, [GRID, GRID], init={5: (0, 0, 0)})),
    (ValueError, "init", call(gridmerge.merge, [GRID, GRID], init={"other": (0, 0, 0)})),
    (TypeError, r"init\[0\]", call(gridmerge.merge, [GRID, GRID], init={0: (0, 0)})),
    (ValueError, r"init\[0\].theta", call(gridmerge.merge, [GRID, GRID], init={0: (0, 0, NAN)})),
    (ValueError, "fix", call(gridmerge.merge, [GRID, GRID], fix=2)),
    (ValueError, "fix", call(gridmerge.merge, [GRID, GRID], fix=[0, 1])),
    (TypeError, "fix", call(gridmerge.merge, [GRID, GRID], fix=1.0)),
    (TypeError, "fix", call(gridmerge.merge, [GRID, GRID], fix=True)),
    (TypeError, "fix", call(gridmerge.merge, [GRID, GRID], fix=[False])),
    (TypeError, "fix", call(gridmerge.merge, [GRID, GRID], fix=b"map 0")),
    (TypeError, "init", call(gridmerge.merge, [GRID, GRID], init={True: (0, 0, 0)})),
    (ValueError, r"init\[0\]", call(gridmerge.merge, [GRID, GRID], init={0: (1e8, 0, 0)})),
    (ValueError, r"init\[1\]", call(gridmerge.merge, [GRID, GRID], init={1: sure(sd=0.0)})),
    (ValueError, r"init\[1\]", call(gridmerge.merge, [GRID, GRID], init={1: sure(sd_theta=-1.0)})),
    (ValueError, "pose", call(gridmerge.Merger().add, GRID, pose=sure(sd=0.0))),
    (ValueError, "pose", call(gridmerge.Merger().add, GRID, pose=(0, -1e8, 0), fixed=True)),
    (ValueError, r"names\[0\]", call(gridmerge.merge, [GRID, GRID], names=["\ud800", "b"])),
    (ValueError, "name", call(gridmerge.Merger().add, GRID, name="\ud800")),
    (TypeError, "name", call(gridmerge.Merger().add, GRID, name=3)),
    (ValueError, r"names\[1\]", call(gridmerge.merge, [GRID, GRID], names=["a", ""])),
    (ValueError, r"names\[0\]", call(gridmerge.merge, [GRID, GRID], names=["a\0", "b"])),
    (ValueError, "name", call(gridmerge.Merger().add, GRID, name="")),
    (ValueError, "robot", call(gridmerge.Team().hear, "", GRID)),
    (ValueError, "robot", call(gridmerge.Team().hear, "\ud800", GRID)),
    (ValueError, "robot", call(gridmerge.Team().forget, "\0")),
    (ValueError, "fixed", call(gridmerge.Team().set_known_pose, "a", None, fixed=True)),
    (TypeError, "map_id", call(gridmerge.Merger().remove, [])),
    (TypeError, "map_id", call(gridmerge.Merger().update, "0", GRID)),
    (
        ValueError,
        "cells",
        call(gridmerge.OccupancyGrid.from_cells, np.broadcast_to(np.uint8(0), (2**15, 2**14)), 0.05),
    ),
    (ValueError, "kind", call(gridmerge.simulate, "castle")),
    (TypeError, "kind", call(gridmerge.simulate, 3)),
    (TypeError, "size", call(gridmerge.simulate, size=40)),
    (TypeError, "size", call(gridmerge.simulate, size=(1, 2, 3))),
    (ValueError, "size", call(gridmerge.simulate, size=(NAN, 2))),
    (ValueError, "robots", call(gridmerge.simulate, robots=0)),
    (ValueError, "overlap", call(gridmerge.simulate, overlap=2.0)),
    (TypeError, r"starts\[0\]", call(gridmerge.simulate, starts=[3.0])),
    (TypeError, "starts", call(gridmerge.simulate, starts=3.0)),
    (TypeError, "size", call(gridmerge.simulate, size=np.array(3.0))),
    (TypeError, "starts", call(gridmerge.simulate, starts=np.array(3.0))),
    (TypeError, "headings", call(gridmerge.simulate, headings=np.array(3.0))),
    (TypeError, r"headings\[0\]", call(gridmerge.simulate, headings=["east"])),
    (TypeError, "headings", call(gridmerge.simulate, headings=3.0)),
    (ValueError, "seed", call(gridmerge.simulate, seed=-1)),
    (ValueError, "noise", call(gridmerge.simulate, noise=-1.0)),
    (ValueError, "others", call(gridmerge.simulate, others=-1)),
    (ValueError, "pairs, negatives, sets", call(gridmerge.evaluate)),
    (TypeError, "pairs", call(gridmerge.evaluate, 3)),
    (TypeError, "probabilities", call(GRID.to_numpy, probabilities=1)),
    (ValueError, "probabilities", call(GRID.to_numpy, probabilities=True)),
    (TypeError, "x", call(gridmerge.Transform, "1", 0.0, 0.0)),
    (ValueError, "theta", call(gridmerge.Transform, 0.0, 0.0, NAN)),
    (TypeError, "origin", call(gridmerge.OccupancyGrid, GOOD, 0.05, np.array(0.0))),
    (ValueError, "origin", call(gridmerge.OccupancyGrid, GOOD, 0.05, [[1, 0, 0], [0, 1], [0, 0, 1]])),
    (TypeError, "pose", call(gridmerge.Merger().add, GRID, pose=np.array(0.0))),
    (TypeError, "transform", call(gridmerge.InitialPose, "here")),
    (TypeError, "poses", call(gridmerge.measure_poses, GRID, GRID, 5)),
    (TypeError, "poses", call(gridmerge.measure_poses, GRID, GRID, np.array(5.0))),
    (ValueError, "path", call(gridmerge.load, "\ud800.yaml")),
    (ValueError, "path", call(gridmerge.save, GRID, "\ud800.yaml")),
    (ValueError, "threads", call(gridmerge.match, GRID, GRID, threads=10**5000)),
    (ValueError, "resolution", call(gridmerge.OccupancyGrid, GOOD, 10**5000)),
    (ValueError, "shifts", call(gridmerge.Deformation, (0, 0, 0), 1.0, "abc")),
    (ValueError, "points", call(gridmerge.Transform(0.0, 0.0, 0.0).apply, "abc")),
    (ValueError, "matrix", call(gridmerge.Transform.from_matrix, [[1, 0], [0]])),
    (ValueError, "points", call(gridmerge.Transform(0.0, 0.0, 0.0).apply, [1.0, 2.0, 3.0])),
]


@pytest.mark.parametrize(("error", "name", "made"), ARGUMENTS)
def test_arguments(error: type[Exception], name: str, made: Call) -> None:
    with pytest.raises(error, match=f"^{name}: "):
        made()


def test_simulate_passes_on_what_the_engine_says() -> None:
    with pytest.raises(ValueError, match="an overlap takes two robots"):
        gridmerge.simulate(robots=1, overlap=0.5)


def test_maps_too_far_apart_to_merge(tmp_path: Path) -> None:
    cells = np.zeros((3, 3), dtype=np.int8)
    grid = gridmerge.OccupancyGrid(cells, 0.05)
    poses = {0: (0.0, 0.0, 0.0), 1: (9e6, 9e6, 0.0)}
    with pytest.raises(ValueError, match="2\\^28|cells"):
        gridmerge.merge([grid, grid], init=poses, fix=[0, 1])


@pytest.mark.filterwarnings("ignore:nanobind. attempted to access an uninitialized instance")
def test_an_uninitialised_core_object_is_no_crash() -> None:
    from gridmerge import _core

    with pytest.raises(TypeError):
        _core.Grid()
    empty = _core.Grid.__new__(_core.Grid)
    with pytest.raises(TypeError):
        _core.match(empty, empty, 0, 0.8, 10, "quick", None, None)


def test_an_array_that_is_no_map_names_the_remedy() -> None:
    with pytest.raises(TypeError, match=r"; data\.astype\(np\.int8\) converts it"):
        gridmerge.OccupancyGrid(np.zeros((3, 4)), 0.05)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"fixed: is an array; OccupancyGrid\(array, resolution=\.\.\.\)"):
        gridmerge.match(GOOD, GOOD)  # type: ignore[arg-type]
