#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The pairs of a merge on two workers of an engine, beside one process.

usage: benchmark/engines.py [--robots N] [--rounds N]

Runs in an environment that has the package gridmerge, and distributed and mpi4py (with an mpiexec) or what of them
there is. A team of simulated robots is merged by one process with one thread, then with two workers of each engine, in
turn, several times. Wall times are compared within a round, because other work on the machine changes them. The CPU
time is that of the workers and the program together, without the start of either. The speed-up of pairs is that until
the last match is there: the joint step comes after it, and nobody shares that. Every answer has to be that of one
process. At last: what a task costs that does nothing.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import AbstractContextManager
from pathlib import Path

import gridmerge

WORKERS = 2


def process_times() -> float:
    """CPU seconds of this process so far."""
    return time.process_time()


def worker_time(pause: float = 0.05) -> tuple[int, float]:
    """Of the worker that runs it; it waits, so that another worker takes the next one."""
    time.sleep(pause)
    return os.getpid(), time.process_time()


def nothing(number: int) -> int:
    return number


def cpu_of_workers(executor: Executor) -> dict[int, float]:
    return dict(future.result() for future in [executor.submit(worker_time) for _ in range(4 * WORKERS)])


def fingerprint(result: gridmerge.MergeResult) -> str:
    with tempfile.TemporaryDirectory() as folder:
        result.save(folder)
        return re.sub(r'"seconds": *[0-9.e+-]+', "", Path(folder, "transforms.json").read_text())


def timed_merge(paths: list[str], executor: Executor | None) -> dict[str, float | str]:
    before = {} if executor is None else cpu_of_workers(executor)
    shares: list[float] = []  # when it was told how far the work is

    def told(share: float) -> None:
        if share < 1.0:
            shares.append(time.monotonic())

    began, cpu = time.monotonic(), process_times()
    result = gridmerge.merge(paths, executor=executor, threads=1, progress=told)
    wall, cpu = time.monotonic() - began, process_times() - cpu
    if executor is not None:
        after = cpu_of_workers(executor)
        cpu += sum(
            after[worker] - before.get(worker, after[worker]) for worker in after if worker != os.getpid()
        )
    return {"wall": wall, "pairs": shares[-1] - began, "cpu": cpu, "answer": fingerprint(result)}


def task_cost(executor: Executor, tasks: int = 200) -> float:
    """Wall seconds of a task that does nothing, of many that are there at once."""
    began = time.monotonic()
    futures = [executor.submit(nothing, i) for i in range(tasks)]
    for future in futures:
        future.result()
    return (time.monotonic() - began) / tasks


def run(paths: list[str], executor: Executor) -> dict[str, float | str]:
    cpu_of_workers(executor)  # the workers have begun, and the package is loaded
    for future in [executor.submit(gridmerge.merge, paths[:1]) for _ in range(2 * WORKERS)]:
        future.result()
    return timed_merge(paths, executor) | {"task": task_cost(executor)}


def with_processes(paths: list[str]) -> dict[str, float | str]:
    with ProcessPoolExecutor(WORKERS, multiprocessing.get_context("spawn")) as executor:
        return run(paths, executor)


def with_dask(paths: list[str]) -> dict[str, float | str]:
    from distributed import Client, LocalCluster

    cluster: AbstractContextManager[object] = LocalCluster(
        n_workers=WORKERS, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
    )
    with cluster, Client(cluster) as client:
        return run(paths, client.get_executor())


def with_mpi(paths: list[str]) -> dict[str, float | str]:
    loopback = ["--mca", "btl", "self,vader", "--mca", "oob_tcp_if_include", "lo"]
    command = [
        "mpiexec",
        "--allow-run-as-root",
        "--oversubscribe",
        *loopback,
        "--mca",
        "mpi_yield_when_idle",
        "1",
    ]
    command += ["-n", str(WORKERS + 1), sys.executable, "-m", "mpi4py.futures", __file__, "--on-mpi", *paths]
    output = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout
    return dict(json.loads(output.splitlines()[-1]))


def on_mpi(paths: list[str]) -> None:
    from mpi4py.futures import MPIPoolExecutor

    with MPIPoolExecutor() as executor:
        print(json.dumps(run(paths, executor)))


def engines() -> dict[str, Callable[[list[str]], dict[str, float | str]]]:
    found: dict[str, Callable[[list[str]], dict[str, float | str]]] = {"processes": with_processes}
    try:
        import distributed  # noqa: F401

        found["Dask"] = with_dask
    except ImportError:
        print("Dask is left out: it is not installed", file=sys.stderr)
    try:
        import mpi4py  # noqa: F401

        if shutil.which("mpiexec") is None:
            raise ImportError
        found["MPI"] = with_mpi
    except ImportError:
        print("MPI is left out: mpi4py or mpiexec is not installed", file=sys.stderr)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", type=int, default=8)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--on-mpi", nargs="+", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.on_mpi:
        on_mpi(arguments.on_mpi)
        return
    with tempfile.TemporaryDirectory() as folder:
        team = gridmerge.simulate(
            "office", size=(50, 35), robots=arguments.robots, overlap=0.3, drift=0.1, seed=7
        )
        team.save(folder)
        paths = sorted(str(path) for path in Path(folder).glob("*.yaml"))
        rows: dict[str, list[dict[str, float | str]]] = {}
        for _ in range(arguments.rounds):
            rows.setdefault("one process", []).append(timed_merge(paths, None))
            for name, measure in engines().items():
                rows.setdefault(name, []).append(measure(paths))
        alone = rows["one process"]
        print(f"{len(paths)} maps, {arguments.rounds} rounds, medians; {WORKERS} workers\n")
        print("| | wall time [s] | speed-up | of pairs | CPU time [s] | a task [ms] | answer |")
        print("| --- | --- | --- | --- | --- | --- | --- |")
        for name, runs in rows.items():
            wall = statistics.median(float(one["wall"]) for one in runs)
            cpu = statistics.median(float(one["cpu"]) for one in runs)
            speed, speed_of_pairs = (
                statistics.median(float(a[key]) / float(b[key]) for a, b in zip(alone, runs, strict=True))
                for key in ("wall", "pairs")
            )
            task = (
                ""
                if name == "one process"
                else f"{1e3 * statistics.median(float(one['task']) for one in runs):.1f}"
            )
            same = all(one["answer"] == alone[0]["answer"] for one in runs)
            print(
                f"| {name} | {wall:.1f} | {speed:.2f} | {speed_of_pairs:.2f} | {cpu:.1f} | {task} | "
                f"{'the same' if same else 'DIFFERS'} |"
            )


if __name__ == "__main__":
    main()
