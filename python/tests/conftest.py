# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import json
import os
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
THREE_ROBOTS = ROOT / "examples" / "three_robots"
Cli = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture(scope="session")
def cli() -> Cli:
    """Runs the command line tool of the same sources; $GRIDMERGE_CLI names another one."""
    program = os.environ.get("GRIDMERGE_CLI", str(ROOT / "build" / "release" / "bin" / "gridmerge"))
    if not os.access(program, os.X_OK):
        pytest.skip(f"there is no command line tool at {program} to compare with (./dev build makes it)")

    def run(*arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)

    return run


@pytest.fixture(scope="session")
def robots() -> list[str]:
    """Three maps of one floor."""
    return [str(THREE_ROBOTS / f"robot_{i}.yaml") for i in (1, 2, 3)]


@pytest.fixture(scope="session")
def elsewhere() -> str:
    """A map of another building."""
    return str(THREE_ROBOTS / "elsewhere.yaml")


@pytest.fixture(scope="session")
def team() -> gridmerge.Simulation:
    return gridmerge.simulate("office", size=(30.0, 20.0), robots=3, overlap=0.4, drift=0.1, seed=3)


@pytest.fixture(scope="session")
def team_folder(team: gridmerge.Simulation, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("team")
    team.save(folder)
    return folder


@pytest.fixture(scope="session")
def results(
    robots: list[str],
    elsewhere: str,
    team: gridmerge.Simulation,
    team_folder: Path,
    tmp_path_factory: pytest.TempPathFactory,
) -> list[Any]:
    """Of each kind that there is."""
    merger = gridmerge.Merger()
    merger.add(robots[0])
    heard = gridmerge.Team(quiet=0.1)
    for number, path in enumerate(robots[:2]):
        heard.hear(f"tb{number}", path)
    assert heard.wait_until_settled(600.0)
    merged = gridmerge.merge([*robots, elsewhere])
    saved = tmp_path_factory.mktemp("saved")
    merged.save(saved)
    return [
        gridmerge.match(*robots[:2]),
        merged,
        gridmerge.read_transforms(saved),
        gridmerge.merge(robots[:2], strategy="tree"),
        team,
        gridmerge.evaluate(
            team_folder / "pairs.tsv", team_folder / "negatives.tsv", team_folder / "sets.tsv"
        ),
        gridmerge.measure(robots[0], robots[1], (0.0, 0.0, 0.0)),
        gridmerge.measure_maps(robots[0], robots[1:2], [(0.0, 0.0, 0.0)]),
        gridmerge.match_by_random_walk(*robots[:2], max_proposals=50, trace="all"),
        gridmerge.Transform(1.0, 2.0, 3.0),
        gridmerge.InitialPose((1.0, 2.0, 3.0)),
        gridmerge.Deformation((1.0, 2.0, 3.0), 0.5, np.zeros((4, 5, 2))),
        gridmerge.NotCompared(3, 0.5),
        merger,
        *gridmerge.bag_topics(ROOT / "tests" / "bag" / "data" / "lz4.mcap"),
        next(gridmerge.recorded_maps(ROOT / "tests" / "bag" / "data" / "lz4.mcap", "/tb1/map")),
        heard,
        heard.answer(),
        gridmerge.merge(robots[:2], plan=elsewhere, plan_scale=(0.95, 1.05)),
        gridmerge.merge(robots[:2], accept=1.0),  # nothing is sure enough, so a way stays open
    ]


def values_in(value: Any) -> Iterator[Any]:
    """A result, and all results in it."""
    if isinstance(value, tuple):
        for one in value:
            yield from values_in(one)
    elif type(value).__module__ == "gridmerge":
        yield value
        if dataclasses.is_dataclass(value):
            for field in dataclasses.fields(value):
                if not field.name.startswith("_"):
                    yield from values_in(getattr(value, field.name))


def pose_of(transform: gridmerge.Transform) -> dict[str, float]:
    """As the command line writes it in JSON."""
    return {"x": transform.x, "y": transform.y, "theta": transform.theta}


def to_bits(value: Any) -> str:
    """JSON text that tells -0.0 from 0.0 and any two doubles apart."""
    return json.dumps(value, sort_keys=True)


def kept_hypotheses(join: gridmerge.Join) -> list[gridmerge.Hypothesis]:
    """Of a refused join the file has the best one, and two more that may be true."""
    best, rest = join.match.hypotheses[:1], join.match.hypotheses[1:]
    if join.outcome != "refused":
        return [*best, *rest]
    return [*best, *[one for one in rest if one.probability >= 0.01][:2]]


def merge_as_json(result: gridmerge.MergeResult) -> dict[str, Any]:
    """transforms.json, made of the typed result."""
    components = []
    for i, component in enumerate(result.components):
        members = [
            {
                "source": one.name,
                "transform": pose_of(one.transform),
                "probability": one.probability,
                "sd": None
                if one.sd_position is None
                else {"position": one.sd_position, "theta": one.sd_theta},
            }
            for one in component.members
        ]
        held = [one.name for one in component.members if tuple(one.transform) == (0.0, 0.0, 0.0)]
        frame = next(iter(held), None) if component.in_world_frame else component.members[0].name
        name = "merged.yaml" if i == 0 else f"merged_{i + 1}.yaml"
        assert component.omega is not None
        cells = component.grid.width * component.grid.height
        omega = {"omega": component.omega, "cells": cells, "omega_share": component.omega / cells}
        components.append({"map": name, "frame": frame, "members": members, **omega})
    joins = [
        {
            "fixed": result.names[join.fixed],
            "moving": result.names[join.moving],
            "transform": pose_of(join.transform),
            "verdict": "accepted" if join.used else "refused",
            "probability": join.probability,
            "outcome": join.outcome,
            "reason": join.reason,
            "by_themselves": {
                "verdict": "accepted" if join.match.accepted else "refused",
                "reason": None if join.match.accepted else join.match.reason,
            },
            "acceptance_index": join.acceptance_index,
            "agreement": join.agreement,
            "disagreement": join.disagreement,
            "overlap": join.overlap,
            "hypotheses": [
                {"transform": pose_of(one.transform), "score": one.score, "probability": one.probability}
                for one in kept_hypotheses(join)
            ],
        }
        for join in result.joins
    ]
    return {
        "maps": list(result.names),
        "components": components,
        "joins": joins,
        "left_out": [one.name for one in result.left_out],
        "left_out_maps": [{"source": one.name, "reason": one.reason} for one in result.left_out],
        "open_ways": [
            {
                "fixed": result.names[way.fixed],
                "moving": result.names[way.moving],
                "transform": pose_of(way.transform),
                "probability": way.probability,
            }
            for way in result.open_ways
        ],
        "expected_false_joins": result.expected_false_joins,
    }
