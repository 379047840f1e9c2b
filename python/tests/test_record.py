# SPDX-License-Identifier: Apache-2.0
"""What a merge has written is read again, to lay other things on the maps by it."""

from __future__ import annotations

import json
import pickle
import re
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import Cli


@pytest.fixture(scope="module")
def merged(elsewhere: str) -> gridmerge.MergeResult:
    """Of maps of which one has a false resolution."""
    team = gridmerge.simulate(robots=3, overlap=0.7, drift=0.0, others=0, clutter=0.0, seed=101)
    maps = [one.grid for one in team.maps]
    last = maps[2]
    maps[2] = gridmerge.OccupancyGrid(
        last.to_numpy(), resolution=1.03 * last.resolution, origin=tuple(last.origin)
    )
    return gridmerge.merge([*maps, elsewhere], transform="similarity", names=list("abcd"))


@pytest.fixture(scope="module")
def folder(merged: gridmerge.MergeResult, tmp_path_factory: pytest.TempPathFactory) -> Path:
    saved = tmp_path_factory.mktemp("merged")
    merged.save(saved)
    return saved


def test_it_is_what_the_merge_said(merged: gridmerge.MergeResult, folder: Path) -> None:
    record = gridmerge.read_transforms(folder)
    assert record.names == merged.names
    assert record.left_out == merged.left_out
    assert record.plan is None
    (component,) = record.components
    assert component.file == "merged.yaml"
    assert component.in_world_frame == merged.components[0].in_world_frame
    assert component.members == merged.components[0].members
    assert [member.name for member, where in record.placed() if where is component] == list(record.names[:3])
    points = np.random.default_rng(4).uniform(-5.0, 5.0, (50, 2))
    for told, member in zip(merged.components[0].members, component.members, strict=True):
        assert member.deformation is not None
        placed = member.to_component(points)
        assert placed.tobytes() == told.to_component(points).tobytes()
        np.testing.assert_allclose(member.to_map(placed), points, rtol=0.0, atol=1e-6)
    assert pickle.loads(pickle.dumps(record)) == record


def test_the_file_itself_is_read_under_any_name(folder: Path, tmp_path: Path) -> None:
    renamed = tmp_path / "monday.json"
    renamed.write_bytes((folder / "transforms.json").read_bytes())
    assert gridmerge.read_transforms(str(renamed)) == gridmerge.read_transforms(folder)


def test_it_reads_what_the_command_line_wrote(
    robots: list[str], elsewhere: str, cli: Cli, tmp_path: Path
) -> None:
    cli("merge", *robots, elsewhere, "--fix", robots[1], "-o", tmp_path)
    told = gridmerge.merge([*robots, elsewhere], fix=1)
    record = gridmerge.read_transforms(tmp_path)
    assert record.components[0].members == told.components[0].members
    assert repr(record) == "MergeRecord(3 of 4 maps in 1 component)"
    assert repr(record.components[0]).startswith("RecordedComponent(merged.yaml, 3 maps: ")


def test_what_is_none_is_named(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(gridmerge.FileError, match=re.escape(str(tmp_path)) + ": holds no transforms.json"):
        gridmerge.read_transforms(tmp_path)
    with pytest.raises(gridmerge.FileError, match="missing.json"):
        gridmerge.read_transforms(tmp_path / "missing.json")
    text = json.loads((folder / "transforms.json").read_text())
    text["components"][0]["members"][1]["transform"]["x"] = "far"
    damaged = tmp_path / "transforms.json"
    damaged.write_text(json.dumps(text))
    with pytest.raises(gridmerge.FileError, match=r"components\[0\].members\[1\].transform.x is no number"):
        gridmerge.read_transforms(damaged)
    wrong: Any = 3
    with pytest.raises(TypeError, match="^path: must be a path, is of type int$"):
        gridmerge.read_transforms(wrong)


def test_a_plan_is_part_of_it(team: gridmerge.Simulation, tmp_path: Path) -> None:
    grids = [one.grid for one in team.maps[:2]]
    merged = gridmerge.merge(grids, plan=team.building, plan_scale=(0.9, 1.1))
    merged.save(tmp_path)
    assert gridmerge.read_transforms(tmp_path).plan == merged.plan
