#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a merge of many maps takes on engines of any size: a replay of its tasks, beside the model of docs/scale.md.

usage: benchmark/scale.py MAP... [--max-missed SHARE] [--search NAME] [--workers N,N,...] [--times N,N,...]

Runs in an environment that has the package gridmerge. It merges the maps once, with one thread and with an executor
that runs each task in this process and notes what it takes. A replay then gives the tasks to N workers: each task goes
to the worker that is free first, and a round begins when the one before has ended. What the program itself does is no
worker's work. The cores of its own machine share the comparisons of signatures, and what comes after the last task:
maps that lie alone meet merged groups. Nobody shares the joint steps between rounds, and each task costs the program a
moment. Each task of several workers reads and prepares its maps anew: that is the most that workers can lose so.

`--times 10` replays a merge of ten times as many maps: of each task a hundred, packed into tasks as large as an
executor gets then, a hundred times the comparisons and the meetings with groups, and ten times the rest of what the
program does. The table has what the replay takes, and what the model says: what one machine shares, and matches by all.
"""

from __future__ import annotations

import argparse
import heapq
import sys
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field
from typing import Any

import gridmerge
from gridmerge import _tasks
from gridmerge._executor import TASK_SECONDS, of_map

CORES_OF_A_MACHINE = 16
SECONDS_OF_A_TASK = 0.003  # of the engine, in its worker: what docs/fleets.md has of Dask


@dataclass(frozen=True)
class Task:
    seconds: float  # CPU
    maps: int  # that it needs


@dataclass
class Round:
    before: float  # CPU seconds of the program before the first task
    tasks: list[Task] = field(default_factory=list)
    between: float = 0.0  # of the program, from the first task to the last


@dataclass
class Trace:
    rounds: list[Round]
    loading: float  # CPU seconds of reading all maps once
    a_map: float  # of reading one in a worker, and of what its matches share
    after: float  # of the program after the last task: most of it is meetings of maps with groups

    @property
    def comparisons(self) -> float:
        """And signatures, which are few beside them."""
        return max(self.rounds[0].before - self.loading, 0.0)

    @property
    def matches(self) -> float:
        return sum(task.seconds for one in self.rounds for task in one.tasks)


class _Noted(Future[Any]):
    """Tells when its answer is taken."""

    def __init__(self, taken: Callable[[], None]) -> None:
        super().__init__()
        self._taken = taken

    def result(self, timeout: float | None = None) -> Any:
        self._taken()
        return super().result(timeout)


class Recorder(Executor):
    """Runs each task at once, in this process. A task begins a new round if all answers before it were taken."""

    def __init__(self) -> None:
        self.rounds: list[Round] = []
        self._waiting = 0
        self._mark = time.process_time()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        began = time.process_time()
        own = began - self._mark
        if self._waiting == 0:
            self.rounds.append(Round(before=own))
        else:
            self.rounds[-1].between += own
        self._waiting += 1
        future = _Noted(self._take)
        future.set_result(fn(*args, **kwargs))
        self._mark = time.process_time()
        _, _, maps, *_ = args
        self.rounds[-1].tasks.append(Task(self._mark - began, len(maps)))
        return future

    def since_last_task(self) -> float:
        return time.process_time() - self._mark

    def _take(self) -> None:
        self._waiting -= 1


def record(paths: list[str], max_missed: float, search: str) -> tuple[Trace, gridmerge.MergeResult]:
    began = time.process_time()
    grids = [gridmerge.load(path) for path in paths]
    loading = time.process_time() - began
    specs = [of_map(grid, is_file=True).spec for grid in grids]
    began = time.process_time()
    for spec in specs:
        _tasks._prepare(spec)
    preparing = time.process_time() - began
    _tasks._shelf = _tasks._Shelf()
    recorder = Recorder()
    result = gridmerge.merge(paths, max_missed=max_missed, search=search, executor=recorder, threads=1)
    return Trace(recorder.rounds, loading, preparing / len(paths), recorder.since_last_task()), result


def packed(tasks: list[Task], times: int) -> Iterator[Task]:
    """Each so many times, in tasks of TASK_SECONDS where there is enough work."""
    if times == 1:
        yield from tasks
        return
    seconds, maps = 0.0, 0
    for task in tasks:
        for _ in range(times):
            if maps and seconds + task.seconds > TASK_SECONDS:
                yield Task(seconds, maps)
                seconds, maps = 0.0, 0
            seconds += task.seconds
            maps += task.maps
    if maps:
        yield Task(seconds, maps)


def replay(trace: Trace, workers: int, times: int) -> float:
    """Wall seconds with so many workers and so many times the maps."""
    reading = trace.a_map if workers > 1 else 0.0
    cores = min(workers, CORES_OF_A_MACHINE)
    now = times * trace.loading + times**2 * trace.comparisons / cores
    for number, one in enumerate(trace.rounds):
        if number > 0:
            now += one.before * times
        matches = sum(task.seconds for task in one.tasks)
        free = [now] * workers
        given = now
        for task in packed(one.tasks, times**2):
            given += one.between * task.seconds / max(matches, 1e-9)
            start = max(heapq.heappop(free), given)
            heapq.heappush(free, start + SECONDS_OF_A_TASK + reading * task.maps + task.seconds)
        now = max(max(free), given)
    return now + trace.after * times**2 / cores


def model(trace: Trace, workers: int, times: int) -> float:
    of_one_machine = (trace.comparisons + trace.after) / min(workers, CORES_OF_A_MACHINE)
    return times**2 * (of_one_machine + trace.matches / workers)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("maps", nargs="+", metavar="MAP")
    parser.add_argument("--max-missed", type=float, default=0.25, help="as of gridmerge merge")
    parser.add_argument("--search", default="exhaustive", help="as of gridmerge merge")
    parser.add_argument("--workers", default="1,2,16,1000", help="how many; several with commas")
    parser.add_argument("--times", default="1,10", help="so many times the maps; several with commas")
    arguments = parser.parse_args()

    trace, result = record(arguments.maps, arguments.max_missed, arguments.search)
    if not trace.rounds:
        sys.exit("nothing was matched: there is nothing to replay")
    sizes = ", ".join(str(len(one.tasks)) for one in trace.rounds)
    longest = max(task.seconds for one in trace.rounds for task in one.tasks)
    print(
        f"{len(arguments.maps)} maps, {len(result.components)} components; rounds of {sizes} tasks\n"
        f"CPU seconds: {trace.matches:.1f} of tasks, the longest {longest:.2f}; of the program "
        f"{trace.loading:.1f} to read maps, {trace.comparisons:.1f} to compare signatures, "
        f"{sum(one.before for one in trace.rounds[1:]):.1f} between rounds, "
        f"{sum(one.between for one in trace.rounds):.1f} beside tasks, {trace.after:.1f} at the end\n"
    )
    print("| maps | workers | replay [s] | model [s] | replay / model |")
    print("| --- | --- | --- | --- | --- |")
    for times in map(int, arguments.times.split(",")):
        for workers in map(int, arguments.workers.split(",")):
            took, said = replay(trace, workers, times), model(trace, workers, times)
            print(
                f"| {times * len(arguments.maps)} | {workers} | {took:.1f} | {said:.1f} | {took / said:.2f} |"
            )


if __name__ == "__main__":
    main()
