# SPDX-License-Identifier: Apache-2.0
"""What happens around long work: Ctrl-C, other threads, progress functions that raise."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from functools import partial
from pathlib import Path

import gridmerge
import numpy as np
import pytest

LONG_WORK = {
    "simulate": "gridmerge.simulate('office', size=(300, 250), robots=8, drift=0.5)",
    "simulate with overlap": "gridmerge.simulate('office', size=(200, 150), robots=8, overlap=0.4)",
    "merge": "gridmerge.merge(many)",
    "merge up the tree": "gridmerge.merge(many, strategy='tree')",
    "evaluate": "gridmerge.evaluate(pairs)",
    "Merger": "merger.solve()",
    "taking in large maps": "gridmerge.merge([large] * 300)",
    "taking in large maps one by one": "[merger.add(large) for _ in range(300)]",
    "matching large maps": "[gridmerge.match(large, large) for _ in range(100)]",
}
LONGEST_WAIT = {"taking in large maps": 0.5, "taking in large maps one by one": 0.5}  # [s]

PROGRAM = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a parent that ignores it, as nohup does, hands that down
import numpy as np
import gridmerge

folder = sys.argv[1]
grid = gridmerge.simulate("office", size=(25, 20), robots=1, others=0).maps[0].grid
small = gridmerge.OccupancyGrid(grid.to_numpy(), grid.resolution)
gridmerge.save(small, folder + "/small.yaml")
pairs = folder + "/pairs.tsv"
with open(pairs, "w") as table:
    table.write("fixed\\tmoving\\tx\\ty\\ttheta\\ttolerance\\n" + "small.yaml\\tsmall.yaml\\t0\\t0\\t0\\t1\\n" * 5000)
tiles = np.tile(grid.to_numpy(), (10, 10))
large = gridmerge.OccupancyGrid(tiles, 0.05) if "large" in sys.argv[2] else None
cells = grid.to_numpy()
walls = np.flatnonzero(cells == cells.max())
many = []  # all differ, since equal maps count once
for wall in walls[:60]:
    other = cells.copy()
    other.flat[wall] = 0
    many.append(gridmerge.OccupancyGrid(other, grid.resolution))
merger = gridmerge.Merger()
for one in many:
    merger.add(one)
print("begin", flush=True)
try:
    WORK
    print("ended before the interrupt", flush=True)
except KeyboardInterrupt:
    print("interrupted", flush=True)
print(gridmerge.match(small, small).accepted, flush=True)  # all is well afterwards
"""


@pytest.mark.parametrize("what", LONG_WORK)
def test_ctrl_c_ends_long_work(what: str, tmp_path: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM.replace("WORK", LONG_WORK[what]), str(tmp_path), what],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    hung = threading.Timer(60.0, process.kill)
    hung.start()
    try:
        assert process.stdout.readline() == "begin\n"
        time.sleep(0.5)
        begin = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == "interrupted\n"
        waited = time.monotonic() - begin
        assert process.stdout.readline() == "True\n"
        assert process.wait() == 0
    finally:
        hung.cancel()
        process.kill()
        process.stdout.close()
    print(f"{what}: {waited:.3f} s from the signal to KeyboardInterrupt")
    assert waited < LONGEST_WAIT.get(what, 5.0)  # without it, it would be minutes


DAEMON = """
import atexit, sys, threading, time

# Such functions are called last in, first out: this one when the package has stopped all work.
atexit.register(lambda: print(gridmerge.load(path).width > 0, gridmerge.match(grid, grid).accepted, flush=True))

import numpy as np
import gridmerge

path = sys.argv[1]
grid = gridmerge.simulate("office", size=(25, 20), robots=1, others=0).maps[0].grid
cells = np.zeros((4000, 4000), dtype=np.int8)
atexit.register(lambda: print(gridmerge.match(grid, grid).accepted, flush=True))

class Lingers:
    def __del__(self, sleep=time.sleep):  # while the interpreter takes itself apart
        sleep(0.2)

lingers = Lingers()

def work():
    while True:
        WORK

for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
"""
DAEMONS_WORK = {
    "merge": "gridmerge.merge([grid] * 60)",
    "match": "gridmerge.match(grid, grid)",
    "progress": "gridmerge.match(grid, grid, progress=lambda share: [time.sleep(0.001) for _ in range(9999)])",
    "load": "gridmerge.load(path)",
    "make": "gridmerge.OccupancyGrid(cells, 0.05)",
    "to_numpy": "grid.to_numpy()",
}


@pytest.mark.parametrize("what", DAEMONS_WORK)
@pytest.mark.parametrize("attempt", range(3))
def test_a_program_ends_while_daemon_threads_work(what: str, attempt: int, robots: list[str]) -> None:
    ended = subprocess.run(
        [sys.executable, "-c", DAEMON.replace("WORK", DAEMONS_WORK[what]), robots[0]],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "True\nTrue True\n", "")


def test_a_program_ends_while_a_daemon_thread_waits_for_a_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "map.yaml")
    program = """
import sys, threading, time
import gridmerge
threading.Thread(target=gridmerge.load, args=(sys.argv[1],), daemon=True).start()
time.sleep(0.1)
"""
    ended = subprocess.run(
        [sys.executable, "-c", program, tmp_path / "map.yaml"], timeout=30, capture_output=True, check=False
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, b"", b"")


def test_other_threads_run_meanwhile() -> None:
    steps: list[float] = []
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            steps.append(time.monotonic())
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    begin = time.monotonic()
    gridmerge.simulate("office", size=(40, 30), robots=2, others=0, seed=4, threads=1)
    end = time.monotonic()
    done.set()
    other.join()
    during = [step for step in steps if begin < step < end]
    # A thread that is kept out for all of the work, or for most of it, leaves a gap as long as that.
    gaps = np.diff([begin, *during, end])
    assert gaps.max() < 0.5 * (end - begin)
    assert len(during) > 10


def test_results_are_the_same_from_several_threads(robots: list[str]) -> None:
    expected = gridmerge.match(*robots[:2]).hypotheses
    results: list[object] = []

    def work() -> None:
        for _ in range(3):
            results.append(gridmerge.match(*robots[:2]).hypotheses)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected] * 12


def test_a_merger_refuses_a_second_thread(robots: list[str]) -> None:
    merger = gridmerge.Merger()
    for path in robots * 3:
        merger.add(path)
    refusals: list[RuntimeError] = []

    def intrude(share: float) -> None:
        def add() -> None:
            try:
                merger.add(robots[0])
            except RuntimeError as error:
                refusals.append(error)

        other = threading.Thread(target=add)
        other.start()
        other.join()

    merger.solve(progress=intrude)
    assert refusals and str(refusals[0]) == "the Merger is at work"


def test_a_merger_refuses_its_own_progress(robots: list[str]) -> None:
    merger = gridmerge.Merger()
    merger.add(robots[0])
    with pytest.raises(RuntimeError, match="at work"):
        merger.solve(progress=lambda share: merger.add(robots[1]))
    merger.add(robots[1])
    assert merger.solve().complete


def test_a_merger_is_as_it_was_after_an_interrupt() -> None:
    class Interrupt(Exception):
        pass

    def interrupt(number: int, frame: object) -> None:
        raise Interrupt

    cells = np.zeros((2000, 2000), dtype=np.int8)
    grids = [gridmerge.OccupancyGrid(cells, resolution) for resolution in (0.05, 0.1)]
    merger = gridmerge.Merger()
    first = merger.add(grids[0], name="first")
    interrupted = 0
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        for i in range(40):
            try:
                signal.setitimer(signal.ITIMER_REAL, 0.0005 + 0.0005 * (i // 2))
                if i % 2:
                    merger.add(grids[0])
                else:
                    merger.update(first, grids[1])
                    signal.setitimer(signal.ITIMER_REAL, 0.0)
                    merger.update(first, grids[0])
                signal.setitimer(signal.ITIMER_REAL, 0.0)
            except Interrupt:
                interrupted += 1
        for added in merger.ids[1:]:
            merger.remove(added)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert interrupted
    result = merger.solve()
    assert (merger.ids, result.names, result.maps) == ((first,), ("first",), (grids[0],))
    assert [one.name for one in result.left_out] == ["first"]
    assert result._core.maps[0].resolution == 0.05


def test_an_exception_of_progress_ends_the_work() -> None:
    class Enough(Exception):
        pass

    def stop(share: float) -> None:
        raise Enough(share)

    with pytest.raises(Enough):
        gridmerge.merge(
            [gridmerge.simulate("apartment", size=(15, 10), robots=1).maps[0].grid] * 40, progress=stop
        )


def test_the_share_never_falls_though_matches_come_in_rounds(robots: list[str], elsewhere: str) -> None:
    merger = gridmerge.Merger(threads=1)
    for path in (*robots, elsewhere):
        merger.add(path)
    for solve in (merger.solve, partial(gridmerge.merge, [*robots, elsewhere], threads=1)):
        shares: list[float] = []
        solve(progress=shares.append)
        assert shares == sorted(shares) and shares[-1] == 1.0


def test_progress_is_called_in_the_calling_thread(robots: list[str]) -> None:
    callers: set[int] = set()
    shares: list[float] = []

    def note(share: float) -> None:
        callers.add(threading.get_ident())
        shares.append(share)

    gridmerge.merge(robots * 4, progress=note)
    assert callers == {threading.get_ident()}
    assert len(shares) > 1
    assert shares == sorted(shares) and shares[-1] == 1.0
