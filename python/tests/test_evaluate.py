# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gridmerge
import pytest
from conftest import THREE_ROBOTS, Cli, to_bits


def without_times(text: str) -> dict[str, Any]:
    evaluation = json.loads(text)
    assert isinstance(evaluation, dict)
    del evaluation["seconds"]
    for case in evaluation["cases"]:
        del case["seconds"]
    return evaluation


@pytest.mark.parametrize("strategy", ["joint", "tree"])
@pytest.mark.parametrize("data", ["three robots", "team"])
def test_equals_the_command_lines(cli: Cli, team_folder: Path, data: str, strategy: Any) -> None:
    folder = THREE_ROBOTS if data == "three robots" else team_folder
    tables = [folder / name for name in ("pairs.tsv", "negatives.tsv", "sets.tsv")]
    evaluation = gridmerge.evaluate(*tables, strategy=strategy)
    answer = cli(
        *("evaluate", tables[0], "--negatives", tables[1], "--sets", tables[2]),
        *("--strategy", strategy, "--json", "-"),
    )
    assert to_bits(without_times(evaluation.to_json())) == to_bits(without_times(answer.stdout))


def test_the_typed_figures_are_those_of_the_json(team_folder: Path) -> None:
    evaluation = gridmerge.evaluate(
        team_folder / "pairs.tsv", team_folder / "negatives.tsv", team_folder / "sets.tsv", accept=0.5
    )
    text = json.loads(evaluation.to_json())
    for key in ("pairs", "negatives", "sets", "seconds"):
        counts = getattr(evaluation, key)
        assert {name: getattr(counts, name) for name in text[key]} == text[key]
    for case, expected in zip(evaluation.cases, text["cases"], strict=True):
        assert {name: getattr(case, name) for name in expected} == expected
        assert case.negative == (expected["tolerance"] is None)
    assert evaluation.sets.maps == evaluation.set_cases[0].maps == 3
    assert "seconds a match" in evaluation.summary()


def test_negatives_alone(team_folder: Path) -> None:
    evaluation = gridmerge.evaluate(negatives=team_folder / "negatives.tsv")
    assert evaluation.pairs.total == 0
    assert evaluation.negatives.total == len(evaluation.cases) > 0
    assert all(case.correct is None for case in evaluation.cases)


def test_errors_are_the_command_lines(cli: Cli, tmp_path: Path) -> None:
    table = tmp_path / "pairs.tsv"
    for text in ("fixed\tmoving\n", "fixed\tmoving\tx\ty\ttheta\ttolerance\na.yaml\tb.yaml\t0\t0\tnan\t1\n"):
        table.write_text(text)
        with pytest.raises(gridmerge.FileError) as error:
            gridmerge.evaluate(table)
        assert cli("evaluate", table).stderr == f"gridmerge: {error.value}\n"
