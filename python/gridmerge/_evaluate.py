# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import cast

from . import _arguments, _core, _inputs
from ._arguments import Progress
from ._grid import to_resolution
from ._match import Reason, Verdict
from ._merge import Strategy
from ._repr import count, probability, shortened


@dataclass(frozen=True, slots=True)
class PairCounts:
    """Pairs of maps of one place."""

    total: int
    """How many pairs there are."""
    accepted_correct: int
    """Pairs that are accepted at the true pose."""
    accepted_wrong: int
    """Pairs that are accepted at another pose."""
    refused: int
    """Pairs that are not accepted."""
    best_correct: int
    """The best hypothesis is correct, accepted or not."""


@dataclass(frozen=True, slots=True)
class NegativeCounts:
    """Pairs of maps with no common place: the only right answer is to refuse."""

    total: int
    """How many such pairs there are."""
    accepted: int
    """Of them, those that are accepted, all of them wrongly."""


@dataclass(frozen=True, slots=True)
class SetCounts:
    """Sets of maps that were merged."""

    total: int
    """How many sets there are."""
    maps: int
    """Maps of all sets together."""
    maps_correct: int
    """Maps that lie where they should, relative to the member that makes most maps of its component correct."""
    maps_wrong: int
    """Maps that were joined to others and lie elsewhere."""
    maps_left_out: int
    """Maps that lie alone."""
    complete: int
    """Sets with every map correct."""


@dataclass(frozen=True, slots=True)
class TimeSummary:
    """Wall times of the matches [s]."""

    median: float
    """Half of the matches took no longer [s]."""
    p90: float
    """Nine of ten matches took no longer [s]."""
    max: float
    """The longest match [s]."""


@dataclass(frozen=True, slots=True)
class MatchCase:
    """How one pair went."""

    fixed: str
    """As the table writes it."""
    moving: str
    """As the table writes it."""
    negative: bool
    """Whether the maps have no common place."""
    tier: str
    """How hard the pair is, in the table's own words; empty where it has none."""
    verdict: Verdict
    """On the best hypothesis."""
    reason: Reason
    """Why the pair was refused; "none" if it was accepted."""
    probability: float
    """That the best hypothesis is the true pose."""
    error: float | None
    """Root mean square displacement of the best hypothesis [m]; None for a negative, and without a hypothesis."""
    tolerance: float | None
    """Largest error of a correct hypothesis [m]; None for a negative."""
    correct: bool | None
    """Whether the best hypothesis is the true pose; None for a negative."""
    seconds: float
    """Wall time from maps in memory to the verdict."""

    def __repr__(self) -> str:
        right = self.verdict == "refused" if self.negative else self.correct
        error = "" if self.error is None else f", error={self.error:.3f}"
        return (
            f"MatchCase({shortened(self.fixed)}, {shortened(self.moving)}, {self.verdict}, "
            f"{'negative, ' if self.negative else ''}{'right' if right else 'wrong'}{error}, "
            f"{probability(self.probability)})"
        )


@dataclass(frozen=True, slots=True)
class SetCase:
    """How one set of maps went."""

    name: str
    """Of the set, as the table writes it."""
    maps: int
    """How many maps it has."""
    correct: int
    """Maps that lie where they should."""
    wrong: int
    """Maps that were joined to others and lie elsewhere."""
    left_out: int
    """Maps that lie alone."""


@dataclass(frozen=True, slots=True)
class Evaluation:
    """The engine's answers, held against the truth."""

    pairs: PairCounts
    """Of the pairs that have a true pose."""
    negatives: NegativeCounts
    """Of the pairs that have no common place."""
    sets: SetCounts
    """Of the sets that were merged."""
    seconds: TimeSummary
    """Of the matches of pairs and negatives."""
    cases: tuple[MatchCase, ...]
    """The pairs, then the negatives, each in the table's order."""
    set_cases: tuple[SetCase, ...]
    """The sets, in the table's order."""
    _core: _core.Evaluation = field(repr=False, compare=False)

    def __repr__(self) -> str:
        pairs, negatives, sets = self.pairs, self.negatives, self.sets
        parts = (
            (
                pairs.total,
                f"{pairs.accepted_correct} of {count(pairs.total, 'pair')} right, "
                f"{pairs.accepted_wrong} wrong, {pairs.refused} refused",
            ),
            (negatives.total, f"{negatives.accepted} of {count(negatives.total, 'negative')} accepted"),
            (sets.total, f"{sets.complete} of {count(sets.total, 'set')} complete"),
        )
        return f"Evaluation({'; '.join(text for total, text in parts if total > 0)})"

    def to_json(self) -> str:
        """The text that `gridmerge evaluate --json` writes."""
        return self._core.to_json()

    def summary(self) -> str:
        """The table that `gridmerge evaluate` prints."""
        return self._core.summary()


def evaluate(
    pairs: str | os.PathLike[str] | None = None,
    negatives: str | os.PathLike[str] | None = None,
    sets: str | os.PathLike[str] | None = None,
    *,
    strategy: Strategy = "joint",
    threads: int = 0,
    accept: float = _core.DEFAULT_ACCEPT,
    resolution: float | None = None,
    literal_thresholds: bool = False,
    progress: Progress | None = None,
) -> Evaluation:
    """Matches and merges maps whose truth is known, and holds the answers against it.

    Args:
        pairs: table (TSV) of pairs of maps with true transforms.
        negatives: table of pairs with no common place.
        sets: table of sets of maps to merge, with true poses. At least one of the three is needed.
        strategy, threads, accept: as for merge().
        resolution, literal_thresholds: how map files are read, as for load(); the resolution is that of bare images.
        progress: called now and then, in the calling thread, with the share of the work that is done.

    `gridmerge evaluate --help` says what the tables hold; Simulation.save() writes them. Other Python threads run
    meanwhile, and Ctrl-C ends the work. Raises FileError for a table or map that cannot be read, and TypeError or
    ValueError for other mistakes.
    """
    if pairs is None and negatives is None and sets is None:
        raise ValueError("pairs, negatives, sets: at least one of them is needed")
    core = _core.evaluate(
        None if pairs is None else _arguments.path("pairs", pairs),
        None if negatives is None else _arguments.path("negatives", negatives),
        None if sets is None else _arguments.path("sets", sets),
        _arguments.threads(threads),
        _arguments.share("accept", accept),
        _arguments.choice("strategy", strategy, ("joint", "tree")) == "tree",
        0.0 if resolution is None else to_resolution("resolution", resolution),
        bool(literal_thresholds),
        _arguments.progress(progress),
    )
    _inputs.warn(core.warnings)
    return _to_evaluation(core)


def _to_evaluation(core: _core.Evaluation) -> Evaluation:
    pairs, negatives, sets, seconds = core.pairs, core.negatives, core.sets, core.seconds
    return Evaluation(
        pairs=PairCounts(
            pairs.total, pairs.accepted_correct, pairs.accepted_wrong, pairs.refused, pairs.best_correct
        ),
        negatives=NegativeCounts(negatives.total, negatives.accepted),
        sets=SetCounts(
            sets.total, sets.maps, sets.maps_correct, sets.maps_wrong, sets.maps_left_out, sets.complete
        ),
        seconds=TimeSummary(seconds.median, seconds.p90, seconds.max),
        cases=tuple(_to_match_case(match) for match in core.matches),
        set_cases=tuple(
            SetCase(one.name, one.maps, one.correct, one.wrong, one.left_out) for one in core.set_outcomes
        ),
        _core=core,
    )


def _to_match_case(match: _core.MatchOutcome) -> MatchCase:
    return MatchCase(
        fixed=match.fixed,
        moving=match.moving,
        negative=match.negative,
        tier=match.tier,
        verdict=cast(Verdict, match.verdict),
        reason=cast(Reason, match.reason),
        probability=match.probability,
        error=match.error,
        tolerance=match.tolerance,
        correct=None if match.negative else match.correct,
        seconds=match.seconds,
    )
