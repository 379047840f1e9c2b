#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How long the engine takes beside AKAZE features and log-polar phase correlation, as ../peers.py asks all three: each
pair by each of them in turn, one thread each. Prints ratios of CPU seconds, and writes those of every pair into
OUTPUT/peer_seconds.tsv.

usage: benchmark/speed/beside_peers.py --gridmerge BINARY --output DIR [--data DIR] [--pairs N]

Of each set of real maps at most N pairs and N unrelated pairs, evenly spaced. Without the real maps it takes the
bundled example, and without OpenCV it only says that it is missing.
"""

import argparse
import functools
import os
import pathlib
import statistics
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
EXAMPLE = pathlib.Path("examples/three_robots")
ENGINE = "gridmerge"
PEERS = ("AKAZE", "phase correlation")

Row = dict[str, float]  # CPU seconds by matcher


def ratio(rows: list[Row], peer: str) -> str:
    """Of the engine to the peer: the median of the pairs' ratios, and the quartiles."""
    ratios = [row[ENGINE] / row[peer] for row in rows]
    quartiles = statistics.quantiles(ratios, n=4, method="inclusive") if len(ratios) > 1 else [ratios[0]] * 3
    return f"{quartiles[1]:.2f} ({quartiles[0]:.2f} to {quartiles[2]:.2f})"


def summarize(maps: str, rows: list[Row]) -> dict:
    summary = {"maps": maps, "pairs": len(rows)}
    summary |= {
        f"{name} [s]": f"{statistics.median(row[name] for row in rows):.3f}" for name in (ENGINE, *PEERS)
    }
    return summary | {f"{ENGINE} / {peer}": ratio(rows, peer) for peer in PEERS}


def measure(gridmerge: pathlib.Path, data: pathlib.Path, output: pathlib.Path, limit: int) -> str:
    """The table. Throws ImportError where a package is missing."""
    import cv2
    import peer_cases
    import peers
    from benchmark_tables import table

    cv2.setNumThreads(1)
    matchers = {
        ENGINE: functools.partial(peers.match_by_gridmerge, gridmerge),
        PEERS[0]: functools.partial(peers.match_by_features, 1.0),
        PEERS[1]: functools.partial(peers.match_by_phase, 0.0),
    }
    cases = peer_cases.real_cases(data)
    if not cases:
        print(f"No real maps at {data}: measuring the bundled example, {EXAMPLE}, instead.")
        cases = peer_cases.read_cases(EXAMPLE, "example")
    groups: dict[str, list] = {}
    for case in cases:
        groups.setdefault(
            case.group.split(", tier ")[0].removesuffix(", unrelated")
            + (", unrelated" if case.truth is None else ""),
            [],
        ).append(case)
    for match in matchers.values():  # what is made once, at the first call
        match(cases[0].fixed, cases[0].moving)
    measured = [
        (group, case, {name: match(case.fixed, case.moving)[1] for name, match in matchers.items()})
        for group, members in groups.items()
        for case in peer_cases.sample(members, limit)
    ]
    peers.write_tsv(
        output / "peer_seconds.tsv",
        [
            {"maps": group, "fixed": case.fixed, "moving": case.moving}
            | {name: f"{seconds:.4f}" for name, seconds in row.items()}
            for group, case, row in measured
        ],
    )
    rows = [summarize(group, [row for maps, _, row in measured if maps == group]) for group in groups]
    return table([*rows, summarize("all", [row for *_, row in measured])])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--pairs", type=int, metavar="N", default=10)
    arguments = parser.parse_args()
    if arguments.pairs < 1:
        parser.error("--pairs has to be at least 1")
    arguments.output.mkdir(parents=True, exist_ok=True)
    try:
        print(measure(arguments.gridmerge, arguments.data, arguments.output, arguments.pairs), end="")
    except ImportError as error:
        print(
            f"AKAZE features and phase correlation: skipped, {sys.executable} lacks what they need "
            f"(Debian: python3-opencv, python3-numpy, python3-pil): {error}"
        )
        return
    print(
        "CPU seconds, user and system, of one thread: medians, and of the ratios the quartiles too. "
        "The maps are read each time.\n"
        f"Of {ENGINE} they are those of a whole process; of the others they leave out Python's start."
    )


if __name__ == "__main__":
    main()
