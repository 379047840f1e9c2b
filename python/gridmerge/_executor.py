# SPDX-License-Identifier: Apache-2.0
"""Matches that an executor makes, wherever its workers are."""

from __future__ import annotations

import os
import queue
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import CancelledError, Executor, Future
from dataclasses import dataclass, field

from . import _arguments, _bag, _cache, _core, _tasks
from ._grid import OccupancyGrid
from ._repr import count
from ._tasks import MapSpec

TASK_SECONDS = 0.4
"""What a task is to take at most, so that an engine's few milliseconds for each count for little."""
_LEAST_TASK_SECONDS = 0.2  # an engine's few milliseconds still count for little
_TASKS_OF_A_ROUND = 64  # unless they would be shorter than that: workers that end early wait for the last one
MOST_ATTEMPTS = 3
"""At a task whose worker dies, or with which the engine fails."""
_MOST_WAITING = 1024  # tasks that the engine has at a time: it may have hundreds of workers
_MOST_BYTES_WAITING = 2**29  # of the maps that are sent with these tasks, unless one task has more
_MOST_PAIRS = 500  # of a task
_MOST_FOUND = 20_000  # pairs, some 1.5 kB each: the others' second look begins anew
_MOST_BYTES = 2**24  # of the maps that are sent with a task, unless one pair has more


class ExecutorError(RuntimeError):
    """An executor that does not do its work: it is broken, a task fails again and again, or a worker has another
    version of gridmerge. The message names the executor and the cause."""


@dataclass(frozen=True, slots=True)
class SharedMap:
    """A map as workers get it."""

    spec: MapSpec
    cells: int
    sent_bytes: int = 0
    """With each task that needs it; a path counts as nothing."""

    @property
    def content(self) -> str:
        return self.spec[-1]


def of_grid(grid: OccupancyGrid) -> SharedMap:
    """Sent with each task that needs it."""
    cells = grid.width * grid.height
    bytes_per_cell = 1 if grid.probability is None else 5
    return SharedMap(("grid", grid, _core.content_id(grid._core)), cells, cells * bytes_per_cell)


def of_map(grid: OccupancyGrid, is_file: bool) -> SharedMap:
    """A map as it was given: by its path, or itself. Workers may lack what reads bags of ROS 1."""
    where = grid._file if is_file else None
    if where is None or _bag.is_ros1(os.fsencode(where[0])):
        return of_grid(grid)
    file, topic = where
    return of_file(os.fsencode(f"{file}#/{topic}" if topic else file), grid._core)


def of_file(
    path: bytes, core: _core.Grid, resolution: float = 0.0, literal_thresholds: bool = False
) -> SharedMap:
    """A file that every worker sees under the same path, and the map that it holds."""
    return SharedMap(
        ("file", path, resolution, literal_thresholds, _core.content_id(core)), core.width * core.height
    )


@dataclass(frozen=True, slots=True)
class Wanted:
    """A match that is to be made, and who takes it."""

    fixed: SharedMap
    moving: SharedMap
    search: str
    take: Callable[[bytes], object]

    @property
    def cells(self) -> int:
        return self.fixed.cells + self.moving.cells

    @property
    def maps(self) -> frozenset[str]:
        """What both hold, whichever is called fixed."""
        return frozenset((self.fixed.content, self.moving.content))


@dataclass(slots=True)
class _Task:
    number: int
    wanted: list[Wanted]
    attempts: int = 0
    guess: float = 0.0
    sent_bytes: int = 0
    failures: list[str] = field(default_factory=list)


class MatchingExecutor:
    """Makes matches on an executor. What it gives depends neither on the executor nor on its failures."""

    def __init__(
        self, executor: object, accept: float, hypotheses: int, cache: _core.MatchCache | None = None
    ) -> None:
        submit = getattr(executor, "submit", None)
        if not callable(submit):
            raise TypeError(
                f"executor: must be a concurrent.futures.Executor, is {_arguments.kind_of(executor)}"
            )
        self._submit: Callable[..., Future[_tasks.Answer]] = submit
        self._name = type(executor).__name__
        self._accept = accept
        self._hypotheses = hypotheses
        self._cache = cache
        self._rates: dict[str, float] = {}  # seconds per cell of both maps, by search
        self._found: dict[frozenset[str], bytes] = {}  # by quick searches, for the look that may follow

    def make(
        self,
        wanted: Iterable[Wanted],
        progress: Callable[[int], object] | None = None,
        before: Callable[[_core.MatchCache], object] | None = None,
    ) -> None:
        """Makes all that the cache does not have; `take` of each is called in this thread, in any order. `progress` is
        told how many are there. `before` is called once a match is missing in the cache. When it ends early, by an
        error or Ctrl-C, what no worker has begun is cancelled."""
        waiting: deque[Wanted] = deque()
        found = 0
        for one in wanted:
            match = self._find(one)
            if match is None:
                waiting.append(one)
            else:
                one.take(match)
                found += 1
        if progress is not None and found > 0:
            progress(found)
        total = len(waiting)
        task_seconds = self._task_seconds(waiting)
        if waiting and self._cache is not None:
            self._cache.announce(self._accept)
            if before is not None:
                before(self._cache)
            _cache.warn(self._cache)  # before the work, which may take long
        again: deque[_Task] = deque()
        running: dict[Future[_tasks.Answer], _Task] = {}
        done: queue.SimpleQueue[Future[_tasks.Answer]] = queue.SimpleQueue()
        number = made = sent_bytes = 0
        try:
            while waiting or again or running:
                while (waiting or again) and len(running) < _MOST_WAITING:
                    if again:
                        task = again.popleft()
                    else:
                        task = self._next_task(number, waiting, task_seconds)
                        number += 1
                    if running and sent_bytes + task.sent_bytes > _MOST_BYTES_WAITING:
                        again.appendleft(task)
                        break
                    try:
                        future = self._start(task)
                    except Exception as error:
                        raise self._error(f"takes no task: {_describe(error)}", made, total) from error
                    running[future] = task
                    sent_bytes += task.sent_bytes
                    future.add_done_callback(done.put)
                try:
                    future = done.get(timeout=1.0)
                except queue.Empty:  # a moment for Ctrl-C where the wait cannot be interrupted
                    continue
                if future not in running:
                    continue  # told twice
                task = running.pop(future)
                sent_bytes -= task.sent_bytes
                try:
                    matches = self._matches_of(task, future)
                except _Failure as failure:
                    task.failures.append(str(failure))
                    if len(task.failures) >= MOST_ATTEMPTS:
                        raise self._error(
                            f"failed {MOST_ATTEMPTS} times with the same task: {failure}", made, total
                        ) from failure.__cause__
                    again.append(task)
                    continue
                for one, (match, seen) in zip(task.wanted, matches, strict=True):
                    one.take(match)
                    self._keep(one, match)
                    self._found.pop(one.maps, None)
                    if seen and len(self._found) < _MOST_FOUND:
                        self._found[one.maps] = seen
                made += len(matches)
                if progress is not None:
                    progress(found + made)
        finally:
            for future in running:
                future.cancel()

    def _key(self, one: Wanted) -> str:
        return _core.match_key(
            one.fixed.content, one.moving.content, one.search, self._accept, self._hypotheses
        )

    def _find(self, one: Wanted) -> bytes | None:
        return None if self._cache is None else self._cache.find(self._key(one))

    def _keep(self, one: Wanted, match: bytes) -> None:
        if self._cache is not None:
            self._cache.keep(self._key(one), match)

    def _guess(self, one: Wanted) -> float:
        """What its match takes [s]."""
        return self._rate(one.search) * one.cells

    def _task_seconds(self, waiting: Iterable[Wanted]) -> float:
        """What each task of a round is to take."""
        share = sum(map(self._guess, waiting)) / _TASKS_OF_A_ROUND
        return min(TASK_SECONDS, max(share, _LEAST_TASK_SECONDS))

    def _next_task(self, number: int, waiting: deque[Wanted], seconds: float) -> _Task:
        """The next pairs, about so many seconds of them."""
        task = _Task(number, [])
        sent: dict[str, int] = {}
        while waiting and len(task.wanted) < _MOST_PAIRS:
            one = waiting[0]
            guess = self._guess(one)
            with_it = sent | {map.content: map.sent_bytes for map in (one.fixed, one.moving)}
            if task.wanted and (task.guess + guess > seconds or sum(with_it.values()) > _MOST_BYTES):
                break
            sent = with_it
            task.wanted.append(waiting.popleft())
            task.guess += guess
        task.sent_bytes = sum(sent.values())
        return task

    def _start(self, task: _Task) -> Future[_tasks.Answer]:
        places: dict[str, int] = {}
        maps: list[MapSpec] = []
        for one in task.wanted:
            for map in (one.fixed, one.moving):
                if map.content not in places:
                    places[map.content] = len(maps)
                    maps.append(map.spec)
        pairs = []
        for one in task.wanted:
            found = self._found.get(one.maps, b"")
            pairs.append((places[one.fixed.content], places[one.moving.content], one.search, found))
        return self._submit(
            _tasks.match_pairs,
            _core.engine_id(),
            task.number,
            tuple(maps),
            tuple(pairs),
            self._accept,
            self._hypotheses,
        )

    def _matches_of(self, task: _Task, future: Future[_tasks.Answer]) -> list[_tasks.Made]:
        """Raises _Failure for what another attempt may mend, and FileError or ExecutorError for what none does."""
        try:
            answer = future.result()
        except CancelledError as error:
            raise _Failure("it was cancelled") from error
        except Exception as error:  # of the engine: what the task itself says is in its answer
            raise _Failure(_describe(error)) from error
        try:
            kind, number, content = answer
        except (TypeError, ValueError) as error:
            raise _Failure("its answer is none of a task") from error
        if number != task.number:
            raise _Failure("its answer is that of another task")
        if kind == "file":
            raise _core.FileError(str(content))
        if kind == "engine":
            raise ExecutorError(
                f"executor: a worker of {self._name} has the engine {content} of gridmerge, and this is "
                f"{_core.engine_id()}: the same version has to be installed on both sides"
            )
        if not isinstance(content, list) or len(content) != len(task.wanted):
            raise _Failure("its answer is none of a task")
        try:
            seconds = sum(map(_seconds_of, content))
        except (TypeError, ValueError) as error:
            raise _Failure(f"its answer {error}") from error
        self._learn(task, seconds)
        return content

    def _learn(self, task: _Task, seconds: float) -> None:
        search = task.wanted[0].search
        cells = sum(one.cells for one in task.wanted)
        if cells > 0 and seconds > 0.0:
            rate = self._rate(search)
            self._rates[search] = rate + 0.2 * (seconds / cells - rate)

    def _rate(self, search: str) -> float:
        return self._rates.setdefault(search, _core.seconds_per_cell(search))

    def _error(self, what: str, made: int, total: int) -> ExecutorError:
        return ExecutorError(
            f"executor: {self._name} {what} ({made} of {count(total, 'match', 'matches')} were made)"
        )


class _Failure(Exception):
    """Of one attempt at a task."""


def _seconds_of(made: _tasks.Made) -> float:
    """What the match took. Raises TypeError or ValueError for what is none."""
    match, found = made
    if not isinstance(found, bytes):
        raise TypeError("is none of a task")
    return _core.seconds_of(match)


def _describe(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def match_due(
    executor: MatchingExecutor,
    mergers: Sequence[tuple[_core.Merger, dict[int, SharedMap]]],
    progress: Callable[[float], object] | None = None,
) -> None:
    """Hands mergers the matches that are due, round after round, until none is."""
    rounds = _core.RoundsShare()
    told = False

    def before(cache: _core.MatchCache) -> None:
        nonlocal told
        for merger, _ in () if told else mergers:
            merger.warn_of_other_shards(cache)
        told = True

    while True:
        wanted = [
            Wanted(maps[fixed], maps[moving], search, _hand_in(merger, fixed, moving, search))
            for merger, maps in mergers
            for fixed, moving, search in merger.due()
        ]
        if not wanted:
            return
        share = None if progress is None else _share_of(rounds, len(wanted), progress)
        executor.make(wanted, share, before)


def _share_of(
    rounds: _core.RoundsShare, total: int, progress: Callable[[float], object]
) -> Callable[[int], object]:
    return lambda made: progress(rounds.of(made, total))


def _hand_in(merger: _core.Merger, fixed: int, moving: int, search: str) -> Callable[[bytes], object]:
    return lambda match: merger.hand_in(fixed, moving, search, match)


def check(executor: Executor | None) -> Executor | None:
    """An argument that is one, or None."""
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"executor: must be a concurrent.futures.Executor, is {_arguments.kind_of(executor)}")
    return executor
