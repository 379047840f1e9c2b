# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gridmerge
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


def pose_of(transform: gridmerge.Transform) -> dict[str, float]:
    """As the command line writes it in JSON."""
    return {"x": transform.x, "y": transform.y, "theta": transform.theta}


def to_bits(value: Any) -> str:
    """JSON text that tells -0.0 from 0.0 and any two doubles apart."""
    return json.dumps(value, sort_keys=True)
