# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import math

import numpy as np
import pytest
from gridmerge import Transform


def random_transform(rng: np.random.Generator) -> Transform:
    x, y = rng.uniform(-10.0, 10.0, size=2)
    return Transform(x, y, rng.uniform(-math.pi, math.pi))


@pytest.mark.parametrize("seed", range(20))
def test_matrices_agree_with_what_they_say(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = random_transform(rng), random_transform(rng)
    points = rng.uniform(-5.0, 5.0, size=(7, 2))
    homogeneous = np.column_stack([points, np.ones(7)])
    np.testing.assert_allclose((a.matrix @ homogeneous.T).T[:, :2], a.apply(points), atol=1e-12)
    np.testing.assert_allclose((a @ b).matrix, a.matrix @ b.matrix, atol=1e-12)
    np.testing.assert_allclose(a.inverse().matrix, np.linalg.inv(a.matrix), atol=1e-12)
    np.testing.assert_allclose(list(Transform.from_matrix(a.matrix)), list(a), atol=1e-15)
    assert a.matrix.shape == (3, 3) and a.matrix.dtype == np.float64


def test_unpacks_and_compares() -> None:
    transform = Transform(1, 2.0, 0.5)
    x, y, theta = transform
    assert (x, y, theta) == (1.0, 2.0, 0.5)
    assert isinstance(x, float)
    assert transform == Transform(1.0, 2.0, 0.5)
    assert len({transform, Transform(1.0, 2.0, 0.5)}) == 1


@pytest.mark.parametrize(
    ("given", "kept"),
    [(math.pi, math.pi), (-math.pi, math.pi), (3 * math.pi, math.pi), (7.0, 7.0 - 2 * math.pi)],
)
def test_theta_is_kept_within_a_turn(given: float, kept: float) -> None:
    assert Transform(0.0, 0.0, given).theta == pytest.approx(kept, abs=1e-15)


def test_points_of_any_leading_shape() -> None:
    transform = Transform(1.0, 2.0, math.pi / 2.0)
    np.testing.assert_allclose(transform.apply([1.0, 0.0]), [1.0, 3.0], atol=1e-15)
    assert transform.apply(np.zeros((4, 5, 2))).shape == (4, 5, 2)
    assert transform.apply(np.zeros((0, 2))).shape == (0, 2)


def test_composes_with_transforms_alone() -> None:
    with pytest.raises(TypeError):
        Transform(0.0, 0.0, 0.0) @ 3  # type: ignore[operator]
