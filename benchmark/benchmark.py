#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where the engine works and where it breaks: families of simulated cases, each with one factor swept, and real maps
where there are any. Writes OUTPUT/report.md with plots beside it.

usage: benchmark/benchmark.py --gridmerge BINARY --output DIR [--data DIR] [--full] [--only PART,...]

By default a quarter of an hour on two cores; --full takes eight times as many cases, and about two hours. --only
measures some of the parts alone.
"""

import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

from benchmark_tables import (
    by_shared_wall,
    counts_of,
    plot_cost,
    plot_family,
    plot_probability,
    summarize,
    table,
    with_intervals,
)

BASE = {
    "--kind": "office",
    "--size": "40x25",
    "--robots": "2",
    "--overlap": "0.5",
    "--drift": "0.3",
    "--others": "1",
}

# Each family: what is swept, the unit, and the values as options.
FAMILIES = {
    "overlap": (
        "overlap asked for",
        [({"--overlap": v}, float(v)) for v in ("0.9", "0.6", "0.4", "0.3", "0.2", "0.1", "0.05", "0.02")],
    ),
    "straight": (
        "overlap asked for, no drift",
        [({"--overlap": v, "--drift": "0"}, float(v)) for v in ("0.3", "0.2", "0.1")],
    ),
    "drift": ("drift", [({"--drift": v}, float(v)) for v in ("0", "0.25", "0.5", "1", "1.5", "2", "3")]),
    "noise": (
        "range noise [m]",
        [({"--noise": v}, float(v)) for v in ("0", "0.02", "0.05", "0.1", "0.2", "0.4")],
    ),
    "clutter": ("clutter", [({"--clutter": v}, float(v)) for v in ("0", "1", "2", "4", "8")]),
    "range": ("range of the sensor [m]", [({"--range": v}, float(v)) for v in ("2", "4", "8", "16", "30")]),
    "resolution": (
        "cell [m]",
        [({"--resolution": v}, float(v)) for v in ("0.025", "0.05", "0.1", "0.2", "0.4")],
    ),
    "kind": (
        "kind of building",
        [
            ({"--kind": v, "--size": "14x11" if v == "apartment" else "40x25"}, v)
            for v in ("office", "hall", "warehouse", "apartment", "symmetric", "loop", "curved", "outdoor")
        ],
    ),
    "size": ("side of the building [m]", [({"--size": f"{v}x{v}"}, v) for v in (10, 20, 40, 80, 160, 200)]),
}
PARTS = (*FAMILIES, "ratio", "teams", "walk", "real")
RATIOS = (1, 2, 3, 4, 6)  # of the two maps' cells
TEAM_KINDS = ("office", "hall", "loop", "apartment")
TEAM_SIZES = (2, 5, 10, 20, 30)  # robots of one floor of 100 m x 60 m
WALK_OVERLAPS = ("0.9", "0.6", "0.3")
FIRST_SEED = 20001  # nothing of the engine was fitted to maps of this seed and the next ones
LARGE = 160  # floors of so many metres take a minute each, so there are fewer
MOST_LARGE = 16


def run(command: list) -> tuple[int, float]:
    """Exit code, and peak memory in MB."""
    process = subprocess.Popen(
        [str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, usage = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), usage.ru_maxrss / 1024


class Bench:
    def __init__(self, gridmerge: pathlib.Path, output: pathlib.Path, repeats: int):
        self.gridmerge, self.output, self.repeats = gridmerge, output, repeats
        self.cases = []  # of all families, for the ROC and the reliability

    def simulate(self, folder: pathlib.Path, options: dict, seed: int) -> bool:
        words = [word for option in (BASE | options | {"--seed": seed}).items() for word in option]
        shutil.rmtree(folder, ignore_errors=True)
        code, _ = run([self.gridmerge, "simulate", "-o", folder, "--threads", 1, "--quiet", *words])
        return code == 0

    def evaluate(self, folder: pathlib.Path, *words) -> tuple[dict, float]:
        result = folder / "result.json"
        code, memory = run([self.gridmerge, "evaluate", *words, "--threads", 1, "--json", result, "--quiet"])
        if code != 0:
            sys.exit(f"benchmark: the evaluation of {folder} failed")
        return json.loads(result.read_text()), memory

    def pair_case(self, name: str, options: dict, seed: int):
        folder = self.output / "cases" / f"{name}_{seed}"
        if not self.simulate(folder, options, seed):
            return None
        result, memory = self.evaluate(folder, folder / "pairs.tsv", "--negatives", folder / "negatives.tsv")
        with (folder / "pairs.tsv").open(newline="") as file:
            walls = {
                (row["fixed"], row["moving"]): float(row["shared_wall"])
                for row in csv.DictReader(file, delimiter="\t")
            }
        for case in result["cases"]:
            case["shared_wall"] = walls.get((case["fixed"], case["moving"]))
        return result, memory

    def seeds(self, most: int | None = None) -> range:
        return range(FIRST_SEED, FIRST_SEED + min(self.repeats, most or self.repeats))

    def sweep(self, family: str, values: list) -> list[dict]:
        most = {i: MOST_LARGE for i, (_, value) in enumerate(values) if family == "size" and value >= LARGE}
        jobs = [
            (i, options, seed) for i, (options, _) in enumerate(values) for seed in self.seeds(most.get(i))
        ]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            results = list(pool.map(lambda job: self.pair_case(f"{family}_{job[0]}", job[1], job[2]), jobs))
        rows = []
        for i, (_, value) in enumerate(values):
            found = [
                result for (index, _, _), result in zip(jobs, results, strict=True) if index == i and result
            ]
            cases = [case for result, _ in found for case in result["cases"]]
            self.cases += [case | {"family": family} for case in cases]
            rows.append(summarize(value, cases, max((memory for _, memory in found), default=0.0)))
        return rows

    def ratios(self) -> list[dict]:
        """One robot's map at 0.05 m, the other's at a multiple of it."""
        rows = []
        for ratio in RATIOS:
            cases, memory = [], 0.0
            for seed in self.seeds():
                fine, coarse = (
                    self.output / "cases" / f"ratio_{ratio}_{seed}_{which}" for which in ("fine", "coarse")
                )
                # Without a wanted overlap robots do not depend on the resolution.
                way = {"--overlap": "", "--longest-way": "120", "--size": "26x18", "--others": "0"}
                if not all(
                    self.simulate_plain(folder, way, seed, 0.05 * scale)
                    for folder, scale in ((fine, 1), (coarse, ratio))
                ):
                    continue
                with (fine / "pairs.tsv").open(newline="") as file:
                    pairs = [
                        row for row in csv.DictReader(file, delimiter="\t") if float(row["overlap"]) > 0.3
                    ]
                table = fine / "ratio.tsv"
                lines = ["fixed\tmoving\tx\ty\ttheta\ttolerance"]
                lines += [
                    f"{row['fixed']}\t../{coarse.name}/{row['moving']}\t{row['x']}\t{row['y']}\t{row['theta']}\t"
                    f"{row['tolerance']}"
                    for row in pairs
                ]
                table.write_text("\n".join(lines) + "\n")
                result, peak = self.evaluate(fine, table)
                cases += result["cases"]
                memory = max(memory, peak)
            rows.append(summarize(ratio, cases, memory))
        return rows

    def simulate_plain(self, folder: pathlib.Path, options: dict, seed: int, resolution: float) -> bool:
        merged = {k: v for k, v in (BASE | options).items() if v != ""}
        words = [
            word
            for option in (merged | {"--seed": seed, "--resolution": f"{resolution:g}"}).items()
            for word in option
        ]
        shutil.rmtree(folder, ignore_errors=True)
        return run([self.gridmerge, "simulate", "-o", folder, "--threads", 1, "--quiet", *words])[0] == 0

    def teams(self) -> list[dict]:
        """Teams of six with a map of another building among theirs, merged jointly and up the tree."""
        rows = [
            {"strategy": strategy, "maps": 0, "right": 0, "wrong": 0, "left out": 0}
            for strategy in ("joint", "tree")
        ]
        for kind in TEAM_KINDS:
            for seed in self.seeds(max(2, self.repeats // 2)):
                folder = self.output / "cases" / f"team_{kind}_{seed}"
                size = "18x13" if kind == "apartment" else "45x30"
                if not self.simulate(folder, {"--kind": kind, "--robots": "6", "--size": size}, seed):
                    continue
                for row in rows:
                    sets = self.evaluate(
                        folder, "--sets", folder / "sets.tsv", "--strategy", row["strategy"]
                    )[0]["sets"]
                    for key, name in (
                        ("maps", "maps"),
                        ("right", "maps_correct"),
                        ("wrong", "maps_wrong"),
                        ("left out", "maps_left_out"),
                    ):
                        row[key] += sets[name]
        return rows

    def team_sizes(self) -> list[dict]:
        """The first k of 30 robots of one floor: time and memory of gridmerge merge, both threads."""
        folder = self.output / "cases" / "team_30"
        if not self.simulate(
            folder, {"--robots": "30", "--size": "100x60", "--overlap": "0.8", "--others": "0"}, 1
        ):
            return []
        rows = []
        for robots in TEAM_SIZES:
            maps = [folder / f"robot_{i}.yaml" for i in range(1, robots + 1)]
            start = time.monotonic()
            code, memory = run([self.gridmerge, "merge", *maps, "-o", folder / "merged", "--quiet"])
            seconds = time.monotonic() - start
            if code not in (0, 3):
                sys.exit(f"benchmark: merging {robots} maps failed")
            merged = json.loads((folder / "merged" / "transforms.json").read_text())
            rows.append(
                {
                    "maps": robots,
                    "pairs": robots * (robots - 1) // 2,
                    "seconds": f"{seconds:.1f}",
                    "peak MB": f"{memory:.0f}",
                    "components": len(merged["components"]),
                    "left out": len(merged["left_out"]),
                }
            )
        return rows

    def walk(self) -> list[dict]:
        """The paper's random walk on some of the pairs of the overlap family, at 0.1 m."""
        rows = []
        for overlap in WALK_OVERLAPS:
            engine, walk = [], []
            for seed in self.seeds(max(2, self.repeats // 4)):
                folder = self.output / "cases" / f"walk_{overlap}_{seed}"
                if not self.simulate(
                    folder, {"--overlap": overlap, "--resolution": "0.1", "--others": "0"}, seed
                ):
                    continue
                engine += self.evaluate(folder, folder / "pairs.tsv")[0]["cases"]
                walk += self.evaluate(
                    folder, folder / "pairs.tsv", "--search", "random-walk", "--c-lock", "0,7.5"
                )[0]["cases"]
            for method, cases in (("exhaustive", engine), ("random walk", walk)):
                rows.append({"overlap": overlap, "method": method} | counts_of(cases))
        return rows


def real_maps(bench: Bench, data: pathlib.Path) -> str:
    rows = []
    for name in ("halmstad", "radish"):
        folder = data / name
        if (folder / "pairs.tsv").is_file():
            work = bench.output / "cases" / name
            work.mkdir(parents=True, exist_ok=True)
            result, memory = bench.evaluate(
                work, folder / "pairs.tsv", "--negatives", folder / "negatives.tsv"
            )
            rows.append(summarize(name, result["cases"], memory))
    return "\n## Real maps\n" + (table(rows, "maps") if rows else f"There are none at {data}.\n")


def parts(text: str) -> tuple[str, ...]:
    named = tuple(text.split(","))
    for part in named:
        if part not in PARTS:
            raise argparse.ArgumentTypeError(f"no part is called '{part}': there are {', '.join(PARTS)}")
    return named


def report_families(bench: Bench, families: dict) -> str:
    report = ""
    for family, rows in families.items():
        label = FAMILIES[family][0]
        plot_family(rows, label, bench.output / f"{family}.png")
        report += f"\n## {family}\n![{label}]({family}.png)\n\n{table([with_intervals(row) for row in rows], label)}"
        if family == "size":
            plot_cost(rows, label, bench.output / "cost.png")
            report += "\n![Time and memory](cost.png)\n"
        if family == "overlap":
            report += "\n## Shared wall\nThe pairs of the overlap family.\n\n"
            report += table(by_shared_wall([case for case in bench.cases if case["family"] == "overlap"]))
    if bench.cases:
        error = plot_probability(bench.cases, bench.output / "probability.png")
        report += "\n## The probability\n![ROC and reliability](probability.png)\n\n"
        report += f"Expected calibration error {error:.3f} over {len(bench.cases)} cases of all families.\n"
    return report


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--gridmerge", type=pathlib.Path, required=True)
    parser.add_argument("--output", type=pathlib.Path, required=True)
    parser.add_argument("--data", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--full", action="store_true")
    parser.add_argument(
        "--only", type=parts, default=PARTS, metavar="PART,...", help=f"of {', '.join(PARTS)}"
    )
    arguments = parser.parse_args()
    bench = Bench(arguments.gridmerge, arguments.output, 64 if arguments.full else 8)
    (arguments.output / "cases").mkdir(parents=True, exist_ok=True)

    # All measurements first: see pyplot().
    families = {}
    for family in (family for family in FAMILIES if family in arguments.only):
        print(f"{family} ...", flush=True)
        families[family] = bench.sweep(family, FAMILIES[family][1])
    rest = ""
    if "ratio" in arguments.only:
        rest += "\n## Ratio of the two maps' cells\n" + table(
            [with_intervals(row) for row in bench.ratios()], "ratio"
        )
    if "teams" in arguments.only:
        rest += "\n## Teams of six\n" + table(bench.teams())
        sizes = bench.team_sizes()
        rest += "\n## Size of the team\n" + (table(sizes) if sizes else "The team could not be simulated.\n")
    if "walk" in arguments.only:
        rest += "\n## Beside the paper's random walk\n" + table(bench.walk())
    if "real" in arguments.only:
        rest += real_maps(bench, arguments.data)

    report = "# Where the engine works, and where it breaks\n"
    others = " ".join(f"{k} {v}" for k, v in BASE.items())
    report += f"Simulated maps; in each table one factor is swept, the others are {others}.\n"
    report += report_families(bench, families) + rest
    (arguments.output / "report.md").write_text(report)
    print(f"wrote {arguments.output / 'report.md'}")


if __name__ == "__main__":
    main()
