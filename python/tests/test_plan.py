# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import base64
import json
import pickle
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from conftest import Cli

SCALES = (1.0, 1.5)


@pytest.fixture(scope="module")
def robots(tmp_path_factory: pytest.TempPathFactory) -> list[gridmerge.OccupancyGrid]:
    folder = tmp_path_factory.mktemp("robots")
    simulation = gridmerge.simulate("apartment", size=(16.0, 11.0), robots=2, drift=0.3, others=0, seed=3)
    simulation.save(folder)
    return [gridmerge.load(folder / f"robot_{i}.yaml") for i in (1, 2)]


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of the same apartment, at 0.8 of its size."""
    folder = tmp_path_factory.mktemp("plan")
    gridmerge.simulate("apartment", size=(16.0, 11.0), robots=2, drift=0.3, others=0, seed=3).save(folder)
    drawn = folder / "building.yaml"
    text = drawn.read_text().replace("resolution: 0.05", "resolution: 0.04")
    assert "resolution: 0.04" in text
    drawn.write_text(text)
    return drawn


def test_hangs_maps_on_a_plan_as_the_command_line_does(
    robots: list[gridmerge.OccupancyGrid], plan: Path, cli: Cli, tmp_path: Path
) -> None:
    result = gridmerge.merge(robots, plan=plan, plan_scale=SCALES)
    assert result.complete
    assert result.plan is not None
    assert result.plan.scale == pytest.approx(1.25, rel=0.03)
    assert result.plan.name == str(plan)
    (part,) = result.plan.parts
    assert part.on_plan
    assert part.maps == (0, 1)
    assert part.names == result.names
    assert part.reason is None
    assert part.explanation == ""
    assert part.probability == result.plan.probability
    assert result.components[0].in_world_frame
    assert part.transform == result.components[0].members[0].transform
    assert "2 maps on it, scale=1.2" in repr(result.plan)

    arguments = ["--plan", plan, "--plan-scale", f"{SCALES[0]}:{SCALES[1]}"]
    answer = cli("merge", *result.names, *arguments, "-o", tmp_path / "cli")
    assert answer.returncode == 0, answer.stderr
    result.save(tmp_path / "python")
    for file in sorted((tmp_path / "cli").iterdir()):
        assert file.read_bytes() == (tmp_path / "python" / file.name).read_bytes(), file.name
    shown = base64.b64encode((tmp_path / "cli" / "preview.png").read_bytes()).decode()
    assert f"base64,{shown}" in result._repr_html_()  # with the plan's walls in it
    told = json.loads((tmp_path / "cli" / "transforms.json").read_text())["plan"]
    assert told["scale"] == result.plan.scale
    assert told["maps"] == list(result.names)

    again = pickle.loads(pickle.dumps(result))
    assert again == result
    assert again.plan == result.plan
    again.save(tmp_path / "again")
    assert (tmp_path / "again" / "report.html").read_bytes() == (
        tmp_path / "cli" / "report.html"
    ).read_bytes()


def test_a_strangers_plan_changes_nothing(robots: list[gridmerge.OccupancyGrid], elsewhere: str) -> None:
    without = gridmerge.merge(robots)
    assert without.plan is None
    result = gridmerge.merge(robots, plan=elsewhere, plan_scale=(0.9, 1.1))
    assert result.components == without.components
    assert not result.complete
    assert result.plan is not None
    assert result.plan.scale is None
    assert result.plan.probability is None
    assert [part.on_plan for part in result.plan.parts] == [False]
    assert result.plan.parts[0].explanation
    assert result.plan.parts[0].reason is not None


def test_says_what_is_wrong(robots: list[gridmerge.OccupancyGrid], plan: Path) -> None:
    bare = gridmerge.OccupancyGrid(np.zeros((4, 5), np.int8), 0.1)
    for wrong, message in [
        ({"plan": bare}, "plan: has no walls"),
        ({"plan": robots[1]}, "plan: is the same as map 1"),
        ({"plan": plan, "plan_scale": (2.0, 0.5)}, "plan_scale: must go from a smaller"),
        ({"plan_scale": (0.5, 2.0)}, "plan_scale: there is no plan"),
        ({"plan": plan, "fix": 0}, "plan: excludes fix"),
        ({"plan": plan, "strategy": "tree"}, "strategy: plan needs 'joint'"),
    ]:
        with pytest.raises(ValueError, match=message):
            gridmerge.merge(robots, **wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="plan_scale: must be a pair"):
        gridmerge.merge(robots, plan=plan, plan_scale=2.0)  # type: ignore[arg-type]
    with pytest.raises(gridmerge.FileError):
        gridmerge.merge(robots, plan=plan.parent / "absent.yaml")
