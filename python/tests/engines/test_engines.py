# SPDX-License-Identifier: Apache-2.0
"""Real engines, each on this machine alone: Dask and MPI. Skipped where they are not installed."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gridmerge
import pytest
from gridmerge import _executor

sys.path.insert(0, str(Path(__file__).parent))
import programs
from programs import MAPS, answer, read_answer


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, bytes]:
    return answer(gridmerge.merge(MAPS), tmp_path_factory.mktemp("plain"))


@pytest.fixture(autouse=True)
def small_tasks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_executor, "TASK_SECONDS", 1e-9)


@pytest.fixture
def distributed() -> Any:
    return pytest.importorskip("distributed", reason="Dask is not installed (pip install distributed)")


def test_dask_gives_the_same_bits(distributed: Any, expected: tuple[str, bytes], tmp_path: Path) -> None:
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        executor = client.get_executor()
        assert answer(gridmerge.merge(MAPS, executor=executor), tmp_path / "by_path") == expected
        grids = [gridmerge.load(path) for path in MAPS]
        assert answer(gridmerge.merge(grids, executor=executor), tmp_path / "by_map") == expected


@contextmanager
def _process(arguments: list[str], folder: Path) -> Iterator[subprocess.Popen[bytes]]:
    environment = os.environ | {"PYTHONPATH": str(Path(programs.__file__).parent)}
    with open(folder / "log", "ab") as log:
        process = subprocess.Popen(
            [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]],
            stdout=log,
            stderr=log,
            env=environment,
            cwd=folder,
        )
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def test_a_dask_worker_that_is_killed_costs_nothing_but_time(
    distributed: Any, expected: tuple[str, bytes], tmp_path: Path
) -> None:
    told = tmp_path / "scheduler.json"
    scheduler = ["dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard"]
    worker = ["dask_worker", "--scheduler-file", str(told), "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    worker += ["--host", "127.0.0.1"]
    with (
        _process([*scheduler, "--scheduler-file", str(told)], tmp_path),
        _process(worker, tmp_path) as one,
        _process(worker, tmp_path),
    ):
        for _ in range(120):
            if told.exists():
                break
            time.sleep(0.5)
        with distributed.Client(scheduler_file=str(told), timeout=60) as client:
            client.wait_for_workers(2, timeout=120)
            begun = tmp_path / "begun"
            begun.mkdir()

            def kill_one() -> None:
                while not (begun / str(one.pid)).exists():
                    time.sleep(0.05)
                one.send_signal(signal.SIGKILL)

            killer = threading.Thread(target=kill_one)
            killer.start()
            executor = client.get_executor()
            submit = executor.submit
            executor.submit = lambda task, *args: submit(programs.slow_match_pairs, str(begun), *args)
            result = gridmerge.merge(MAPS, executor=executor)
            killer.join()
            assert one.wait(20) == -signal.SIGKILL
    assert answer(result, tmp_path / "o") == expected


def test_mpi_gives_the_same_bits(expected: tuple[str, bytes], tmp_path: Path) -> None:
    pytest.importorskip("mpi4py", reason="mpi4py is not installed (pip install mpi4py)")
    mpiexec = shutil.which("mpiexec")
    if mpiexec is None:
        pytest.skip("there is no mpiexec (Debian: openmpi-bin)")
    loopback = ["--mca", "btl", "self,vader", "--mca", "oob_tcp_if_include", "lo"]
    program = [sys.executable, "-m", "mpi4py.futures", programs.__file__, str(tmp_path)]
    ran = subprocess.run(
        [mpiexec, "--allow-run-as-root", "--oversubscribe", *loopback, "-n", "3", *program],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    assert re.search(r"^placed 3, workers [12]$", ran.stdout, re.M), ran.stdout
    assert read_answer(tmp_path / "by_path") == expected
    assert read_answer(tmp_path / "by_map") == expected
