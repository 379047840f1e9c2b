# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import TypeAlias, cast

from . import _arguments, _cache, _core, _executor, _inputs
from ._arguments import Progress
from ._grid import to_resolution
from ._match import Reason, Verdict, is_joint
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
    _json: str = field(repr=False, compare=False)
    _summary: str = field(repr=False, compare=False)

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
        return self._json

    def summary(self) -> str:
        """The table that `gridmerge evaluate` prints."""
        return self._summary


def evaluate(
    pairs: str | os.PathLike[str] | None = None,
    negatives: str | os.PathLike[str] | None = None,
    sets: str | os.PathLike[str] | None = None,
    *,
    strategy: Strategy = "joint",
    threads: int = 0,
    accept: float | None = None,
    search: str = "exhaustive",
    resolution: float | None = None,
    literal_thresholds: bool = False,
    executor: Executor | None = None,
    cache: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Evaluation:
    """Matches and merges maps whose truth is known, and holds the answers against it.

    Args:
        pairs: table (TSV) of pairs of maps with true transforms.
        negatives: table of pairs with no common place.
        sets: table of sets of maps to merge, with true poses. At least one of the three is needed. All pairs of a set
            are matched, however many maps it has: there is no `max_missed` as that of merge().
        strategy, threads, accept, search: as for merge().
        resolution, literal_thresholds: how map files are read, as for load(); the resolution is that of bare images.
        executor: makes the matches, as for merge(): workers read the maps under the same paths. Needs "joint".
        cache: a directory in which matches are kept, as for merge(). Not for the random walk.
        progress: called now and then, in the calling thread, with the share of the work that is done.

    `gridmerge evaluate --help` says what the tables hold; Simulation.save() writes them. Other Python threads run
    meanwhile, and Ctrl-C ends the work. Raises FileError for a table or map that cannot be read, and for a cache that
    cannot be written to. Raises ExecutorError for an executor that fails, and TypeError or ValueError for other
    mistakes.
    """
    if pairs is None and negatives is None and sets is None:
        raise ValueError("pairs, negatives, sets: at least one of them is needed")
    up_the_tree = _arguments.choice("strategy", strategy, ("joint", "tree")) == "tree"
    if _executor.check(executor) is not None and up_the_tree:
        raise ValueError("executor: needs the strategy 'joint': a tree's matches wait for each other")
    search = _arguments.choice("search", search, tuple(_core.search_methods()))
    if not is_joint(search) and not up_the_tree:
        raise ValueError(f"search: {search!r} needs the strategy 'tree': it has no probability")
    if not is_joint(search) and cache is not None:
        raise ValueError(f"cache: does not go with the search {search!r}")
    paths = [
        None if table is None else _arguments.path(name, table)
        for name, table in (("pairs", pairs), ("negatives", negatives), ("sets", sets))
    ]
    threads = _arguments.threads(threads)
    checked_accept = None if accept is None else _arguments.share("accept", accept)
    cell = 0.0 if resolution is None else to_resolution("resolution", resolution)
    told = _arguments.progress(progress)
    truth = _core.read_truth(*paths)
    kept = _cache.to_cache(cache)
    if executor is None:
        core = _core.evaluate(
            truth,
            threads,
            checked_accept,
            up_the_tree,
            search,
            cell,
            bool(literal_thresholds),
            kept,
            told,
        )
    else:
        accepted_from = _core.DEFAULT_ACCEPT if checked_accept is None else checked_accept
        answers = _Answers(executor, threads, accepted_from, search, cell, bool(literal_thresholds), kept)
        matches, merges = answers.of(truth, told)
        core = _core.evaluate_answers(truth, matches, merges, accepted_from, cell, bool(literal_thresholds))
        if told is not None:
            told(1.0)
    _inputs.warn(core.warnings)
    _cache.close(kept)
    return _to_evaluation(core)


_TruthMap: TypeAlias = tuple[bytes, str]
"""A map's path, and the line of the table that names it."""

_MOST_CELLS = 2**27  # of the sets that are merged at a time


class _Answers:
    """What the engine says of maps whose truth is known, by way of an executor."""

    def __init__(
        self,
        executor: Executor,
        threads: int,
        accept: float,
        search: str,
        resolution: float,
        literal_thresholds: bool,
        cache: _core.MatchCache | None,
    ) -> None:
        self._executor = executor
        self._threads = threads
        self._accept = accept
        self._search = search
        self._cache = cache
        self._reading = (resolution, literal_thresholds)
        self._shared: dict[bytes, _executor.SharedMap] = {}

    def of(
        self, truth: _core.Truth, progress: Callable[[float], object] | None
    ) -> tuple[list[bytes], list[_core.Merged]]:
        """Of the pairs and negatives, and of the sets, each in the tables' order."""
        pairs, sets = truth.matches, truth.sets
        total = len(pairs) + len(sets)

        def told(done: float) -> None:
            if progress is not None:
                progress(done / total)

        def merged_at(done: int, some: int) -> Callable[[float], object]:
            return lambda share: told(len(pairs) + done + share * some)

        matches = self._match(pairs, told)
        merges: list[_core.Merged] = []
        some: list[list[_TruthMap]] = []
        cells = 0
        for members in sets:
            size = sum(self._share(member).cells for member in members)
            if some and cells + size > _MOST_CELLS:
                merges += self._merge(some, merged_at(len(merges), len(some)))
                some, cells = [], 0
            some.append(members)
            cells += size
        merges += self._merge(some, merged_at(len(merges), len(some)))
        return matches, merges

    def _match(
        self, pairs: list[tuple[_TruthMap, _TruthMap]], told: Callable[[float], object]
    ) -> list[bytes]:
        matches = [b""] * len(pairs)

        def keep(place: int) -> Callable[[bytes], object]:
            return lambda match: matches.__setitem__(place, match)

        wanted = [
            _executor.Wanted(self._share(fixed), self._share(moving), self._search, keep(i))
            for i, (fixed, moving) in enumerate(pairs)
        ]
        matching = _executor.MatchingExecutor(
            self._executor, self._accept, _core.DEFAULT_MAX_HYPOTHESES, self._cache
        )
        matching.make(wanted, told)
        return matches

    def _merge(self, sets: list[list[_TruthMap]], told: Callable[[float], object]) -> list[_core.Merged]:
        mergers: list[tuple[_core.Merger, dict[int, _executor.SharedMap]]] = []
        for members in sets:
            merger = _core.Merger(
                self._threads,
                self._accept,
                _core.DEFAULT_MAX_FALSE_JOINS,
                _core.DEFAULT_MAX_MISSED,
                0.0,
                "rigid",
                self._search,
            )
            shared = {merger.add(self._load(member), None): self._share(member) for member in members}
            mergers.append((merger, shared))
        if mergers:
            matching = _executor.MatchingExecutor(self._executor, *mergers[0][0].match_options(), self._cache)
            _executor.match_due(matching, mergers, told)
        return [merger.solve(None, None) for merger, _ in mergers]

    def _share(self, map: _TruthMap) -> _executor.SharedMap:
        path, _ = map
        if path not in self._shared:
            self._shared[path] = _executor.of_file(os.path.abspath(path), self._load(map), *self._reading)
        return self._shared[path]

    def _load(self, map: _TruthMap) -> _core.Grid:
        path, named_at = map
        try:
            return _core.load_regular(path, *self._reading)
        except _core.FileError as error:
            raise _core.FileError(f"{error} ({named_at} names it)" if named_at else str(error)) from None


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
        _json=core.to_json(),
        _summary=core.summary(),
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
