# SPDX-License-Identifier: Apache-2.0
"""Maps that are sent to an executor: how many bytes are on the way at a time."""

from __future__ import annotations

import pickle
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from gridmerge import _executor
from test_executor import answer


@pytest.fixture(scope="module")
def four(robots: list[str], elsewhere: str) -> list[str]:
    return [*robots, elsewhere]


@pytest.fixture(autouse=True)
def small_tasks(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that there are several."""
    monkeypatch.setattr(_executor, "TASK_SECONDS", 1e-9)


class OnTheWay(Executor):
    """Counts the bytes of tasks that are not done yet; does one whenever as many wait as may."""

    def __init__(self) -> None:
        self.most = self.tasks = 0
        self._sent: list[tuple[int, Callable[[], None]]] = []
        self._lock = threading.Lock()
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        with self._lock:
            self.tasks += 1
            self._sent.append((len(pickle.dumps(args)), lambda: future.set_result(task(*args, **kwargs))))
            self.most = max(self.most, sum(size for size, _ in self._sent))
        return future

    def _run(self) -> None:
        while not self._is_over.wait(0.02):
            if self._sent:
                self._sent[0][1]()
                with self._lock:
                    self._sent.pop(0)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        self._is_over.set()


def test_bytes_of_maps_on_the_way_are_bounded(
    four: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    grids = [gridmerge.load(path) for path in four]
    expected = answer(gridmerge.merge(grids), tmp_path / "plain")
    largest = sum(sorted(len(pickle.dumps(grid)) for grid in grids)[-2:])
    with OnTheWay() as free:
        assert answer(gridmerge.merge(grids, executor=free), tmp_path / "free") == expected
    assert free.most > 3 * largest
    most = 2 * largest
    monkeypatch.setattr(_executor, "_MOST_BYTES_WAITING", most)
    with OnTheWay() as bounded:
        assert answer(gridmerge.merge(grids, executor=bounded), tmp_path / "bounded") == expected
    assert bounded.tasks == free.tasks
    assert largest < bounded.most < most + 20_000  # and little beside the maps
    monkeypatch.setattr(_executor, "_MOST_BYTES_WAITING", 1)  # one task at a time all the same
    with OnTheWay() as alone:
        assert answer(gridmerge.merge(grids, executor=alone), tmp_path / "alone") == expected
    with OnTheWay() as paths:
        assert answer(gridmerge.merge(four, executor=paths), tmp_path / "paths")[1] == expected[1]
    assert paths.most < largest


def test_maps_with_probabilities_count_as_more_bytes(robots: list[str]) -> None:
    grid = gridmerge.load(robots[0])
    probability = np.where(grid.cells == 0, np.nan, 0.5).astype(np.float32)
    with_more = gridmerge.OccupancyGrid.from_cells(grid.cells, grid.resolution, probability=probability)
    for one in (grid, with_more):
        sent = len(pickle.dumps(one))
        assert abs(_executor.of_grid(one).sent_bytes - sent) < 2000
    assert _executor.of_map(grid, True).sent_bytes == 0
