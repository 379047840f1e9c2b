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
import itertools
import json
import math
import os
import pathlib
import subprocess
import sys
import time

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
# Limits of shared wall [m] between which pairs are counted together.
WALLS = (0, 2.5, 5, 10, 20, 40, 80, math.inf)
FIRST_SEED = 20001  # nothing of the engine was fitted to maps of this seed and the next ones
LARGE = 160  # floors of so many metres take a minute each, so there are fewer
MOST_LARGE = 16
NONE = "\N{EN DASH}"  # in a table, where there is no figure


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


def counts_of(cases: list[dict]) -> dict:
    pairs = [case for case in cases if case["correct"] is not None]
    accepted = [case for case in pairs if case["verdict"] == "accepted"]
    seconds = sorted(case["seconds"] for case in cases)
    return {
        "pairs": len(pairs),
        "best right": sum(case["correct"] for case in pairs),
        "accepted right": sum(case["correct"] for case in accepted),
        "accepted wrong": sum(not case["correct"] for case in accepted),
        "median s": f"{seconds[len(seconds) // 2]:.3f}" if seconds else NONE,
    }


def interval(right: int, of: int) -> str:
    """The rates that could well have given so many of so many: Wilson's interval of 95 %."""
    if of == 0:
        return NONE
    z, rate = 1.96, right / of
    middle, half = rate + z * z / (2 * of), z * math.sqrt(rate * (1 - rate) / of + z * z / (4 * of * of))
    return f"{max(0.0, (middle - half) / (1 + z * z / of)):.2f} to {min(1.0, (middle + half) / (1 + z * z / of)):.2f}"


def by_shared_wall(cases: list[dict]) -> list[dict]:
    rows = []
    for least, below in itertools.pairwise(WALLS):
        inside = [
            case for case in cases if case["shared_wall"] is not None and least <= case["shared_wall"] < below
        ]
        rows.append(
            with_intervals(
                {"shared wall [m]": f"{least:g} to {below:g}" if below < math.inf else f"from {least:g}"}
                | counts_of(inside)
            )
        )
    return rows


def with_intervals(row: dict) -> dict:
    """With the intervals of the rates of right and accepted ones after their numbers."""
    return row | {
        key: f"{row[key]} ({interval(row[key], row['pairs'])})" for key in ("best right", "accepted right")
    }


def summarize(value, cases: list[dict], memory: float) -> dict:
    negatives = [case for case in cases if case["correct"] is None]
    return (
        {"value": value}
        | counts_of(cases)
        | {
            "unrelated accepted": f"{sum(case['verdict'] == 'accepted' for case in negatives)} of {len(negatives)}",
            "peak MB": f"{memory:.0f}",
        }
    )


def table(rows: list[dict], first: str | None = None) -> str:
    columns = list(rows[0])
    names = [first if first and column == "value" else column for column in columns]
    lines = ["| " + " | ".join(names) + " |", "|" + " --- |" * len(columns)]
    lines += ["| " + " | ".join(str(row[column]) for column in columns) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def share(row: dict, key: str) -> float:
    return row[key] / row["pairs"] if row["pairs"] else 0.0


def pyplot():
    """Imported late: a child's peak memory counts from that of the process that started it."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot

    return matplotlib.pyplot


def plot_family(rows: list[dict], label: str, path: pathlib.Path) -> None:
    plt = pyplot()
    figure, axes = plt.subplots(figsize=(5, 3))
    numbers = [row["value"] for row in rows]
    for key, colour, marker in (
        ("best right", "#0072b2", "o"),
        ("accepted right", "#009e73", "s"),
        ("accepted wrong", "#d55e00", "x"),
    ):
        axes.plot(range(len(rows)), [share(row, key) for row in rows], color=colour, marker=marker, label=key)
    axes.set_xticks(
        range(len(rows)), [str(number) for number in numbers], rotation=30 if label.startswith("kind") else 0
    )
    axes.set_xlabel(label)
    axes.set_ylabel("share of the pairs")
    axes.set_ylim(-0.02, 1.02)
    axes.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def plot_cost(rows: list[dict], label: str, path: pathlib.Path) -> None:
    """Time and memory of a match; memory is the process's, two maps and all."""
    plt = pyplot()
    figure, axes = plt.subplots(figsize=(5, 3))
    values = [str(row["value"]) for row in rows]
    axes.plot(
        values,
        [math.nan if row["median s"] == NONE else float(row["median s"]) for row in rows],
        color="#0072b2",
        marker="o",
    )
    axes.set_xlabel(label)
    axes.set_ylabel("median seconds a match", color="#0072b2")
    axes.set_ylim(bottom=0)
    memory = axes.twinx()
    memory.plot(values, [float(row["peak MB"]) for row in rows], color="#d55e00", marker="s")
    memory.set_ylabel("peak memory [MB]", color="#d55e00")
    memory.set_ylim(bottom=0)
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def plot_probability(cases: list[dict], path: pathlib.Path) -> float:
    """ROC and reliability; the expected calibration error."""
    judged = sorted(((case["probability"], bool(case["correct"])) for case in cases), reverse=True)
    right = sum(r for _, r in judged) or 1
    wrong = len(judged) - right or 1
    plt = pyplot()
    figure, (roc, reliability) = plt.subplots(1, 2, figsize=(8, 3.4))
    xs, ys, seen = [0.0], [0.0], [0, 0]
    for _, is_right in judged:
        seen[is_right] += 1
        xs.append(seen[0] / wrong)
        ys.append(seen[1] / right)
    roc.plot(xs, ys, color="#0072b2")
    roc.set_xlabel("wrong or unrelated, accepted")
    roc.set_ylabel("right, accepted")
    error = 0.0
    means, shares = [], []
    for low in range(10):
        inside = [(p, r) for p, r in judged if low / 10 <= p < (low + 1) / 10 or (low == 9 and p >= 1.0)]
        if inside:
            means.append(sum(p for p, _ in inside) / len(inside))
            shares.append(sum(r for _, r in inside) / len(inside))
            error += abs(means[-1] - shares[-1]) * len(inside) / len(judged)
    reliability.plot([0, 1], [0, 1], color="#999999", linewidth=0.8)
    reliability.plot(means, shares, color="#0072b2", marker="o")
    reliability.set_xlabel("probability given")
    reliability.set_ylabel("share right")
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)
    return error


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
