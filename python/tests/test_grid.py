# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import copy
import gc
import math
import os
import pickle
import sys
import threading
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from numpy.typing import NDArray

VALUES = np.arange(-1, 101, dtype=np.int8)


def random_map(rng: np.random.Generator, values: NDArray[np.int8]) -> NDArray[np.int8]:
    height, width = rng.integers(1, 40, size=2)
    return rng.choice(values, size=(height, width)).astype(np.int8)


@pytest.mark.parametrize("seed", range(50))
def test_values_come_back_as_they_were(seed: int) -> None:
    rng = np.random.default_rng(seed)
    values = VALUES if seed % 2 else np.array([-1, 0, 100], dtype=np.int8)
    data = random_map(rng, values)
    origin = tuple(rng.uniform(-3.0, 3.0, size=3))
    resolution = float(rng.uniform(0.01, 1.0))
    grid = gridmerge.OccupancyGrid(data, resolution, origin)
    assert grid.shape == data.shape
    assert grid.resolution == resolution
    assert tuple(grid.origin) == origin
    again = grid.to_numpy()
    assert again.dtype == np.int8
    np.testing.assert_array_equal(again, data)
    assert gridmerge.OccupancyGrid(again, resolution, origin) == grid


@pytest.mark.parametrize("value", VALUES)
def test_each_value_comes_back_alone(value: int) -> None:
    grid = gridmerge.OccupancyGrid(np.full((1, 1), value, dtype=np.int8), 1.0)
    assert grid.to_numpy()[0, 0] == value


def test_cells_follow_nav2s_thresholds() -> None:
    grid = gridmerge.OccupancyGrid(VALUES.reshape(1, -1), 0.05)
    expected = np.where(VALUES >= 65, 2, np.where(VALUES <= 19, 1, 0))
    expected[0] = 0
    np.testing.assert_array_equal(grid.cells[0], expected)
    assert grid.probability is not None
    assert math.isnan(grid.probability[0, 0])
    np.testing.assert_array_equal(grid.probability[0, 1:], (VALUES[1:] / 100.0).astype(np.float32))


def test_rows_begin_at_the_bottom(tmp_path: Path) -> None:
    data = np.array([[0, 0, 0], [100, -1, -1]], dtype=np.int8)
    gridmerge.save(gridmerge.OccupancyGrid(data, 0.05), tmp_path / "map.yaml")
    picture = (tmp_path / "map.pgm").read_bytes()[-6:]
    assert list(picture) == [0, 205, 205, 254, 254, 254]  # pictures begin at the top


def test_a_loaded_map_and_its_values_are_equal(robots: list[str]) -> None:
    loaded = gridmerge.load(robots[0])
    made = gridmerge.OccupancyGrid(loaded.to_numpy(), loaded.resolution, loaded.origin)
    assert made == loaded
    assert made.probability is None
    assert set(np.unique(loaded.to_numpy())) == {-1, 0, 100}


def test_a_map_in_mode_raw_and_its_values_are_equal(tmp_path: Path) -> None:
    made = gridmerge.OccupancyGrid(random_map(np.random.default_rng(5), VALUES), 0.05, (1.0, 2.0, 0.5))
    gridmerge.save(made, tmp_path / "map.yaml", probabilities=True)
    loaded = gridmerge.load(tmp_path / "map.yaml")
    assert loaded == made
    np.testing.assert_array_equal(loaded.to_numpy(), made.to_numpy())


def test_a_merged_map_and_its_probabilities_are_kept(robots: list[str], tmp_path: Path) -> None:
    merged = gridmerge.merge(robots[:2]).components[0].grid
    gridmerge.save(merged, tmp_path / "map.yaml", probabilities=True)
    loaded = gridmerge.load(tmp_path / "map.yaml")
    np.testing.assert_array_equal(loaded.cells, merged.cells)
    assert loaded.probability is not None and merged.probability is not None
    np.testing.assert_allclose(loaded.probability, merged.probability, atol=0.0101)
    assert loaded.warnings == ()


def test_a_copy_of_what_cannot_be_changed_is_itself(robots: list[str]) -> None:
    grid = gridmerge.load(robots[0])
    assert copy.copy(grid) is grid
    assert copy.deepcopy(grid) is grid


def test_saving_and_loading_keeps_all(tmp_path: Path, team: gridmerge.Simulation) -> None:
    grid = gridmerge.OccupancyGrid(
        random_map(np.random.default_rng(1), np.array([-1, 0, 100], dtype=np.int8)),
        0.1 / 3.0,
        (1e3 / 7.0, -2.0, 3.0),
    )
    gridmerge.save(grid, tmp_path / "map.yaml")
    assert gridmerge.load(tmp_path / "map.yaml") == grid


def test_a_merged_map_gives_its_cells_unless_asked_for_probabilities(team: gridmerge.Simulation) -> None:
    grid = team.maps[0].grid
    assert grid.probability is not None
    values = np.array([-1, 0, 100], dtype=np.int8)
    np.testing.assert_array_equal(grid.to_numpy(), values[grid.cells])
    np.testing.assert_array_equal(grid.to_numpy(probabilities=False), values[grid.cells])
    percentages = grid.to_numpy(probabilities=True)
    known = ~np.isnan(grid.probability)
    assert (percentages[~known] == -1).all()
    np.testing.assert_allclose(percentages[known] / 100.0, grid.probability[known], atol=0.0051)


def strided_variants(data: NDArray[np.int8]) -> dict[str, NDArray[np.int8]]:
    wide = np.zeros((2 * data.shape[0], 3 * data.shape[1]), dtype=np.int8)
    wide[::2, ::3] = data
    read_only = data.copy()
    read_only.flags.writeable = False
    return {
        "Fortran order": np.asfortranarray(data),
        "every other row": wide[::2, ::3],
        "backwards rows": data[::-1].copy()[::-1],
        "backwards both": data[::-1, ::-1].copy()[::-1, ::-1],
        "transposed": data.T.copy().T,
        "read-only": read_only,
        "byte-swapped": data.astype(">i1"),
        "broadcast": np.broadcast_to(data, data.shape),
    }


@pytest.mark.parametrize("kind", strided_variants(np.zeros((2, 2), dtype=np.int8)))
def test_any_strides_will_do(kind: str) -> None:
    data = np.random.default_rng(7).choice(VALUES, size=(11, 17)).astype(np.int8)
    variant = strided_variants(data)[kind]
    np.testing.assert_array_equal(gridmerge.OccupancyGrid(variant, 0.05).to_numpy(), data)


def test_rows_that_repeat_without_memory_of_their_own() -> None:
    data = np.broadcast_to(np.array([0, 100, -1], dtype=np.int8), (4, 3))
    np.testing.assert_array_equal(gridmerge.OccupancyGrid(data, 0.05).to_numpy(), data)


def test_a_grid_does_not_change_with_its_array() -> None:
    data = np.zeros((3, 3), dtype=np.int8)
    grid = gridmerge.OccupancyGrid(data, 0.05)
    data[:] = 100
    assert (grid.to_numpy() == 0).all()
    grid.to_numpy()[:] = 50
    assert (grid.to_numpy() == 0).all()


def test_views_are_not_copies_and_cannot_be_written() -> None:
    grid = gridmerge.OccupancyGrid(VALUES.reshape(2, 51), 0.05)
    assert grid.probability is not None and grid.probability is not None
    for first, second in ((grid.cells, grid.cells), (grid.probability, grid.probability)):
        assert first.__array_interface__["data"][0] == second.__array_interface__["data"][0]
        assert not first.flags.writeable
        with pytest.raises(ValueError):
            first[0, 0] = 1
        with pytest.raises(ValueError):
            first.flags.writeable = True


def test_views_outlive_their_grid() -> None:
    data = np.random.default_rng(2).choice(VALUES, size=(600, 700)).astype(np.int8)
    grid = gridmerge.OccupancyGrid(data, 0.05)
    cells, probability = grid.cells, grid.probability
    expected = cells.copy()
    del grid
    gc.collect()
    for _ in range(20):  # what was freed would be taken again
        gridmerge.OccupancyGrid(np.full((600, 700), 50, dtype=np.int8), 0.05)
    np.testing.assert_array_equal(cells, expected)
    assert probability is not None
    np.testing.assert_array_equal(np.isnan(probability), data == -1)


def test_merged_grids_and_views_outlive_the_result(robots: list[str]) -> None:
    result = gridmerge.merge(robots)
    cells = result.components[0].grid.cells
    expected = cells.copy()
    del result
    gc.collect()
    again = gridmerge.merge(robots)
    np.testing.assert_array_equal(cells, expected)
    np.testing.assert_array_equal(again.components[0].grid.cells, expected)


def test_arrays_are_not_kept() -> None:
    data = np.zeros((5, 5), dtype=np.int8)
    before = sys.getrefcount(data)
    grids = [gridmerge.OccupancyGrid(data, 0.05) for _ in range(10)]
    assert sys.getrefcount(data) == before
    assert len(grids) == 10


def test_grids_of_cells(team: gridmerge.Simulation) -> None:
    grid = team.maps[0].grid
    same = gridmerge.OccupancyGrid.from_cells(grid.cells, grid.resolution, grid.origin, grid.probability)
    assert same == grid
    assert gridmerge.OccupancyGrid.from_cells(grid.cells, grid.resolution, grid.origin) != grid


def test_grids_can_be_pickled(team: gridmerge.Simulation, robots: list[str]) -> None:
    for grid in (team.maps[0].grid, gridmerge.load(robots[0])):
        again = pickle.loads(pickle.dumps(grid))
        assert again == grid
        assert again.source == grid.source


def test_copies_know_what_the_file_said(tmp_path: Path) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5 2 1 255\n" + bytes([205, 0]))
    name = os.fsdecode(b"odd\xff.yaml")
    (tmp_path / name).write_text("image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
                                 "occupied_thresh: 0.65\nfree_thresh: 0.25\n")  # fmt: skip
    grid = gridmerge.load(tmp_path / name)
    assert grid.warnings
    for again in (pickle.loads(pickle.dumps(grid)), copy.copy(grid), copy.deepcopy(grid)):
        assert again == grid
        assert (again.source, again.warnings) == (grid.source, grid.warnings)


def test_what_is_checked_is_what_is_used() -> None:
    data = np.full((2000, 2000), 50, dtype=np.int8)
    done = threading.Event()

    def spoil() -> None:
        while not done.is_set():
            data[1000:] = 120
            data[1000:] = 50

    other = threading.Thread(target=spoil)
    other.start()
    try:
        for _ in range(100):
            try:
                grid = gridmerge.OccupancyGrid(data, 0.05)
            except ValueError:
                continue
            assert grid.probability is not None and (grid.probability == 0.5).all()
    finally:
        done.set()
        other.join()


def test_equality_looks_at_everything() -> None:
    data = np.array([[0, 100], [-1, 50]], dtype=np.int8)
    grid = gridmerge.OccupancyGrid(data, 0.05, (1.0, 2.0, 0.3))
    assert grid == gridmerge.OccupancyGrid(data, 0.05, (1.0, 2.0, 0.3))
    others = [
        gridmerge.OccupancyGrid(data.T, 0.05, (1.0, 2.0, 0.3)),
        gridmerge.OccupancyGrid(data.reshape(1, 4), 0.05, (1.0, 2.0, 0.3)),
        gridmerge.OccupancyGrid(data, 0.06, (1.0, 2.0, 0.3)),
        gridmerge.OccupancyGrid(data, 0.05, (1.0, 2.0, 0.4)),
        gridmerge.OccupancyGrid(np.where(data == 50, 51, data).astype(np.int8), 0.05, (1.0, 2.0, 0.3)),
        "a map",
    ]
    assert all(grid != other for other in others)
    with pytest.raises(TypeError):
        hash(grid)


def test_origins_in_every_form() -> None:
    data = np.zeros((2, 2), dtype=np.int8)
    pose = gridmerge.Transform(1.0, -2.0, 0.25)
    for origin in (pose, (1.0, -2.0, 0.25), [1.0, -2.0, 0.25], np.array([1.0, -2.0, 0.25]), pose.matrix):
        grid = gridmerge.OccupancyGrid(data, 0.05, origin)
        np.testing.assert_allclose(list(grid.origin), [1.0, -2.0, 0.25], atol=1e-15)
