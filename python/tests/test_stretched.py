# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import json
import pickle
from pathlib import Path

import gridmerge
import numpy as np
import pytest
from conftest import Cli

SCALE = 1.03


@pytest.fixture(scope="module")
def maps(cli: Cli, tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Three maps of one building, the last of which has a false resolution."""
    folder = tmp_path_factory.mktemp("stretched")
    options = "--kind office --robots 3 --overlap 0.7 --drift 0 --others 0 --clutter 0 --seed 101"
    cli("simulate", *options.split(), "-o", folder)
    last = folder / "robot_3.yaml"
    text = last.read_text()
    assert "resolution: 0.05\n" in text
    last.write_text(text.replace("resolution: 0.05\n", f"resolution: {0.05 * SCALE!r}\n"))
    return [str(folder / f"robot_{i}.yaml") for i in (1, 2, 3)]


def test_similarity_finds_the_scale(maps: list[str], tmp_path: Path) -> None:
    rigid = gridmerge.merge(maps)
    assert gridmerge.merge(maps, transform="rigid").components[0].members == rigid.components[0].members
    assert all(member.deformation is None for member in rigid.components[0].members)
    merged = gridmerge.merge(maps, transform="similarity")
    members = merged.components[0].members
    assert [one.probability for one in members] == [one.probability for one in rigid.components[0].members]
    scales = []
    points = np.random.default_rng(4).uniform(-5.0, 5.0, (50, 2))
    for member in members:
        deformation = member.deformation
        assert deformation is not None
        assert deformation.kind == "similarity"
        assert deformation.scale is not None
        assert deformation.matrix is not None
        scales.append(deformation.scale)
        linear, shift = deformation.matrix[:, :2], deformation.matrix[:, 2]
        np.testing.assert_allclose(linear.T @ linear, deformation.scale**2 * np.eye(2), rtol=0.0, atol=1e-9)
        placed = member.to_component(points)
        np.testing.assert_allclose(
            placed, member.transform.apply(points @ linear.T + shift), rtol=0.0, atol=1e-9
        )
        np.testing.assert_allclose(member.to_map(placed), points, rtol=0.0, atol=1e-7)
    assert abs(np.log(scales).sum()) < 1e-9
    assert scales[0] / scales[2] == pytest.approx(SCALE, abs=3e-3)
    assert scales[0] / scales[1] == pytest.approx(1.0, abs=3e-3)
    merged.save(tmp_path / "saved")
    written = json.loads((tmp_path / "saved" / "transforms.json").read_text())["components"][0]["members"]
    for member, one in zip(members, written, strict=True):
        assert member.deformation is not None
        assert one["deformation"]["kind"] == "similarity"
        assert one["deformation"]["scale"] == member.deformation.scale
        np.testing.assert_array_equal(np.array(one["deformation"]["matrix"]), member.deformation.matrix)
    again = pickle.loads(pickle.dumps(merged))
    assert [one.deformation for one in again.components[0].members] == [one.deformation for one in members]


def test_merger_takes_the_transform(maps: list[str]) -> None:
    expected = gridmerge.merge(maps, transform="affine").components[0].members
    assert [one.deformation.kind for one in expected if one.deformation is not None] == ["affine"] * 3
    merger = gridmerge.Merger(transform="affine")
    for one in maps:
        merger.add(one)
    solved = pickle.loads(pickle.dumps(merger)).solve()
    assert [one.deformation for one in solved.components[0].members] == [one.deformation for one in expected]


def test_elastic_has_two_names(maps: list[str]) -> None:
    by_flag = gridmerge.merge(maps, elastic=True).components[0].members
    for merged in (
        gridmerge.merge(maps, transform="elastic"),
        gridmerge.merge(maps, transform="elastic", elastic=True),
    ):
        assert merged.components[0].members == by_flag


def test_refuses_what_makes_no_sense(maps: list[str]) -> None:
    with pytest.raises(ValueError, match="must be one of rigid, similarity, affine, elastic, is 'conformal'"):
        gridmerge.merge(maps, transform="conformal")
    with pytest.raises(TypeError, match="transform: must be one of"):
        gridmerge.merge(maps, transform=1)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="elastic: contradicts the transform 'affine'"):
        gridmerge.merge(maps, transform="affine", elastic=True)
    with pytest.raises(ValueError, match="elastic: contradicts the transform 'rigid'"):
        gridmerge.Merger(transform="rigid", elastic=True)
    with pytest.raises(ValueError, match="strategy: similarity needs 'joint'"):
        gridmerge.merge(maps, transform="similarity", strategy="tree")


def test_deformations_that_bend_have_no_matrix() -> None:
    shifts = np.random.default_rng(1).uniform(-0.3, 0.3, (5, 6, 2))
    bent = gridmerge.Deformation((1.0, -2.0, 0.7), 4.0, shifts)
    assert (bent.kind, bent.scale, bent.matrix) == ("elastic", None, None)
    x, y = np.meshgrid(np.arange(4) - 1.0, np.arange(4) - 1.0)
    stretched = gridmerge.Deformation((0.0, 0.0, 0.0), 10.0, np.stack([0.2 * x, -0.1 * y], axis=-1))
    assert stretched.kind == "affine"
    assert stretched.scale == pytest.approx(np.sqrt(1.02 * 0.99))
    assert stretched.matrix is not None
    np.testing.assert_allclose(stretched.matrix, [[1.02, 0.0, 0.0], [0.0, 0.99, 0.0]], rtol=0.0, atol=1e-12)
