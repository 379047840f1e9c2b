# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, cast

from . import _arguments, _core
from ._arguments import Progress
from ._grid import MapLike
from ._inputs import to_map
from ._repr import probability, short_pose, short_scale
from ._transform import Transform

Verdict: TypeAlias = Literal["accepted", "refused"]
"""Whether the best hypothesis is believed."""
Reason: TypeAlias = Literal[
    "none",
    "nothing_to_compare",
    "ambiguous",
    "contradiction",
    "too_little_overlap",
    "several",
    "contradicts_others",
    "over_budget",
]
"""Why a pair was refused: what, were it otherwise, would let the best hypothesis be accepted."""


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """One way in which the moving map may lie on the fixed one."""

    transform: Transform
    """T_fixed_moving."""
    score: float
    """Log-likelihood ratio "same place" against "unrelated" [nats]; larger is better."""
    probability: float
    """That this pose is the true one."""
    scale: float = 1.0
    """What the moving map is enlarged by before the transform applies: 1 unless match() was given `scale`."""

    def __repr__(self) -> str:
        return (
            f"Hypothesis(transform={short_pose(self.transform)}{short_scale(self.scale)}, score={self.score:.1f}, "
            f"{probability(self.probability)})"
        )


@dataclass(frozen=True, slots=True)
class PairPose:
    """A pose of a pair, and what its two maps say of it."""

    transform: Transform
    """T_fixed_moving, between the map frames."""
    probability: float
    """That it is the true pose."""
    acceptance_index: float
    """agreement / (agreement + disagreement); 0 when nothing overlaps."""
    agreement: int
    """Cells known in both maps and equal."""
    disagreement: int
    """Cells known in both maps and different."""
    overlap: float
    """Share of the smaller map's known cells that are known in both."""


@dataclass(frozen=True, slots=True)
class MatchResult(PairPose):
    """How the moving map lies on the fixed one, and whether that is to be believed.

    The pose is that of the best hypothesis, given for a refused pair too.
    """

    verdict: Verdict
    """On the best hypothesis."""
    reason: Reason
    """Why the pair was refused; "none" if it was accepted."""
    seconds: float
    """Wall time from maps in memory to the verdict."""
    hypotheses: tuple[Hypothesis, ...]
    """Distinct, best first; empty only when a map has nothing to go by."""
    scale: float = 1.0
    """What the moving map is enlarged by first: p_fixed = scale * R(theta) * p_moving + (x, y), theta, x and y those
    of the transform. 1 unless match() was given `scale`."""
    explanation: str = ""
    """What the verdict says, in words. Of the random walk, which knows no reasons, the acceptance index tells more."""

    @property
    def accepted(self) -> bool:
        """Whether the verdict is "accepted"."""
        return self.verdict == "accepted"

    def __repr__(self) -> str:
        why = "" if self.accepted else f": {self.reason}"
        return (
            f"MatchResult({self.verdict}{why}, transform={short_pose(self.transform)}{short_scale(self.scale)}, "
            f"{probability(self.probability)}, overlap={self.overlap:.2f}, "
            f"hypotheses: {len(self.hypotheses)})"
        )


def match(
    fixed: MapLike,
    moving: MapLike,
    *,
    threads: int = 0,
    accept: float | None = None,
    max_hypotheses: int = 10,
    search: str = "exhaustive",
    scale: tuple[float, float] | None = None,
    progress: Progress | None = None,
) -> MatchResult:
    """Finds how `moving` lies on `fixed`, searching every pose, and says whether to believe it.

    Args:
        fixed, moving: maps, paths of map files, or messages like nav_msgs/OccupancyGrid.
        threads: 0 = one per core. The result does not depend on it.
        accept: the verdict is "accepted" from this probability on, 0.95 if None. Of the random walk it is the
            acceptance index, 0.98 if None.
        max_hypotheses: how many distinct hypotheses the result lists.
        search: "exhaustive", a quick look at every pose, then a thorough one if that decides nothing; "quick" or
            "thorough", one of the two alone; "random-walk", the paper's search, as match_by_random_walk() makes it.
        scale: the smallest and the largest factor by which `moving` may be too small, as (0.5, 2.0) for an architect's
            plan or a map that is laid on one. The metres of `fixed` count. None: the maps have one scale. Not for
            the random walk.
        progress: called now and then, in the calling thread, with the share of the work that is done.

    Other Python threads run meanwhile, and Ctrl-C ends the work. Raises FileError for a file that is no map, and
    TypeError or ValueError, naming the argument, for anything else that is none.
    """
    result = _core.match(
        to_map("fixed", fixed)._core,
        to_map("moving", moving)._core,
        _arguments.threads(threads),
        None if accept is None else _arguments.share("accept", accept),
        _arguments.whole("max_hypotheses", max_hypotheses, 0, 2**31),
        _arguments.choice("search", search, tuple(_core.search_methods())),
        None if scale is None else _arguments.scales("scale", scale, search),
        _arguments.progress(progress),
    )
    return to_match_result(result, _core.DEFAULT_ACCEPT if accept is None else accept)


def to_joint_search(search: object) -> str:
    """A search that gives each pose a probability, which is what a joint merge weighs."""
    return _arguments.choice("search", search, tuple(_core.joint_search_methods()))


def is_joint(search: str) -> bool:
    """Whether a search that there is gives each pose a probability."""
    return search in _core.joint_search_methods()


def pair_pose(core: _core.PairPose) -> dict[str, Any]:
    """The fields of PairPose."""
    return {
        "transform": Transform(*core.transform),
        "probability": core.probability,
        "acceptance_index": core.acceptance_index,
        "agreement": core.agreement,
        "disagreement": core.disagreement,
        "overlap": core.overlap,
    }


def to_match_result(core: _core.MatchResult, accept: float = _core.DEFAULT_ACCEPT) -> MatchResult:
    return MatchResult(
        **pair_pose(core),
        verdict=cast(Verdict, core.verdict),
        reason=cast(Reason, core.reason),
        seconds=core.seconds,
        hypotheses=tuple(
            Hypothesis(Transform(*one.transform), one.score, one.probability, one.scale)
            for one in core.hypotheses
        ),
        scale=core.scale,
        explanation=core.explain(accept),
    )
