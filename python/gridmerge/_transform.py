# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments

_RIGID = 1e-6


@dataclass(frozen=True, slots=True)
class Transform:
    """A rigid transform of the plane: a counter-clockwise turn by ``theta`` about the origin, then a shift by (x, y).

    Metres and radians; ``theta`` is kept in (-pi, pi]. Unpacks as ``x, y, theta = transform``.
    ``T_a_b @ T_b_c`` is ``T_a_c``.

    Raises TypeError for what is no number and ValueError for what is not finite.
    """

    x: float
    """[m]"""
    y: float
    """[m]"""
    theta: float
    """[rad], in (-pi, pi]."""

    def __post_init__(self) -> None:
        theta = _arguments.number("theta", self.theta)
        object.__setattr__(self, "x", _arguments.number("x", self.x))
        object.__setattr__(self, "y", _arguments.number("y", self.y))
        object.__setattr__(self, "theta", _normalized(theta))

    @classmethod
    def from_matrix(cls, matrix: ArrayLike) -> Transform:
        """Of a 3x3 matrix for homogeneous coordinates. Raises ValueError unless it is rigid (to 1e-6)."""
        return _from_array("matrix", _arguments.array("matrix", matrix))

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The 3x3 float64 matrix for homogeneous coordinates: ``matrix @ [x, y, 1]``."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        return np.array([[c, -s, self.x], [s, c, self.y], [0.0, 0.0, 1.0]])

    def inverse(self) -> Transform:
        """The transform the other way round."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        return Transform(-c * self.x - s * self.y, s * self.x - c * self.y, -self.theta)

    def apply(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where the transform takes points [m]: an array of shape (..., 2), and so is the result.

        Raises ValueError for another shape.
        """
        given = _arguments.array("points", points, np.float64)
        if given.ndim == 0 or given.shape[-1] != 2:
            raise ValueError(f"points: must be of shape (..., 2), is {given.shape}")
        c, s = math.cos(self.theta), math.sin(self.theta)
        x, y = given[..., 0], given[..., 1]
        return np.stack([c * x - s * y + self.x, s * x + c * y + self.y], axis=-1)

    def __matmul__(self, other: Transform) -> Transform:
        if not isinstance(other, Transform):
            return NotImplemented
        c, s = math.cos(self.theta), math.sin(self.theta)
        return Transform(
            c * other.x - s * other.y + self.x, s * other.x + c * other.y + self.y, self.theta + other.theta
        )

    def __iter__(self) -> Iterator[float]:
        return iter((self.x, self.y, self.theta))


PoseLike: TypeAlias = Transform | Sequence[float] | NDArray[np.floating]
"""A Transform, (x, y, theta), or a 3x3 matrix."""


def to_transform(name: str, value: object) -> Transform:
    """What a PoseLike says. Errors begin with `name`."""
    if isinstance(value, Transform):
        return value
    if isinstance(value, np.ndarray) and value.ndim == 2:
        return _from_array(name, value)
    what = "(x, y, theta), a Transform or a 3x3 matrix"
    values = _arguments.several(name, value, what)
    if len(values) != 3:
        raise TypeError(f"{name}: must be {what}")
    x, y, theta = values
    if all(isinstance(row, (Sequence, np.ndarray)) for row in values):
        return _from_array(name, _arguments.array(name, value))
    return Transform(
        _arguments.number(f"{name}.x", x),
        _arguments.number(f"{name}.y", y),
        _arguments.number(f"{name}.theta", theta),
    )


def to_pose(name: str, value: object) -> tuple[float, float, float]:
    """The same as the engine takes it."""
    transform = to_transform(name, value)
    return (transform.x, transform.y, transform.theta)


def _normalized(theta: float) -> float:
    if -math.pi < theta <= math.pi:
        return theta
    wrapped = math.remainder(theta, 2.0 * math.pi)
    return math.pi if wrapped <= -math.pi else wrapped


def _from_array(name: str, matrix: NDArray[np.generic]) -> Transform:
    if matrix.dtype.kind not in "iuf":
        raise TypeError(f"{name}: must hold numbers, holds {matrix.dtype}")
    if matrix.shape != (3, 3):
        raise ValueError(f"{name}: a matrix must be of shape (3, 3), is {matrix.shape}")
    m = matrix.astype(np.float64)
    if not np.isfinite(m).all():
        raise ValueError(f"{name}: must be finite")
    turn = m[:2, :2]
    rigid = np.allclose(turn @ turn.T, np.eye(2), rtol=0.0, atol=_RIGID) and np.linalg.det(turn) > 0.0
    if not rigid or not np.allclose(m[2], [0.0, 0.0, 1.0], rtol=0.0, atol=_RIGID):
        raise ValueError(f"{name}: must be a rigid transform: a turn and a shift, its last row 0, 0, 1")
    return Transform(float(m[0, 2]), float(m[1, 2]), math.atan2(m[1, 0], m[0, 0]))
