# SPDX-License-Identifier: Apache-2.0
"""Merges of maps that come one after the other."""

from __future__ import annotations

import pickle
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from conftest import merge_as_json, to_bits


def test_a_merger_names_maps_as_merge_does(robots: list[str]) -> None:
    messages = [gridmerge.load(robot).to_msg(frame_id="map") for robot in robots[:2]]
    merger = gridmerge.Merger(accept=None)
    for message in messages:
        merger.add(message)
    assert merger.solve().names == gridmerge.merge(messages).names == ("map 0", "map 1")
    merger.update(1, gridmerge.load(robots[1]).to_msg(frame_id="other"))
    assert merger.solve().names == ("map", "other")


def test_a_map_goes_by_the_file_that_it_is_of_now(robots: list[str], tmp_path: Path) -> None:
    merger = gridmerge.Merger()
    ids = [merger.add(robot) for robot in robots[:2]]
    named = merger.add(robots[2], name="the third")
    later = tmp_path / "later.yaml"
    gridmerge.save(gridmerge.load(robots[0]), later)
    merger.update(ids[0], later)
    merger.grow(named, later)
    merger = pickle.loads(pickle.dumps(merger))
    result = merger.solve()
    assert result.names == (str(later), robots[1], "the third")
    result.save(tmp_path / "merged")
    assert gridmerge.read_transforms(tmp_path / "merged").components[0].members[0].name == str(later)


def test_a_merger_gives_what_merge_gives(robots: list[str], elsewhere: str) -> None:
    merger = gridmerge.Merger()
    first = merger.add(elsewhere)
    ids = [merger.add(path) for path in robots[:2]]
    merger.solve()
    merger.update(ids[1], robots[2])
    merger.update(ids[1], robots[1])
    merger.remove(first)
    merger.add(robots[2])
    assert to_bits(merge_as_json(merger.solve())) == to_bits(merge_as_json(gridmerge.merge(robots)))
    with pytest.raises(KeyError):
        merger.remove(first)
    with pytest.raises(KeyError):
        merger.update(99, robots[0])


def test_a_merger_with_known_poses(robots: list[str]) -> None:
    merger = gridmerge.Merger()
    merger.add(robots[0], pose=(10, 5, 0.5), fixed=True)
    merger.add(robots[1])
    fixed = gridmerge.merge(robots[:2], init={0: (10, 5, 0.5)}, fix=0)
    assert to_bits(merge_as_json(merger.solve())) == to_bits(merge_as_json(fixed))


def test_a_merger_takes_one_fixed_map_without_a_pose(robots: list[str]) -> None:
    merger = gridmerge.Merger()
    first = merger.add(robots[0], fixed=True)
    for options in ({"fixed": True}, {"pose": (1, 2, 3)}, {"pose": (1, 2, 3), "fixed": True}):
        with pytest.raises(ValueError, match=r"^pose: "):
            merger.add(robots[1], **options)
    assert merger.ids == (first,)
    merger.add(robots[1])
    fixed = gridmerge.merge(robots[:2], fix=0)
    assert to_bits(merge_as_json(merger.solve())) == to_bits(merge_as_json(fixed))
    merger.remove(first)
    posed = merger.add(robots[0], pose=(10, 5, 0.5))
    with pytest.raises(ValueError, match=r"^pose: "):
        merger.add(robots[2], fixed=True)
    merger.update(posed, robots[0])
    merger.remove(np.int64(posed))  # type: ignore[arg-type]
    merger.add(robots[2], fixed=True)
