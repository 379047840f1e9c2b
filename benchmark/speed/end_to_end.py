#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs `gridmerge evaluate` on real maps, one thread, and holds its speed, memory and answers against the bars.

Without the real maps it runs on the bundled example, and says so. The exit code is 1 when a bar is missed.
"""

import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys

MEDIAN_BAR_S = 0.1
MAX_BAR_S = 1.0
MEMORY_BAR_MB = 300


def machine(build: pathlib.Path) -> str:
    cpuinfo = pathlib.Path("/proc/cpuinfo").read_text()
    model = re.search(r"^model name\s*: (.*)$", cpuinfo, re.MULTILINE)
    cache = (build / "CMakeCache.txt").read_text()
    compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.MULTILINE).group(1)
    version = subprocess.run(
        [compiler, "--version"], capture_output=True, text=True, check=True
    ).stdout.splitlines()[0]
    build_type = re.search(r"^CMAKE_BUILD_TYPE:\w+=(.*)$", cache, re.MULTILINE).group(1)
    return (
        f"{model.group(1) if model else 'unknown CPU'}, {os.cpu_count()} cores; {version}; {build_type} build"
    )


def evaluate(build: pathlib.Path, folder: pathlib.Path, result_file: pathlib.Path) -> tuple[dict, float]:
    """The result of one evaluation, and its peak memory in MB."""
    command = [
        build / "bin" / "gridmerge",
        "evaluate",
        folder / "pairs.tsv",
        "--negatives",
        folder / "negatives.tsv",
        "--threads",
        "1",
        "--json",
        result_file,
    ]
    if (folder / "sets.tsv").is_file():
        command += ["--sets", folder / "sets.tsv"]
    print("$", *command, flush=True)
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        sys.exit(
            f"end_to_end: the evaluation of {folder} ended with exit code {os.waitstatus_to_exitcode(status)}"
        )
    return json.loads(result_file.read_text()), usage.ru_maxrss / 1024


def tiers(folder: pathlib.Path, result: dict) -> dict[str, list[dict]]:
    """The cases of the true pairs by tier."""
    cases = {(case["fixed"], case["moving"]): case for case in result["cases"]}
    by_tier: dict[str, list[dict]] = {}
    with open(folder / "pairs.tsv", newline="") as file:
        for row in csv.DictReader(file, delimiter="\t"):
            by_tier.setdefault(row["tier"], []).append(cases[row["fixed"], row["moving"]])
    return by_tier


def verdict(value: float, bar: float) -> str:
    return f"bar {bar}: {'met' if value <= bar else 'MISSED'}"


def report(folder: pathlib.Path, result: dict, peak_mb: float) -> bool:
    """Prints the result, and says whether it meets every bar."""
    pairs, negatives, sets, seconds = result["pairs"], result["negatives"], result["sets"], result["seconds"]
    print(f"{folder.name}: {pairs['total']} pairs, {negatives['total']} negatives")
    for tier, cases in sorted(tiers(folder, result).items()):
        accepted = [case for case in cases if case["verdict"] == "accepted"]
        print(
            f"  tier {tier + ':':<8} best correct {sum(bool(c['correct']) for c in cases)} of {len(cases)}, "
            f"accepted and correct {sum(bool(c['correct']) for c in accepted)}"
        )
    print(
        f"  all pairs:    best correct {pairs['best_correct']} of {pairs['total']}, accepted and correct "
        f"{pairs['accepted_correct']}, accepted and wrong {pairs['accepted_wrong']}, refused {pairs['refused']}"
    )
    print(f"  negatives:    accepted {negatives['accepted']} of {negatives['total']}")
    if sets["total"]:
        print(
            f"  sets:         {sets['complete']} of {sets['total']} complete; of {sets['maps']} maps "
            f"{sets['maps_correct']} correct, {sets['maps_wrong']} wrong, {sets['maps_left_out']} left out"
        )
    print(
        f"  seconds:      median {seconds['median']:.3f} ({verdict(seconds['median'], MEDIAN_BAR_S)}), "
        f"p90 {seconds['p90']:.3f}, max {seconds['max']:.3f} ({verdict(seconds['max'], MAX_BAR_S)})"
    )
    print(f"  peak memory:  {peak_mb:.0f} MB ({verdict(peak_mb, MEMORY_BAR_MB)})")
    return seconds["median"] <= MEDIAN_BAR_S and seconds["max"] <= MAX_BAR_S and peak_mb <= MEMORY_BAR_MB


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, required=True, help="the release build's folder")
    parser.add_argument("--data", type=pathlib.Path, required=True, help="folder with halmstad/ and radish/")
    parser.add_argument("--output", type=pathlib.Path, required=True, help="where the results are written")
    arguments = parser.parse_args()

    folders = [
        folder for folder in (arguments.data / "halmstad", arguments.data / "radish") if folder.is_dir()
    ]
    if not folders:
        example = pathlib.Path("examples/three_robots")
        print(f"No real maps at {arguments.data}: measuring the bundled example, {example}, instead.")
        folders = [example]
    arguments.output.mkdir(parents=True, exist_ok=True)
    print(machine(arguments.build))
    missed = [
        folder.name
        for folder in folders
        if not report(folder, *evaluate(arguments.build, folder, arguments.output / f"{folder.name}.json"))
    ]
    if missed:
        sys.exit(f"end_to_end: a bar was missed on {', '.join(missed)}")


if __name__ == "__main__":
    main()
