# SPDX-License-Identifier: Apache-2.0
"""How pairs are searched: whoever matches them takes the same `search`."""

from __future__ import annotations

import json
import pickle
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import Cli, to_bits
from test_evaluate import without_times

JOINT = ("exhaustive", "quick", "thorough")


def searches_of(merger: gridmerge.Merger) -> set[str]:
    return {search for _, _, search, _ in merger._core.matches()}


@pytest.mark.parametrize("search", ["quick", "thorough"])
def test_a_merger_searches_as_merge_does(search: str, robots: list[str], elsewhere: str) -> None:
    merger = gridmerge.Merger(search=search)
    for path in (*robots, elsewhere):
        merger.add(path)
    again = pickle.loads(pickle.dumps(merger))
    expected = gridmerge.merge([*robots, elsewhere], search=search)
    for one in (merger, again):
        assert one.solve().components == expected.components
        assert searches_of(one) == {search}


@pytest.mark.parametrize("search", ["quick", "thorough"])
def test_an_evaluation_is_the_command_lines(search: str, cli: Cli, team_folder: Path) -> None:
    tables = [team_folder / name for name in ("pairs.tsv", "negatives.tsv", "sets.tsv")]
    told = gridmerge.evaluate(*tables, search=search)
    answer = cli(
        *("evaluate", tables[0], "--negatives", tables[1], "--sets", tables[2]),
        *("--search", search, "--json", "-"),
    )
    assert to_bits(without_times(told.to_json())) == to_bits(without_times(answer.stdout))
    other = gridmerge.evaluate(*tables)
    assert [case.probability for case in told.cases] != [case.probability for case in other.cases]


def test_an_evaluation_up_the_tree_may_walk(cli: Cli, team_folder: Path) -> None:
    table = team_folder / "pairs.tsv"
    told = gridmerge.evaluate(table, strategy="tree", search="random-walk")
    answer = cli("evaluate", table, "--strategy", "tree", "--search", "random-walk", "--json", "-")
    assert to_bits(without_times(told.to_json())) == to_bits(without_times(answer.stdout))
    assert (
        cli("evaluate", table, "--strategy", "tree", "--search", "random-walk").stdout.splitlines()[0]
        == (told.summary().splitlines()[0])
    )
    assert json.loads(told.to_json())["cases"]


def test_a_team_searches_quickly(robots: list[str]) -> None:
    team = gridmerge.Team(quiet=0.0, search="quick")
    for i, path in enumerate(robots):
        team.hear(f"tb{i}", path)
    assert team.wait_until_settled(600.0)
    expected = gridmerge.merge(robots, search="quick")
    joins = team.merge_result().joins
    assert [join.match.hypotheses for join in joins] == [join.match.hypotheses for join in expected.joins]


def test_a_share_that_spares_no_pair_is_told() -> None:
    unseen = gridmerge.OccupancyGrid(np.full((2, 2), -1, np.int8), 1.0)
    merger = gridmerge.Merger(max_missed=0.1)
    for _ in range(51):
        merger.add(unseen)
    calls: list[tuple[Callable[[], object], str]] = [
        (lambda: gridmerge.merge([unseen] * 51, max_missed=0.2), "0.2"),
        (merger.solve, "0.1"),
    ]
    for call, share in calls:
        with pytest.warns(
            UserWarning, match=f"^max_missed: {share} means that all pairs are matched"
        ) as told:
            call()
        assert len(told) == 1 and told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gridmerge.merge([unseen] * 51, max_missed=0.25)
        gridmerge.merge([unseen] * 51)
        gridmerge.merge([unseen] * 50, max_missed=0.2)


def test_searches_are_those_of_the_engine(robots: list[str]) -> None:
    searches = gridmerge._core.search_methods()
    assert set(JOINT) == set(gridmerge._core.joint_search_methods()) == set(searches) - {"random-walk"}
    with pytest.raises(ValueError, match="^scale: does not go with the search 'random-walk'$"):
        gridmerge.match(*robots[:2], search="random-walk", scale=(0.5, 2.0))
    with pytest.raises(ValueError, match="^search: 'random-walk' needs the strategy 'tree'"):
        gridmerge.merge(robots, search="random-walk")
    with pytest.raises(ValueError, match="^search: must be one of"):
        gridmerge.merge(robots, search="slow")


def test_what_is_no_search_is_refused(robots: list[str], team_folder: Path) -> None:
    number: Any = 3
    for make in (
        lambda search: gridmerge.Merger(search=search),
        lambda search: gridmerge.Team(search=search),
    ):
        for search in ("slow", "random-walk"):
            with pytest.raises(
                ValueError, match=f"^search: must be one of {', '.join(JOINT)}, is '{search}'$"
            ):
                make(search)
        with pytest.raises(TypeError, match="^search: must be one of"):
            make(number)
    with pytest.raises(ValueError, match="^search: must be one of"):
        gridmerge.evaluate(team_folder / "pairs.tsv", search="slow")
    with pytest.raises(ValueError, match="^search: 'random-walk' needs the strategy 'tree'"):
        gridmerge.evaluate(team_folder / "pairs.tsv", search="random-walk")
