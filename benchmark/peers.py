#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""gridmerge beside what else anyone can install and match two occupancy grids with: the same pairs, the same truth,
each by its own rule of acceptance. Writes OUTPUT/peers.md and OUTPUT/peers.tsv (the table), and
OUTPUT/peer_pairs.tsv (every pair).

usage: benchmark/peers.py --gridmerge BINARY --output DIR [--mrpt BINARY] [--data DIR] [--limit N]

Simulated pairs always; real ones where DIR has them. --limit takes at most N pairs and N unrelated
pairs of each set, evenly spaced; of the simulated ones those of the first N seeds.
"""

import argparse
import concurrent.futures
import csv
import dataclasses
import functools
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

from benchmark_tables import NO_FIGURE, table
from peer_cases import Case, limited, real_cases, simulated_cases, training_cases
from peer_maps import Answer, KnownCells, coarsened, read_map, write_map
from poses import inverse, read_pose

# The answer for (fixed, moving), and the CPU seconds, user and system, that it took.
Match = Callable[[pathlib.Path, pathlib.Path], tuple[Answer, float]]

MRPT_OPTIONS = pathlib.Path(__file__).parent / "mrpt" / "options.ini"
MRPT_CELL = 0.10  # [m] that of the example that the options are from
COUNTS = ("pairs", "best right", "accepted right", "accepted wrong", "refused")


@dataclasses.dataclass(frozen=True)
class Judged:
    peer: str
    case: Case
    answer: Answer
    seconds: float  # CPU, user and system
    error: float | None

    @property
    def right(self) -> bool:
        return self.error is not None and self.error <= self.case.tolerance


@dataclasses.dataclass(frozen=True)
class Peer:
    name: str
    version: str
    acceptance: str
    match: Match


def run_measured(command: list, accepted_codes: tuple[int, ...] = (0,)) -> tuple[str, float]:
    """What the program prints, and the CPU seconds that it took, user and system."""
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        process = subprocess.Popen([str(word) for word in command], stdout=output, stderr=errors)
        _, status, usage = os.wait4(process.pid, 0)
        code = process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        if code not in accepted_codes:
            sys.exit(
                f"peers: {' '.join(str(word) for word in command)} ended with {code}: {errors.read().strip()}"
            )
        return output.read(), usage.ru_utime + usage.ru_stime


def read_gridmerge(text: str) -> Answer:
    """Of `gridmerge match --json`."""
    result = json.loads(text)
    pose = read_pose(result["transform"]) if result["hypotheses"] else None
    return Answer(pose, result["verdict"] == "accepted", result["probability"])


def read_mrpt(text: str) -> Answer:
    """Of mrpt/grid_match: the mode that MRPT's own ICP finds best. That there is one is MRPT's acceptance."""
    modes = [
        tuple(float(word) for word in line.split()[1:])
        for line in text.splitlines()
        if line.startswith("mode ")
    ]
    if not modes:
        return Answer(None, False, 0.0)
    _, goodness, x, y, theta = max(modes, key=lambda mode: mode[1])
    return Answer((x, y, theta), True, goodness)


def match_by_gridmerge(
    binary: pathlib.Path, fixed: pathlib.Path, moving: pathlib.Path
) -> tuple[Answer, float]:
    text, seconds = run_measured(
        [binary, "match", "--json", "--quiet", "--threads", 1, fixed, moving], (0, 3)
    )
    return read_gridmerge(text), seconds


def match_by_mrpt(binary: pathlib.Path, fixed: pathlib.Path, moving: pathlib.Path) -> tuple[Answer, float]:
    with tempfile.TemporaryDirectory() as folder:
        coarse = [pathlib.Path(folder, f"{name}.yaml") for name in ("fixed", "moving")]
        for path, there in zip((fixed, moving), coarse, strict=True):
            map_ = read_map(path)
            write_map(there, coarsened(map_, max(1, round(MRPT_CELL / map_.resolution))))
        text, seconds = run_measured([binary, *coarse, MRPT_OPTIONS])
    return read_mrpt(text), seconds


def match_by_features(
    least_confidence: float, fixed: pathlib.Path, moving: pathlib.Path
) -> tuple[Answer, float]:
    import peer_features  # late: without OpenCV the other peers run

    start = time.process_time()
    answer = peer_features.match(read_map(fixed), read_map(moving), least_confidence)
    return answer, time.process_time() - start


def match_by_phase(least_response: float, fixed: pathlib.Path, moving: pathlib.Path) -> tuple[Answer, float]:
    import peer_phase

    start = time.process_time()
    answer = peer_phase.match(read_map(fixed), read_map(moving), least_response)
    return answer, time.process_time() - start


def in_both_orders(match: Match, fixed: pathlib.Path, moving: pathlib.Path) -> tuple[Answer, float]:
    """The surer answer of the two, and the CPU seconds of one."""
    (answer, seconds), (turned, turned_seconds) = match(fixed, moving), match(moving, fixed)
    if turned.pose and (turned.accepted, turned.score) > (answer.accepted, answer.score):
        answer = dataclasses.replace(turned, pose=inverse(turned.pose))
    return answer, 0.5 * (seconds + turned_seconds)


def judge(job: tuple[Peer, Case]) -> Judged:
    peer, case = job
    answer, seconds = peer.match(case.fixed, case.moving)
    error = None
    if case.truth and answer.pose:
        error = KnownCells(read_map(case.moving)).displacement(answer.pose, case.truth)
    return Judged(peer.name, case, answer, seconds, error)


def opencv_peers(pool: concurrent.futures.Executor, training: Callable[[], list[Case]]) -> list[Peer]:
    try:
        import cv2
    except ImportError as error:
        print(
            f"feature matching and phase correlation: skipped, Python has no OpenCV (Debian: python3-opencv): {error}"
        )
        return []
    version = f"OpenCV {cv2.__version__}"
    peers = [
        Peer(
            f"AKAZE features, confidence {least:g}",
            version,
            f"confidence of at least {least:g}",
            functools.partial(in_both_orders, functools.partial(match_by_features, least)),
        )
        for least in (1.0, 0.5)
    ]
    asking = Peer("", version, "", functools.partial(in_both_orders, functools.partial(match_by_phase, 0.0)))
    unrelated = list(pool.map(judge, [(asking, case) for case in training()]))
    # The next number: the highest response of an unrelated pair is refused.
    least = math.nextafter(max(judged.answer.score for judged in unrelated), math.inf)
    rule = f"response above {least:.3f}, the highest of {len(unrelated)} unrelated pairs of a simulated training set"
    return [
        *peers,
        Peer(
            "log-polar phase correlation",
            version,
            rule,
            functools.partial(in_both_orders, functools.partial(match_by_phase, least)),
        ),
    ]


def mrpt_peers(binary: pathlib.Path | None) -> list[Peer]:
    if binary is None or not binary.is_file():
        print("MRPT: skipped, there is no program of benchmark/mrpt (Debian: libmrpt-slam-dev; --mrpt)")
        return []
    version = f"MRPT {(binary.parent / 'version').read_text().strip()}"
    rule = (
        "a mode that is left by its own tests: enough inliers (ransac_minSetSizeRatio), "
        "then ICP (min_ICP_goodness, max_ICP_mahadist)"
    )
    return [
        Peer(
            "MRPT grid matching",
            version,
            rule,
            functools.partial(in_both_orders, functools.partial(match_by_mrpt, binary)),
        )
    ]


def gridmerge_peer(binary: pathlib.Path) -> Peer:
    version = subprocess.run([binary, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    return Peer(
        "gridmerge", version, "probability of at least 0.95", functools.partial(match_by_gridmerge, binary)
    )


def summarize(group: str, peer: str, judged: list[Judged]) -> dict:
    pairs = [one for one in judged if one.case.truth]
    accepted = [one for one in pairs if one.answer.accepted]
    unrelated = [one for one in judged if one.case.truth is None]
    row = {"maps": group, "peer": peer}
    row |= (
        {
            "pairs": len(pairs),
            "best right": sum(one.right for one in pairs),
            "accepted right": sum(one.right for one in accepted),
            "accepted wrong": sum(not one.right for one in accepted),
            "refused": len(pairs) - len(accepted),
        }
        if pairs
        else dict.fromkeys(COUNTS, NO_FIGURE)
    )
    row["unrelated accepted"] = (
        f"{sum(one.answer.accepted for one in unrelated)} of {len(unrelated)}" if unrelated else NO_FIGURE
    )
    row["CPU s"] = f"{statistics.median(one.seconds for one in judged):.2f}"
    return row


def write_results(output: pathlib.Path, judged: list[Judged], peers: list[Peer]) -> str:
    groups = dict.fromkeys(one.case.group for one in judged)
    rows = [
        summarize(
            group, peer.name, [one for one in judged if one.peer == peer.name and one.case.group == group]
        )
        for group in groups
        for peer in peers
    ]
    report = (
        "# Beside what people use\n"
        + table(rows)
        + "\nCPU s: the median of a pair, user and system, reading the maps "
    )
    report += "included; without Python's start.\n\n"
    report += (
        "\n".join(f"- **{peer.name}** ({peer.version}) accepts by: {peer.acceptance}." for peer in peers)
        + "\n"
    )
    (output / "peers.md").write_text(report)
    write_tsv(output / "peers.tsv", rows)
    write_tsv(
        output / "peer_pairs.tsv",
        [
            {"maps": one.case.group, "peer": one.peer, "fixed": one.case.fixed, "moving": one.case.moving}
            | dict(zip(("x", "y", "theta"), one.answer.pose or ("", "", ""), strict=True))
            | {
                "accepted": int(one.answer.accepted),
                "score": one.answer.score,
                "error": "" if one.error is None else one.error,
                "tolerance": one.case.tolerance if one.case.truth else "",
                "right": int(one.right) if one.case.truth else "",
                "seconds": f"{one.seconds:.3f}",
            }
            for one in judged
        ],
    )
    return report


def write_tsv(path: pathlib.Path, rows: list[dict]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), delimiter="\t", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def use_one_thread() -> None:
    try:
        import cv2
    except ImportError:
        return
    cv2.setNumThreads(1)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--mrpt", type=pathlib.Path, help="the program that benchmark/mrpt builds")
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--limit", type=int, metavar="N")
    arguments = parser.parse_args()
    if arguments.limit is not None and arguments.limit < 1:
        parser.error("--limit has to be at least 1")
    made = arguments.output / "cases" / "peers"
    made.mkdir(parents=True, exist_ok=True)

    with concurrent.futures.ProcessPoolExecutor(initializer=use_one_thread) as pool:
        cases = limited(
            simulated_cases(pool, arguments.gridmerge, made, arguments.limit) + real_cases(arguments.data),
            arguments.limit,
        )
        peers = [
            gridmerge_peer(arguments.gridmerge),
            *mrpt_peers(arguments.mrpt),
            *opencv_peers(pool, lambda: training_cases(pool, arguments.gridmerge, made)),
        ]
        judged = []
        for peer in peers:
            print(f"{peer.name}: {len(cases)} pairs ...", flush=True)
            judged += pool.map(judge, [(peer, case) for case in cases])
    print(write_results(arguments.output, judged, peers), end="")
    print(f"wrote {arguments.output}/peers.md, peers.tsv and peer_pairs.tsv")


if __name__ == "__main__":
    main()
