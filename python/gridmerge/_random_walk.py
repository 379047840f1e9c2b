# SPDX-License-Identifier: Apache-2.0
"""The paper's own search: the adaptive random walk of Birk & Carpin (2006)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _core
from ._arguments import Progress
from ._grid import MapLike
from ._inputs import to_map
from ._match import MatchResult, to_match_result
from ._measure import _POSE_COLUMNS, to_table
from ._repr import count, short_pose
from ._transform import PoseLike, Transform, to_pose, to_transform

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Trace: TypeAlias = Literal["none", "accepted", "all"]
"""Which samples of a walk are kept."""

_TRACES: tuple[Trace, ...] = ("none", "accepted", "all")
_TRACE_COLUMNS = (
    *(("step", np.int64), ("accepted", np.bool_), ("wide", np.bool_), ("measured", np.bool_)),
    ("delta", np.float64),
    *_POSE_COLUMNS,
)
_MOST = 2**53
_USUAL = _core.RandomWalkOptions()


@dataclass(frozen=True, slots=True, eq=False)
class Walk:
    """A random walk, and the best sample that it found."""

    c_lock: float
    """Weight of disagreement less agreement in Delta."""
    transform: Transform
    """T_fixed_moving of the best sample."""
    delta: float
    """Of the best sample: psi + c_lock * (disagreement - agreement)."""
    psi: float
    """Of the best sample: the sum of the four mean distances [cells]."""
    omega: int
    """Of the best sample: cells of the fixed map that have the same value in both maps, unknown included."""
    agreement: int
    """Of the best sample: cells known in both maps and equal."""
    disagreement: int
    """Of the best sample: cells known in both maps and different."""
    acceptance_index: float
    """Of the best sample: agreement / (agreement + disagreement)."""
    proposals: int
    """Steps that were tried."""
    accepted: int
    """Moves of the walk."""
    trace: NDArray[np.void]
    """The samples that were asked for, by step, the start (step 0) first.

    A structured array with the fields ``step``, ``accepted``, ``wide`` (drawn from all poses), ``measured``, ``delta``
    and those of measure_poses(). A sample that was refused without being measured has no figures: all are 0, and four
    terms are undefined. In a trace of "all", a wide sample that the walk went to later stands there once more.
    """

    def __repr__(self) -> str:
        return (
            f"Walk(c_lock={self.c_lock:g}, transform={short_pose(self.transform)}, delta={self.delta:.3f}, "
            f"acceptance_index={self.acceptance_index:.4f}, proposals={self.proposals}, "
            f"trace of {count(len(self.trace), 'sample')})"
        )


@dataclass(frozen=True, slots=True, eq=False)
class RandomWalkMatch:
    """What match_by_random_walk() gives."""

    result: MatchResult
    """As match() has it, but the acceptance index stands for the score and, though it is none, the probability."""
    walks: tuple[Walk, ...]
    """In the order in which they were made."""

    def __repr__(self) -> str:
        return f"RandomWalkMatch({self.result!r}, {count(len(self.walks), 'walk')})"


def match_by_random_walk(
    fixed: MapLike,
    moving: MapLike,
    *,
    c_locks: Sequence[float] = (0.0,),
    restarts: int | None = None,
    start: PoseLike | None = None,
    starts: tuple[int, int, float] = _USUAL.starts,
    wide_share: float = _USUAL.wide_share,
    temperature: float = _USUAL.temperature,
    cooling: float = _USUAL.cooling,
    memory: int = _USUAL.memory,
    first_step: float = _USUAL.first_step,
    patience: int = _USUAL.patience,
    max_proposals: int = _USUAL.max_proposals,
    accept: float = _USUAL.accept,
    least_common_cells: int = _USUAL.least_common_cells,
    max_hypotheses: int = _USUAL.max_hypotheses,
    seed: int = _USUAL.seed,
    threads: int = 0,
    trace: Trace = "none",
    progress: Progress | None = None,
) -> RandomWalkMatch:
    """Finds how `moving` lies on `fixed` by random walks that minimise Delta, as ``--search random-walk`` does.

    Args:
        fixed, moving: maps, paths of map files, or messages like nav_msgs/OccupancyGrid.
        c_locks: weights of disagreement less agreement in Delta, used by the walks in turn.
        restarts: how many walks, of which the one with the best acceptance index is kept; one for each c_lock if None.
        start: T_fixed_moving where all walks start, instead of the best poses of `starts`.
        starts: a grid of poses: rotations, shifts on each side of the centre in x and in y, and the cells between.
        wide_share: share of proposals that are drawn from all poses, in [0, 1].
        temperature: a sample that is worse by d is accepted with probability exp(-d / temperature); 0 climbs.
        cooling: the temperature is multiplied with this after every proposal, in (0, 1].
        memory: accepted steps that set mean and covariance of proposals, at least 4.
        first_step: standard deviation of proposals before anything is accepted [cells].
        patience: proposals without an improvement of the best sample after which a walk stops, at any temperature.
        max_proposals: it stops then in any case.
        accept: the verdict is "accepted" from this acceptance index on...
        least_common_cells: ...if so many cells are known in both maps.
        max_hypotheses: how many distinct hypotheses the result lists.
        seed: of the first walk; those of the others follow from it.
        threads: 0 = one per core. The result does not depend on it.
        trace: which samples the walks keep: "none", "accepted" or "all".
        progress: called with the share of walks that are done.

    Raises ValueError also for a start that puts the maps apart; else as match().
    """
    options = _core.RandomWalkOptions()
    if isinstance(c_locks, str) or not isinstance(c_locks, Sequence):
        raise TypeError(f"c_locks: must be a sequence of numbers, is {_arguments.kind_of(c_locks)}")
    options.c_locks = [_arguments.not_negative(f"c_locks[{i}]", c_lock) for i, c_lock in enumerate(c_locks)]
    if not options.c_locks:
        raise ValueError("c_locks: holds no number")
    options.restarts = (
        len(options.c_locks)
        if restarts is None
        else _arguments.whole("restarts", restarts, len(options.c_locks), 10**6)
    )
    if start is not None:
        options.start = to_pose("start", start)
    options.starts = _checked_starts(starts)
    options.wide_share = _arguments.share("wide_share", wide_share)
    options.temperature = _arguments.not_negative("temperature", temperature)
    options.cooling = _arguments.share("cooling", cooling)
    if options.cooling == 0.0:
        raise ValueError("cooling: must lie in (0, 1], is 0")
    options.memory = _arguments.whole("memory", memory, 4, _MOST)
    options.first_step = _arguments.not_negative("first_step", first_step)
    options.patience = _arguments.whole("patience", patience, 1, _MOST)
    options.max_proposals = _arguments.whole("max_proposals", max_proposals, 1, _MOST)
    options.accept = _arguments.share("accept", accept)
    options.least_common_cells = _arguments.whole("least_common_cells", least_common_cells, 0, _MOST)
    options.max_hypotheses = _arguments.whole("max_hypotheses", max_hypotheses, 0, 2**31)
    options.seed = _arguments.whole("seed", seed, 0, 2**64 - 1)
    options.threads = _arguments.threads(threads)
    options.trace = getattr(_core.WalkTrace, _arguments.choice("trace", trace, _TRACES))
    walked = _core.match_by_random_walk(
        to_map("fixed", fixed)._core, to_map("moving", moving)._core, options, _arguments.progress(progress)
    )
    return RandomWalkMatch(to_match_result(walked.match), tuple(_to_walk(walk) for walk in walked.walks))


def plot_walk(
    walk: Walk,
    fixed: MapLike,
    moving: MapLike,
    *,
    through: PoseLike | None = None,
    direction: float = 0.0,
    reach: float = 10.0,
    count: int = 201,
) -> Figure:
    """Draws a walk's trace, and the landscape about a pose: Delta, psi, agr - dis and omega along a cut.

    The walk has to have a trace. The cut goes through the pose `through`, the walk's best if None, along `direction`
    [rad, fixed map's frame], `reach` metres to both sides in `count` poses. Needs matplotlib:
    ``pip install 'gridmerge[plot]'``.
    """
    from . import _plot

    if not isinstance(walk, Walk):
        raise TypeError(f"walk: must be a Walk, is {_arguments.kind_of(walk)}")
    if walk.trace.size == 0:
        raise ValueError('walk: has no trace; match_by_random_walk(..., trace="all") keeps it')
    centre = walk.transform if through is None else to_transform("through", through)
    distance = _arguments.number("reach", reach)
    if distance <= 0.0:
        raise ValueError(f"reach: must be positive, is {reach}")
    return _plot.plot_walk(
        walk,
        to_map("fixed", fixed),
        to_map("moving", moving),
        centre,
        _arguments.number("direction", direction),
        distance,
        _arguments.whole("count", count, 2, 10**6),
    )


def _checked_starts(starts: object) -> tuple[int, int, float]:
    if not isinstance(starts, Sequence) or isinstance(starts, str) or len(starts) != 3:
        raise TypeError("starts: must be (rotations, shifts on each side, cells between them)")
    return (
        _arguments.whole("starts[0]", starts[0], 1, 10**6),
        _arguments.whole("starts[1]", starts[1], 0, 500),
        _arguments.not_negative("starts[2]", starts[2]),
    )


def _to_walk(core: _core.Walk) -> Walk:
    trace = to_table(core.trace(), _TRACE_COLUMNS)
    return Walk(
        c_lock=core.c_lock,
        transform=Transform(*core.transform),
        delta=core.delta,
        psi=core.psi,
        omega=core.omega,
        agreement=core.agreement,
        disagreement=core.disagreement,
        acceptance_index=core.acceptance_index,
        proposals=core.proposals,
        accepted=core.accepted,
        trace=trace,
    )
