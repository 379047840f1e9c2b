# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import Cli, pose_of, to_bits

POSE = (-6.8, -21.9, 1.44)


def as_json(measure: gridmerge.PoseMeasure, c_lock: float) -> dict[str, Any]:
    """What the command line writes, but for names."""
    terms, common = measure.psi_terms, measure.common
    return {
        "transform": pose_of(measure.transform),
        "omega": measure.omega,
        "cells": measure.cells,
        "psi": measure.psi,
        "psi_terms": {
            "fixed_moving_occupied": terms.fixed_moving_occupied,
            "fixed_moving_free": terms.fixed_moving_free,
            "moving_fixed_occupied": terms.moving_fixed_occupied,
            "moving_fixed_free": terms.moving_fixed_free,
        },
        "agreement": measure.agreement,
        "disagreement": measure.disagreement,
        "delta": measure.delta(c_lock),
        "c_lock": c_lock,
        "acceptance_index": measure.acceptance_index,
        "common": {
            "occupied_occupied": common.occupied_occupied,
            "free_free": common.free_free,
            "contradicting": common.contradicting,
        },
        "engine": {"probability": measure.probability, "figures": dict(measure.figures)},
    }


def ask(cli: Cli, *arguments: object) -> dict[str, Any]:
    answer = json.loads(cli("measure", "--json", *arguments).stdout)
    assert isinstance(answer, dict)
    return {key: value for key, value in answer.items() if key not in ("fixed", "moving")}


def test_results_equal_the_command_lines_to_the_bit(cli: Cli, robots: list[str]) -> None:
    pose = ",".join(map(str, POSE))
    expected = ask(cli, *robots[:2], "--pose", pose, "--c-lock", 7.5)
    assert to_bits(as_json(gridmerge.measure(robots[0], robots[1], POSE), 7.5)) == to_bits(expected)


def test_omega_of_several_maps_is_the_command_lines(cli: Cli, robots: list[str]) -> None:
    poses = [POSE, (1.0, 2.0, 0.5)]
    texts = [text for pose in poses for text in ("--pose", ",".join(map(str, pose)))]
    joint = gridmerge.measure_maps(robots[0], robots[1:], poses)
    assert joint.omega == ask(cli, *robots, *texts)["omega"]
    assert joint.omega == gridmerge.count_equal_cells(robots[0], robots, [(0, 0, 0), *poses])
    assert len(joint.pairs) == 2


def test_a_map_on_itself_is_all_equal() -> None:
    grid = gridmerge.OccupancyGrid(np.array([[0, 100, -1], [0, 0, 100]], dtype=np.int8), 0.1)
    found = gridmerge.measure(grid, grid, (0, 0, 0))
    assert (found.omega, found.cells, found.psi, found.acceptance_index) == (6, 6, 0.0, 1.0)
    assert found.common == gridmerge.CommonCells(2, 3, 0)
    assert found.delta(2.0) == -10.0


def test_terms_without_cells_are_none() -> None:
    grid = gridmerge.OccupancyGrid(np.zeros((4, 4), dtype=np.int8), 0.1)
    terms = gridmerge.measure(grid, grid, (0, 0, 0)).psi_terms
    assert terms == gridmerge.PsiTerms(None, 0.0, None, 0.0)


def test_drawing_on_a_lattice_is_the_nearest_cell() -> None:
    grid = gridmerge.OccupancyGrid(np.array([[0, 100, -1], [0, 0, 100]], dtype=np.int8), 0.1)
    lattice = gridmerge.OccupancyGrid(np.full((3, 4), -1, dtype=np.int8), 0.1)
    drawn = gridmerge.draw_on_lattice(lattice, grid, (0.1, 0.1, 0.0))
    expected = np.zeros((3, 4), dtype=np.uint8)
    expected[1:, 1:] = grid.cells
    np.testing.assert_array_equal(drawn.cells, expected)


def test_distance_maps_are_manhattan_distances_from_pass_to_pass() -> None:
    data = np.full((3, 3), -1, dtype=np.int8)
    data[1, 1] = 100
    grid = gridmerge.OccupancyGrid(data, 0.1)
    rows, columns = np.indices((3, 3))
    expected = np.abs(rows - 1) + np.abs(columns - 1)
    np.testing.assert_array_equal(gridmerge.distance_map(grid), expected)
    forward = gridmerge.distance_map(grid, after="forward")
    np.testing.assert_array_equal(forward, [[np.inf, 1, 2], [np.inf, 0, 1], [np.inf] * 3])
    assert np.isinf(gridmerge.distance_map(grid, "free")).all()
    assert gridmerge.distance_map(grid, "unknown")[1, 1] == 1


def test_a_landscape_holds_what_each_pose_measures(robots: list[str]) -> None:
    cut = gridmerge.poses_between(robots[1], POSE, (-5.8, -21.9, 1.44), 5)
    assert cut[0] == gridmerge.Transform(*POSE)
    landscape = gridmerge.measure_poses(robots[0], robots[1], cut)
    assert landscape.shape == (5,)
    np.testing.assert_allclose(landscape["theta"], 1.44)
    one = gridmerge.measure(robots[0], robots[1], cut[2])
    for name in ("psi", "agreement", "disagreement", "omega", "acceptance_index"):
        assert landscape[name][2] == getattr(one, name)


def test_a_merge_knows_its_omega(robots: list[str], tmp_path: Path) -> None:
    merged = gridmerge.merge(robots)
    merged.save(tmp_path)
    written = json.loads((tmp_path / "transforms.json").read_text())["components"][0]
    component = merged.components[0]
    assert component.omega == written["omega"]
    poses = [member.transform for member in component.members]
    assert component.omega == gridmerge.count_equal_cells(component.grid, robots, poses)


def test_poses_that_put_maps_apart_are_an_error(robots: list[str]) -> None:
    with pytest.raises(ValueError, match="apart"):
        gridmerge.measure(robots[0], robots[1], (500.0, 0.0, 0.0))
