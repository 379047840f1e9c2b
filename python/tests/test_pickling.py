# SPDX-License-Identifier: Apache-2.0
"""Results and mergers go to other processes and come back as they were."""

from __future__ import annotations

import copy
import dataclasses
import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import values_in
from gridmerge import _core


@pytest.fixture(scope="module")
def result(robots: list[str], elsewhere: str) -> gridmerge.MergeResult:
    return gridmerge.merge([*robots, elsewhere], fix=0)


def files_of(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_a_result_is_the_same_with_all_that_it_writes(result: gridmerge.MergeResult, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(result))
    assert again == result
    assert again.maps == result.maps and again.names == result.names
    assert again.components[0].grid == result.components[0].grid
    assert copy.deepcopy(result) == result
    result.save(tmp_path / "one")
    again.save(tmp_path / "two")
    assert files_of(tmp_path / "one") == files_of(tmp_path / "two")


def test_results_of_a_tree_and_of_nothing(robots: list[str]) -> None:
    for one in (gridmerge.merge(robots[:2], strategy="tree"), gridmerge.merge([])):
        assert pickle.loads(pickle.dumps(one)) == one


def test_parts_of_a_result_by_themselves(result: gridmerge.MergeResult) -> None:
    for part in (
        *result.components,
        *result.components[0].members,
        *result.joins,
        *result.left_out,
        *result.open_ways,
        gridmerge.InitialPose((1, 2, 3)),
        gridmerge.Transform(1, 2, 3),
    ):
        assert pickle.loads(pickle.dumps(part)) == part


def same(one: Any, other: Any) -> bool:
    """Equal, with arrays and what is no part of a comparison."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return bool(one.dtype == other.dtype and one.tobytes() == other.tobytes())
    if isinstance(one, (tuple, list)):
        return len(one) == len(other) and all(map(same, one, other))
    if dataclasses.is_dataclass(one):
        return all(
            same(getattr(one, field.name), getattr(other, field.name))
            for field in dataclasses.fields(one)
            if field.name != "_core"
        )
    return bool(one == other)


def test_all_results_that_there_are(results: list[Any]) -> None:
    seen = set()
    for value in values_in(tuple(results)):
        if type(value) not in seen and not isinstance(value, (gridmerge.Merger, gridmerge.Team)):
            seen.add(type(value))
            assert same(pickle.loads(pickle.dumps(value)), value), value
    classes = {one for name in gridmerge.__all__ if isinstance(one := getattr(gridmerge, name), type)}
    errors = {one for one in classes if issubclass(one, BaseException)}
    assert classes - errors - seen == {
        *(gridmerge.Merger, gridmerge.Team),
        *(gridmerge.OccupancyGridMessage, gridmerge.PairPose),
    }
    for kind in errors:
        told = pickle.loads(pickle.dumps(kind("x: is wrong")))
        assert (type(told), str(told)) == (kind, "x: is wrong")


def test_a_simulation_writes_the_same(team: gridmerge.Simulation, tmp_path: Path) -> None:
    again = pickle.loads(pickle.dumps(team))
    team.save(tmp_path / "one")
    again.save(tmp_path / "two")
    assert files_of(tmp_path / "one") == files_of(tmp_path / "two")
    steps = gridmerge.simulate("apartment", size=(12, 9), robots=1, steps=3, others=0)
    assert same(copy.deepcopy(steps), steps)


def test_a_damaged_simulation_is_refused(team: gridmerge.Simulation) -> None:
    state = team._core.state()
    assert len(state) == 2  # the building, and one elsewhere
    for wrong in (b"", state[0][:-1], state[0] + b"x", b"\xff" * 64):
        with pytest.raises(ValueError):
            _core.Dataset.from_state([wrong])


def test_an_evaluation_says_the_same(team_folder: Path) -> None:
    evaluation = gridmerge.evaluate(team_folder / "pairs.tsv")
    again = pickle.loads(pickle.dumps(evaluation))
    assert again == evaluation
    assert (again.to_json(), again.summary()) == (evaluation.to_json(), evaluation.summary())


def test_a_merger_goes_on_where_it_was(robots: list[str], elsewhere: str) -> None:
    merger = gridmerge.Merger(accept=0.9)
    ids = [merger.add(path) for path in (robots[0], elsewhere, robots[1])]
    merger.remove(ids[0])
    last = merger.add(robots[0], pose=(0, 0, 0.1), fixed=True)
    merger.solve()
    again = pickle.loads(pickle.dumps(merger))
    assert again.ids == merger.ids == (ids[1], ids[2], last)
    assert again._core.matches() == merger._core.matches() != []
    assert again._core.due() == []  # nothing is matched anew
    assert again.solve() == merger.solve()
    added = again.add(robots[2])
    assert added == last + 1
    merger.add(robots[2])
    assert [one.members for one in again.solve().components] == [
        one.members for one in merger.solve().components
    ]
    with pytest.raises(KeyError):
        again.remove(ids[0])


def test_a_merger_that_holds_a_frame_holds_it_still(robots: list[str]) -> None:
    merger = gridmerge.Merger()
    merger.add(robots[0], fixed=True)
    again = pickle.loads(pickle.dumps(merger))
    with pytest.raises(ValueError, match="pose"):
        again.add(robots[1], pose=(0, 0, 0))
    assert gridmerge.Merger.__name__ in repr(again)
    empty = pickle.loads(pickle.dumps(gridmerge.Merger()))
    assert empty.ids == () and empty.solve().components == ()


def test_another_process_reads_them(result: gridmerge.MergeResult, tmp_path: Path) -> None:
    file = tmp_path / "result.pickle"
    file.write_bytes(pickle.dumps(result))
    program = (
        "import pickle, sys; r = pickle.load(open(sys.argv[1], 'rb')); "
        "print(len(r.components[0].members), len(r.joins))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program, str(file)], capture_output=True, text=True, check=True
    )
    assert ran.stdout == f"{len(result.components[0].members)} {len(result.joins)}\n"


def test_a_damaged_state_is_refused(result: gridmerge.MergeResult) -> None:
    state = result._core.state()
    for wrong in (b"", state[:-1], state + b"x", b"\xff" * 64):
        with pytest.raises(ValueError):
            _core.Merged.from_state([], wrong)


def test_a_result_that_leaves_pairs_out(tmp_path: Path) -> None:
    # Two parts each of 26 floors: more maps than those of which all pairs are matched.
    maps = []
    for floor in range(26):
        random = np.random.default_rng(floor)
        cells = np.zeros((60, 100), np.int8)
        cells[[0, -1], :] = cells[:, [0, -1]] = 100
        for _ in range(8):
            row, column, length = random.integers(2, 50), random.integers(2, 90), random.integers(8, 30)
            cells[row, column : column + length] = 100
            cells[row : row + length, column] = 100
        maps += [gridmerge.OccupancyGrid(part, 0.2) for part in (cells[:, :75].copy(), cells[:, 25:].copy())]
    result = gridmerge.merge(maps, search="quick", max_missed=0.9)
    left = result.not_compared
    assert left is not None
    assert left.pairs == 52 * 51 // 2 - len(result.joins) > 0
    again = pickle.loads(pickle.dumps(result))
    assert again == result and again.not_compared == left
    result.save(tmp_path)
    told = json.loads((tmp_path / "transforms.json").read_text())["not_compared"]
    assert told == {"pairs": left.pairs, "expected_joins": left.expected_joins}
