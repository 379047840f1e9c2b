# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import csv
import json
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from conftest import Cli, pose_of, to_bits

TRUTH = (-6.798, -21.877, 1.4398)


def test_walks_are_the_command_lines_to_the_bit(cli: Cli, robots: list[str], tmp_path: Path) -> None:
    trace = tmp_path / "trace.csv"
    arguments = ["match", *robots[:2], "--search", "random-walk", "--c-lock", "0,7.5", "--patience", "200"]
    answer = cli(*arguments, "--starts", "12x0x0", "--json", "--trace", trace, "--trace-all")
    expected = json.loads(answer.stdout)
    found = gridmerge.match_by_random_walk(
        robots[0], robots[1], c_locks=(0.0, 7.5), patience=200, starts=(12, 0, 0.0), trace="all"
    )
    assert to_bits(pose_of(found.result.transform)) == to_bits(expected["transform"])
    assert found.result.acceptance_index == expected["acceptance_index"]
    with trace.open() as file:
        rows = list(csv.DictReader(file))
    samples = np.concatenate([walk.trace for walk in found.walks])
    assert len(rows) == len(samples)
    for row, sample in zip(rows, samples, strict=True):
        assert (int(row["step"]), row["accepted"]) == (sample["step"], str(int(sample["accepted"])))
        assert (float(row["x"]), float(row["theta"])) == (sample["x"], sample["theta"])
        if sample["measured"]:
            assert (float(row["delta"]), float(row["psi"])) == (sample["delta"], sample["psi"])
            assert (int(row["agr"]), int(row["omega"])) == (sample["agreement"], sample["omega"])


def test_a_trace_tells_a_walk(robots: list[str]) -> None:
    found = gridmerge.match_by_random_walk(
        robots[0], robots[1], start=TRUTH, patience=300, trace="all", c_locks=[7.5]
    )
    (walk,) = found.walks
    trace = walk.trace
    assert trace["step"][0] == 0 and trace["step"][-1] == walk.proposals
    assert trace["accepted"].sum() == walk.accepted + 1
    assert trace["delta"][trace["accepted"]].min() == walk.delta
    assert (
        not gridmerge.match_by_random_walk(robots[0], robots[1], start=TRUTH, patience=10).walks[0].trace.size
    )
    best = gridmerge.measure(robots[0], robots[1], walk.transform)
    assert (best.delta(7.5), best.omega) == (walk.delta, walk.omega)


def test_a_walk_can_be_drawn(robots: list[str], tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    found = gridmerge.match_by_random_walk(robots[0], robots[1], start=TRUTH, patience=100, trace="all")
    figure = gridmerge.plot_walk(found.walks[0], robots[0], robots[1], through=TRUTH, reach=2.0, count=21)
    assert [axes.get_title() for axes in figure.axes[1:]] == ["Delta, c_lock 0", "psi", "agr - dis", "omega"]
    assert all(len(np.asarray(axes.lines[0].get_xdata())) == 21 for axes in figure.axes[1:])
    figure.savefig(tmp_path / "walk.png")
    without = gridmerge.match_by_random_walk(robots[0], robots[1], start=TRUTH, patience=10).walks[0]
    with pytest.raises(ValueError, match="^walk: has no trace"):
        gridmerge.plot_walk(without, robots[0], robots[1])


def test_a_start_that_puts_maps_apart_is_an_error(robots: list[str]) -> None:
    with pytest.raises(ValueError, match="apart"):
        gridmerge.match_by_random_walk(robots[0], robots[1], start=(500.0, 0.0, 0.0))
