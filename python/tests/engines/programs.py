# SPDX-License-Identifier: Apache-2.0
"""What the tests beside real engines have in common, and the programs that they run."""

from __future__ import annotations

import os
import re
import sys
import time
from pathlib import Path
from typing import Any

import gridmerge
from gridmerge import _tasks

ROOT = Path(__file__).resolve().parents[3]
MAPS = [
    str(ROOT / "examples" / "three_robots" / f"{name}.yaml")
    for name in ("robot_1", "robot_2", "robot_3", "elsewhere")
]


def answer(result: gridmerge.MergeResult, folder: Path) -> tuple[str, bytes]:
    """What a merge writes, but for its times."""
    result.save(folder)
    return read_answer(folder)


def read_answer(folder: Path) -> tuple[str, bytes]:
    text = (folder / "transforms.json").read_text()
    return re.sub(r'"seconds": *[0-9.e+-]+', "", text), (folder / "merged.pgm").read_bytes()


def slow_match_pairs(marker: str, *args: Any) -> Any:
    """A task that tells which process has begun it, and takes its time."""
    Path(marker, f"{os.getpid()}").touch()
    time.sleep(0.5)
    return _tasks.match_pairs(*args)


def merge_on_mpi(folder: Path) -> None:
    from mpi4py.futures import MPIPoolExecutor  # type: ignore[import-not-found]

    with MPIPoolExecutor() as executor:
        result = gridmerge.merge(MAPS, executor=executor)
        result.save(folder / "by_path")
        gridmerge.merge([gridmerge.load(path) for path in MAPS], executor=executor).save(folder / "by_map")
        workers = {executor.submit(os.getpid).result() for _ in range(20)}
    print(f"placed {len(result.components[0].members)}, workers {len(workers - {os.getpid()})}")


if __name__ == "__main__":
    merge_on_mpi(Path(sys.argv[1]))
