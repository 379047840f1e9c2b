# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import pickle
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from conftest import Cli


def any_deformation(seed: int = 1) -> gridmerge.Deformation:
    shifts = np.random.default_rng(seed).uniform(-0.3, 0.3, (5, 6, 2))
    return gridmerge.Deformation((1.0, -2.0, 0.7), 4.0, shifts)


def test_bend_and_straighten_are_inverse() -> None:
    deformation = any_deformation()
    points = np.random.default_rng(2).uniform(-20.0, 30.0, (7, 11, 2))
    bent = deformation.bend(points)
    assert bent.shape == points.shape
    assert np.abs(bent - points).max() > 0.05
    np.testing.assert_allclose(deformation.straighten(bent), points, rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(deformation.bend(points[0, 0]), bent[0, 0])
    with pytest.raises(ValueError, match=r"points: must be of shape \(\.\.\., 2\)"):
        deformation.bend(np.zeros((3, 3)))


def test_shifts_that_are_all_equal_shift() -> None:
    shifts = np.full((4, 5, 2), (0.25, -0.5))
    deformation = gridmerge.Deformation((0.0, 0.0, np.pi / 2.0), 2.0, shifts)
    np.testing.assert_allclose(deformation.bend([3.0, 4.0]), [3.5, 4.25])
    assert deformation.strain_bound == 0.0
    np.testing.assert_array_equal(deformation.shifts, shifts)
    assert deformation.spacing == 2.0


@pytest.mark.parametrize(
    ("spacing", "shifts", "message"),
    [
        (1.0, np.zeros((4, 4)), "shifts: must be of shape"),
        (1.0, np.zeros((3, 4, 2)), "4 to 4096 columns and rows"),
        (0.0, np.zeros((4, 4, 2)), "spacing must be a positive"),
        (1.0, np.full((4, 4, 2), np.nan), "must be finite"),
        (1.0, np.random.default_rng(3).uniform(-3.0, 3.0, (4, 4, 2)), "may fold"),
    ],
)
def test_refuses_lattices_that_are_none(spacing: float, shifts: np.ndarray, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        gridmerge.Deformation((0.0, 0.0, 0.0), spacing, shifts)


def test_deformations_are_values() -> None:
    one, other = any_deformation(), any_deformation(2)
    assert one == any_deformation()
    assert one != other
    assert hash(one) == hash(any_deformation())
    zero, below = (
        gridmerge.Deformation((0.0, 0.0, 0.0), 1.0, np.full((4, 4, 2), one)) for one in (0.0, -0.0)
    )
    assert zero == below
    assert hash(zero) == hash(below)
    assert pickle.loads(pickle.dumps(one)) == one
    assert "6 x 5 points" in repr(one)


def test_elastic_merge(cli: Cli, tmp_path: Path) -> None:
    options = "--kind office --robots 3 --overlap 0.7 --drift 1 --others 0 --clutter 0 --seed 101"
    cli("simulate", *options.split(), "-o", tmp_path / "maps")
    maps = [str(tmp_path / "maps" / f"robot_{i}.yaml") for i in (1, 2, 3)]
    rigid = gridmerge.merge(maps)
    elastic = gridmerge.merge(maps, elastic=True)
    assert all(member.deformation is None for member in rigid.components[0].members)
    members = elastic.components[0].members
    assert [member.probability for member in members] == [
        member.probability for member in rigid.components[0].members
    ]
    assert elastic.components[0].omega is None
    points = np.random.default_rng(4).uniform(-10.0, 10.0, (50, 2))
    for member in members:
        assert member.deformation is not None
        placed = member.to_component(points)
        np.testing.assert_allclose(placed, member.transform.apply(member.deformation.bend(points)))
        np.testing.assert_allclose(member.to_map(placed), points, rtol=0.0, atol=1e-7)
    elastic.save(tmp_path / "saved")
    written = json.loads((tmp_path / "saved" / "transforms.json").read_text())["components"][0]["members"]
    for member, one in zip(members, written, strict=True):
        assert member.deformation is not None
        np.testing.assert_array_equal(
            np.array(one["deformation"]["shifts"]), member.deformation.shifts.reshape(-1)
        )
    again = pickle.loads(pickle.dumps(elastic))
    assert [one.deformation for one in again.components[0].members] == [one.deformation for one in members]
    with ProcessPoolExecutor(2) as executor:
        elsewhere = gridmerge.merge(maps, elastic=True, executor=executor)
    assert [one.deformation for one in elsewhere.components[0].members] == [
        one.deformation for one in members
    ]
    merger = gridmerge.Merger(elastic=True)
    for one in maps:
        merger.add(one)
    solved = pickle.loads(pickle.dumps(merger)).solve()
    assert [one.deformation for one in solved.components[0].members] == [one.deformation for one in members]
    with pytest.raises(ValueError, match="elastic needs 'joint'"):
        gridmerge.merge(maps, elastic=True, strategy="tree")
