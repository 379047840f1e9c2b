# SPDX-License-Identifier: Apache-2.0
"""Robots that are heard while they map."""

from __future__ import annotations

import json
import pickle
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import gridmerge
import numpy as np
import pytest


@pytest.fixture(scope="module")
def explored() -> gridmerge.Simulation:
    """Three robots of one building, at four moments each."""
    return gridmerge.simulate(size=(24.0, 16.0), robots=3, overlap=0.7, drift=0.0, steps=4, others=0, seed=5)


@pytest.fixture
def team() -> Iterator[gridmerge.Team]:
    yield gridmerge.Team(quiet=0.1)


def grids_at(simulation: gridmerge.Simulation, step: int) -> list[gridmerge.OccupancyGrid]:
    return [(*one.earlier, one.grid)[step] for one in simulation.maps]


def test_no_file_that_was_heard_is_written_over(robots: list[str], tmp_path: Path) -> None:
    team = gridmerge.Team(quiet=0.1)
    for name, robot in zip(("merged.yaml", "other.yaml"), robots, strict=False):
        gridmerge.save(gridmerge.load(robot), tmp_path / name)
        team.hear(name, tmp_path / name)
    assert team.wait_until_settled(600.0)
    part = tmp_path / "part.yaml"
    gridmerge.save(gridmerge.OccupancyGrid(np.zeros((2, 2), dtype=np.int8), 0.05), part)
    assert team.hear_part("merged.yaml", 0, 0, gridmerge.load(part))
    kept = {path: path.read_bytes() for path in tmp_path.iterdir()}
    for name in ("merged.yaml", "other.yaml"):  # nor where newer maps of the robots have taken their places
        team.hear(name, gridmerge.load(robots[2]))
    team.forget("other.yaml")
    for result in (team.merge_result(), pickle.loads(pickle.dumps(team.merge_result()))):
        with pytest.raises(gridmerge.FileError, match="is an input"):
            result.save(tmp_path)
        with pytest.raises(gridmerge.FileError, match="is an input"):
            result.export("geojson", tmp_path / "other.yaml")
        with pytest.raises(gridmerge.FileError, match="is an input"):
            result.export("geojson", part)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == kept


def test_robots_are_called_what_files_may_be(robots: list[str]) -> None:
    team = gridmerge.Team(quiet=0.1)
    names = ["tb\udcff", "a\nb\x1b[31m"]  # the first as os.fsdecode() gives it
    for name, robot in zip(names, robots, strict=False):
        team.hear(name, robot)
        team.hear_age(name, 1.0)
        team.set_known_pose(name, None)
        assert not team.hear_part(name, 10**6, 0, robot)
    assert team.wait_until_settled(600.0)
    answer = team.answer()
    assert [robot.name for robot in answer.robots] == sorted(names)
    assert [one.robots for one in answer.components] == [tuple(sorted(names))]
    assert [one.number for one in answer.components] == [1]
    assert answer.components[0].anchor in names
    assert set(team.merge_result().names) == set(names)
    assert {event.robot for event in team.take_events()} == set(names)
    assert repr(answer.components[0]).isprintable()
    team.forget(names[0])
    assert team.wait_until_settled(600.0)
    assert [robot.name for robot in team.answer().robots] == [names[1]]


def test_steps_grow(explored: gridmerge.Simulation) -> None:
    for one in explored.maps:
        known = [np.count_nonzero(grid.cells) for grid in (*one.earlier, one.grid)]
        assert len(known) == 4
        assert known == sorted(known)


def test_the_end_is_that_of_merge(explored: gridmerge.Simulation, team: gridmerge.Team) -> None:
    for step in range(4):
        for number, grid in enumerate(grids_at(explored, step)):
            team.hear(f"tb{number}", grid)
        time.sleep(0.05)
    assert team.wait_until_settled(600.0)
    answer = team.answer()
    joined = {event.robot for event in team.take_events() if event.kind == "joined"}
    assert joined >= {robot.name for robot in answer.robots if robot.state == "placed"}
    assert team.take_events() == ()
    merged = gridmerge.merge(grids_at(explored, 3), names=["tb0", "tb1", "tb2"])
    assert [sorted(member.name for member in one.members) for one in merged.components] == [
        list(one.robots) for one in answer.components
    ]
    assert answer.components
    assert np.array_equal(answer.components[0].grid.cells, merged.components[0].grid.cells)
    placed = {robot.name: robot for robot in answer.robots if robot.state == "placed"}
    for member in merged.components[0].members:
        assert placed[member.name].transform == member.transform
        assert placed[member.name].probability == member.probability
    assert answer.components[0].anchor == "tb0"
    assert "TeamAnswer" in repr(answer) and "placed" in repr(answer.robots[0])


def test_an_answer_is_saved_as_a_merge(
    explored: gridmerge.Simulation, team: gridmerge.Team, tmp_path: Path
) -> None:
    assert team.merge_result().names == ()
    for number, grid in enumerate(grids_at(explored, 3)):
        team.hear(f"tb{2 - number}", grid)
    assert team.wait_until_settled(600.0)
    result = team.merge_result()
    assert set(result.names) == {"tb0", "tb1", "tb2"}
    answer = team.answer()
    assert len(result.components) == len(answer.components) == 1
    assert np.array_equal(result.components[0].grid.cells, answer.components[0].grid.cells)
    placed = {robot.name: robot.transform for robot in answer.robots}
    assert {member.name: member.transform for member in result.components[0].members} == placed
    assert len(result.joins) == 3 and any(join.used for join in result.joins)
    assert pickle.loads(pickle.dumps(result)).components[0].members == result.components[0].members
    result.save(tmp_path)
    saved = json.loads((tmp_path / "transforms.json").read_text())
    assert [member["source"] for member in saved["components"][0]["members"]] == list(result.names)
    assert (tmp_path / "report.html").stat().st_size > 10000


def test_parts(explored: gridmerge.Simulation, team: gridmerge.Team) -> None:
    grid = explored.maps[0].grid
    assert not team.hear_part("tb0", 0, 0, grid)
    team.hear("tb0", grid)
    assert team.hear_part("tb0", 0, 0, grid)
    assert not team.hear_part("tb0", 1, 0, grid)
    assert team.wait_until_settled(60.0)
    assert team.answer().robots[0].maps_heard == 2
    assert team.answer().robots[0].why == "there is no other map yet"


def test_robots_go(explored: gridmerge.Simulation, team: gridmerge.Team) -> None:
    for number, grid in enumerate(grids_at(explored, 3)):
        team.hear(f"tb{number}", grid)
    assert team.wait_until_settled(600.0)
    team.forget("tb1")
    team.set_known_pose("tb0", (5.0, 6.0, 0.5), fixed=True)
    assert team.wait_until_settled(600.0)
    answer = team.answer()
    assert [robot.name for robot in answer.robots] == ["tb0", "tb2"]
    assert [robot.has_known_pose for robot in answer.robots] == [True, False]
    for one in answer.components:
        assert one.anchor is None


def test_frames_are_agreed_on(explored: gridmerge.Simulation, team: gridmerge.Team) -> None:
    for number, grid in enumerate(grids_at(explored, 3)):
        team.hear(f"tb{number}", grid)
    team.hear_age("tb2", 1000.0)
    assert team.wait_until_settled(600.0)
    assert team.answer().components[0].anchor == "tb2"
    assert team.answer().robots[2].heard_first == 1000.0


def test_bad_input(team: gridmerge.Team, explored: gridmerge.Simulation) -> None:
    with pytest.raises(TypeError, match="robot"):
        team.hear(3, explored.maps[0].grid)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="confirmations"):
        gridmerge.Team(confirmations=0)
    with pytest.raises(ValueError, match="quiet"):
        gridmerge.Team(quiet=-1.0)
    for longest in (31_536_001.0, 1e10, 1e300):
        with pytest.raises(ValueError, match="quiet"):
            gridmerge.Team(quiet=longest)
    with pytest.raises(ValueError, match="heard_first"):
        team.hear_age("tb0", 1e10)
    with pytest.raises(ValueError, match="column"):
        team.hear_part("tb0", -1, 0, explored.maps[0].grid)
    small = gridmerge.Team(max_robots=1)
    small.hear("tb0", explored.maps[0].grid)
    with pytest.raises(ValueError, match="one too many"):
        small.hear("tb1", explored.maps[1].grid)


def test_many_threads_and_an_early_end(explored: gridmerge.Simulation) -> None:
    grids = grids_at(explored, 3)

    def publish(team: gridmerge.Team, number: int) -> None:
        for _ in range(20):
            team.hear(f"tb{number}", grids[number])

    def hear_all() -> None:
        team = gridmerge.Team()
        robots = [threading.Thread(target=publish, args=(team, number)) for number in range(3)]
        for robot in robots:
            robot.start()
        for robot in robots:
            robot.join()
        assert isinstance(team.answer().number, int)

    hear_all()  # the team ends while it is at work, most likely
