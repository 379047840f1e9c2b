# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _arguments
from ._core import Deformation as Core
from ._transform import PoseLike, Transform, to_pose


class Deformation:
    """A smooth deformation of a map that neither tears nor folds it.

    Shifts stand at the points of a square lattice, and between them a uniform cubic B-spline interpolates. See the
    formula in the documentation of merging.
    """

    __slots__ = ("_core",)
    _core: Core

    def __init__(self, frame: PoseLike, spacing: float, shifts: ArrayLike) -> None:
        """By a lattice in a map's frame.

        Args:
            frame: T_map_lattice, which takes the lattice's frame to the map's.
            spacing: of the lattice's points [m].
            shifts: of the points, in the lattice's directions [m]: an array of shape (rows, columns, 2).

        Raises ValueError for another shape, fewer than 4 rows or columns, numbers that are not finite, and shifts that
        differ so much that the map may fold.
        """
        given = np.ascontiguousarray(_arguments.array("shifts", shifts, np.float64))
        if given.ndim != 3 or given.shape[2] != 2:
            raise ValueError(f"shifts: must be of shape (rows, columns, 2), is {given.shape}")
        rows, columns, _ = given.shape
        self._core = Core(
            to_pose("frame", frame),
            _arguments.number("spacing", spacing),
            columns,
            rows,
            given.reshape(-1, 2),
        )

    @classmethod
    def _of(cls, core: Core) -> Deformation:
        made = cls.__new__(cls)
        made._core = core
        return made

    @property
    def frame(self) -> Transform:
        """T_map_lattice: takes the lattice's frame to the map's."""
        return Transform(*self._core.frame)

    @property
    def spacing(self) -> float:
        """Of the lattice's points [m]."""
        return self._core.spacing

    @property
    def shifts(self) -> NDArray[np.float64]:
        """Of the lattice's points, in its directions [m]: a new array of shape (rows, columns, 2)."""
        return np.asarray(self._core.shifts).reshape(self._core.rows, self._core.columns, 2)

    @property
    def kind(self) -> str:
        """What it does to a map: "similarity", "affine" or "elastic"."""
        return self._core.kind

    @property
    def matrix(self) -> NDArray[np.float64] | None:
        """The affine function that it is on its lattice: points p of the map's frame go to
        matrix[:, :2] @ p + matrix[:, 2]; a new array of shape (2, 3). None for an elastic one."""
        entries = self._core.matrix
        return None if entries is None else np.array(entries).reshape(2, 3)

    @property
    def scale(self) -> float | None:
        """By how much it enlarges lengths, the geometric mean over both axes; None for an elastic one."""
        return self._core.scale

    @property
    def strain_bound(self) -> float:
        """An upper bound of the shift's derivative (Frobenius norm); at most 0.5."""
        return self._core.strain_bound

    def bend(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points of the map's frame go, in the same frame [m]: an array of shape (..., 2), and so is the result.

        Raises ValueError for another shape.
        """
        given = to_points(points)
        return np.asarray(self._core.bend(given.reshape(-1, 2))).reshape(given.shape)

    def straighten(self, points: ArrayLike) -> NDArray[np.float64]:
        """Where points come from: the inverse of bend(), with the same arguments."""
        given = to_points(points)
        return np.asarray(self._core.straighten(given.reshape(-1, 2))).reshape(given.shape)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Deformation):
            return NotImplemented
        return (
            self.frame == other.frame
            and self.spacing == other.spacing
            and np.array_equal(self.shifts, other.shifts)
        )

    def __hash__(self) -> int:
        shifts = self.shifts + 0.0  # without -0.0, which equals 0.0
        return hash((self.frame, self.spacing, shifts.tobytes()))

    def __reduce__(self) -> tuple[type[Deformation], tuple[Transform, float, NDArray[np.float64]]]:
        return Deformation, (self.frame, self.spacing, self.shifts)

    def __repr__(self) -> str:
        return (
            f"Deformation({self._core.columns} x {self._core.rows} points, spacing={self.spacing:.3g}, "
            f"strain_bound={self.strain_bound:.2g})"
        )


def to_points(points: ArrayLike) -> NDArray[np.float64]:
    given = _arguments.array("points", points, np.float64)
    if given.ndim == 0 or given.shape[-1] != 2:
        raise ValueError(f"points: must be of shape (..., 2), is {given.shape}")
    return np.ascontiguousarray(given)
