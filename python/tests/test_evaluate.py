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
    assert "seconds per match" in evaluation.summary()


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


def test_map_files_are_read_as_the_command_line_reads_them(
    cli: Cli, robots: list[str], tmp_path: Path
) -> None:
    # The gray 205 that savers write for unknown is free by the letter of these files.
    for i, path in enumerate(robots[:2]):
        grid = gridmerge.load(path)
        gridmerge.save(grid, tmp_path / f"{i}.yaml")
        text = (tmp_path / f"{i}.yaml").read_text()
        (tmp_path / f"{i}.yaml").write_text(text.replace("free_thresh: 0.196", "free_thresh: 0.25"))
    truth = gridmerge.match(*robots[:2]).transform
    row = "\t".join(map(repr, truth))
    table = tmp_path / "pairs.tsv"
    table.write_text(f"fixed\tmoving\tx\ty\ttheta\ttolerance\n0.yaml\t1.yaml\t{row}\t0.5\n")
    with pytest.warns(gridmerge.MapWarning):
        usual = gridmerge.evaluate(table)
    assert usual.pairs.accepted_correct == 1
    with pytest.warns(gridmerge.MapWarning, match="load as free"):
        literal = gridmerge.evaluate(table, literal_thresholds=True)
    answer = cli("evaluate", table, "--literal-thresholds", "--json", "-")
    assert to_bits(without_times(literal.to_json())) == to_bits(without_times(answer.stdout))
    assert literal.cases[0].probability != usual.cases[0].probability


def test_bare_images_need_a_resolution(robots: list[str], tmp_path: Path) -> None:
    image = Path(robots[0]).with_suffix(".pgm")
    table = tmp_path / "pairs.tsv"
    table.write_text(f"fixed\tmoving\tx\ty\ttheta\ttolerance\n{image}\t{image}\t0\t0\t0\t0.1\n")
    with pytest.raises(gridmerge.FileError, match="resolution"):
        gridmerge.evaluate(table)
    assert gridmerge.evaluate(table, resolution=0.05).pairs.accepted_correct == 1
    with pytest.raises(ValueError, match="^resolution: must be between"):
        gridmerge.evaluate(table, resolution=0.0)
