# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import Cli, pose_of, to_bits


def as_json(result: gridmerge.MatchResult) -> dict[str, Any]:
    """What the command line writes, but for names and seconds."""
    return {
        "verdict": result.verdict,
        "reason": None if result.accepted else result.reason,
        "transform": pose_of(result.transform),
        "probability": result.probability,
        "acceptance_index": result.acceptance_index,
        "agreement": result.agreement,
        "disagreement": result.disagreement,
        "overlap": result.overlap,
        "hypotheses": [
            {"transform": pose_of(one.transform), "score": one.score, "probability": one.probability}
            for one in result.hypotheses
        ],
    }


def ask(cli: Cli, *arguments: object) -> dict[str, Any]:
    answer = json.loads(cli("match", "--json", *arguments).stdout)
    assert isinstance(answer, dict)
    return {key: value for key, value in answer.items() if key not in ("fixed", "moving", "seconds")}


@pytest.mark.parametrize("pair", [(0, 1), (1, 0), (1, 2), (0, 3)])
def test_results_equal_the_command_lines_to_the_bit(
    cli: Cli, robots: list[str], elsewhere: str, pair: tuple[int, int]
) -> None:
    paths = [*robots, elsewhere]
    fixed, moving = (paths[i] for i in pair)
    assert to_bits(as_json(gridmerge.match(fixed, moving))) == to_bits(ask(cli, fixed, moving))


def test_so_do_those_of_simulated_maps(cli: Cli, team: gridmerge.Simulation, team_folder: Path) -> None:
    fixed, moving = (team_folder / f"robot_{i}.yaml" for i in (1, 2))
    expected = to_bits(ask(cli, fixed, moving, "--accept", 0.99))
    assert to_bits(as_json(gridmerge.match(fixed, moving, accept=0.99))) == expected
    of_arrays = [
        gridmerge.OccupancyGrid(one.grid.to_numpy(), one.grid.resolution, one.grid.origin)
        for one in team.maps[:2]
    ]
    assert to_bits(as_json(gridmerge.match(*of_arrays, accept=0.99))) == expected


def test_a_plan_of_another_scale(cli: Cli, robots: list[str], tmp_path: Path) -> None:
    plan = gridmerge.load(robots[0])
    larger = gridmerge.OccupancyGrid(plan.to_numpy(), plan.resolution * 1.25)
    result = gridmerge.match(larger, robots[0], scale=(1.1, 1.4))
    assert result.accepted
    assert result.scale == pytest.approx(1.25, rel=0.02)
    assert result.hypotheses[0].scale == result.scale
    assert f"scale={result.scale:.4f}" in repr(result)
    gridmerge.save(larger, tmp_path / "plan.yaml")
    answer = ask(cli, tmp_path / "plan.yaml", robots[0], "--scale", "1.1:1.4")
    assert answer["scale"] == result.scale
    assert to_bits(answer["transform"]) == to_bits(pose_of(result.transform))


@pytest.mark.parametrize(
    ("scale", "error"),
    [
        ((0.0, 1.0), ValueError),
        ((2.0, 0.5), ValueError),
        ((float("nan"), 1.0), ValueError),
        ((0.1, 9.0), ValueError),
        ((1.0,), TypeError),
        (2.0, TypeError),
        (("a", 1.0), TypeError),
    ],
)
def test_scales_that_make_no_sense(robots: list[str], scale: Any, error: type[Exception]) -> None:
    with pytest.raises(error, match="^scale: "):
        gridmerge.match(robots[0], robots[1], scale=scale)


def test_the_random_walk_searches_no_scale(robots: list[str]) -> None:
    with pytest.raises(ValueError, match="^scale: "):
        gridmerge.match(robots[0], robots[1], scale=(0.5, 2.0), search="random-walk")


def test_threads_change_nothing(robots: list[str]) -> None:
    results = [as_json(gridmerge.match(*robots[:2], threads=threads)) for threads in (0, 1, 2, 5)]
    assert all(to_bits(result) == to_bits(results[0]) for result in results)


def test_unrelated_maps_are_refused(robots: list[str], elsewhere: str) -> None:
    result = gridmerge.match(robots[0], elsewhere)
    assert result.verdict == "refused"
    assert not result.accepted
    assert result.reason != "none"


def test_maps_with_nothing_in_them_are_refused() -> None:
    for value in (-1, 0, 100):
        grid = gridmerge.OccupancyGrid(np.full((50, 50), value, dtype=np.int8), 0.05)
        result = gridmerge.match(grid, grid)
        assert not result.accepted
        assert value == 100 or (result.reason == "nothing_to_compare" and result.hypotheses == ())


def test_a_map_lies_on_itself_turned(robots: list[str]) -> None:
    grid = gridmerge.load(robots[0])
    place = gridmerge.Transform(3.0, -1.0, 0.7)
    moved = gridmerge.OccupancyGrid(grid.to_numpy(), grid.resolution, place.inverse() @ grid.origin)
    result = gridmerge.match(grid, moved)
    assert result.accepted
    np.testing.assert_allclose(list(result.transform), list(place), atol=0.05)


def test_hypotheses_are_as_many_as_asked_for(robots: list[str]) -> None:
    assert len(gridmerge.match(*robots[:2], max_hypotheses=2).hypotheses) == 2


def test_results_can_be_pickled(robots: list[str]) -> None:
    result = gridmerge.match(*robots[:2])
    assert pickle.loads(pickle.dumps(result)) == result


def test_progress_ends_with_one(robots: list[str]) -> None:
    shares: list[float] = []
    gridmerge.match(*robots[:2], progress=shares.append)
    assert shares[-1] == 1.0
    assert shares == sorted(shares)


def test_a_search_is_chosen_by_name(robots: list[str]) -> None:
    fixed, moving = robots[:2]
    found = {
        name: gridmerge.match(fixed, moving, search=name) for name in ("exhaustive", "quick", "thorough")
    }
    assert all(one.accepted for one in found.values())
    assert found["exhaustive"].transform == found["quick"].transform  # it decides the pair
    with pytest.raises(
        ValueError, match="search: must be one of exhaustive, quick, thorough, random-walk, is 'fast'"
    ):
        gridmerge.match(fixed, moving, search="fast")
    with pytest.raises(ValueError, match="search: must be one of"):
        gridmerge.merge([fixed, moving], search="fast")


def test_the_random_walk_is_a_search_like_others(robots: list[str]) -> None:
    fixed, moving = robots[:2]
    walked = gridmerge.match(fixed, moving, search="random-walk")
    alone = gridmerge.match_by_random_walk(fixed, moving).result
    assert walked.transform == alone.transform
    assert walked.verdict == alone.verdict
    assert walked.probability == walked.acceptance_index
    assert gridmerge.match(fixed, moving, search="random-walk", accept=0.0).accepted
    with pytest.raises(ValueError, match="search: 'random-walk' needs the strategy 'tree'"):
        gridmerge.merge([fixed, moving], search="random-walk")
    merged = gridmerge.merge([fixed, moving], search="random-walk", strategy="tree", accept=0.0)
    assert len(merged.components) == 1


def test_a_verdict_has_words(cli: Cli, robots: list[str], elsewhere: str) -> None:
    assert gridmerge.match(robots[0], robots[1]).explanation == "the maps show one place"
    refused = gridmerge.match(robots[0], elsewhere)
    assert refused.explanation
    assert f"refused: {refused.explanation} (" in cli("match", robots[0], elsewhere).stdout
