# SPDX-License-Identifier: Apache-2.0
"""Merges map files, with the pairs matched by several processes: the answer is that of one.

    python merge_on_processes.py robot_1.yaml robot_2.yaml robot_3.yaml -o merged

Any other executor takes their place: of Dask, MPI, ... (docs/fleets.md).
"""

from __future__ import annotations

import argparse
import multiprocessing
from concurrent.futures import ProcessPoolExecutor

import gridmerge


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("maps", nargs="+")
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--workers", type=int, default=2)
    arguments = parser.parse_args()

    # "spawn" starts processes that share nothing with this one.
    with ProcessPoolExecutor(arguments.workers, multiprocessing.get_context("spawn")) as executor:
        result = gridmerge.merge(arguments.maps, executor=executor)
    result.save(arguments.output)
    print(result)


if __name__ == "__main__":
    main()
