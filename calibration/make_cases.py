#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the cases that the verdict's model is fitted to: simulated buildings of all kinds, true pairs and unrelated
ones, and what the engine makes of each (gridmerge evaluate --features).

usage: calibration/make_cases.py GRIDMERGE OUTPUT [--buildings N] [--seed N] [--jobs N] [--real FOLDER]
                                 [--unrelated N] [--domains A,B,...] [--keep]

Every kind of building is a domain, and so is every real building: a model is judged on a domain that its fit has not
seen. Each building is made at random: its size, how much robots share, how far maps bend, their resolution, clutter,
sensor and noise; a third of the maps are tidied. FOLDER is what calibration/make_real_cases.py wrote. Writes
    <kind>/<building>/     the maps of three robots; what is there already is not made again
    <domain>/pairs.tsv, negatives.tsv   as `gridmerge evaluate` takes them; of real buildings in real/<domain>
    <domain>/cases.tsv     fixed moving truth kind domain other: what else is known of each line of both tables
    features/<domain>.tsv  kind and other, then what evaluate writes; --keep leaves those be that are there
Kinds of unrelated pairs of simulated maps:
    same_kind      of two buildings of one kind
    same_building  of one building, and no place in common
    other_kind     of two kinds
The first and the last are of one resolution, as true pairs are. An unrelated pair belongs to the fixed map's domain;
`other` is the moving map's. Of all that a domain has, --unrelated are drawn, of each kind in turn. The cases do
not depend on --jobs. --domains says which features are written.
"""

import argparse
import collections
import concurrent.futures
import csv
import itertools
import math
import os
import pathlib
import random
import shutil
import subprocess

KINDS = [
    "office",
    "hall",
    "warehouse",
    "apartment",
    "symmetric",
    "loop",
    "curved",
    "outdoor",
    "corridor",
    "arena",
    "maze",
    "bare",
]
# Least and most of width and height [m].
SIZES = {
    "apartment": ((10, 22), (8, 16)),
    "corridor": ((35, 120), (10, 25)),
    "arena": ((8, 25), (8, 25)),
    "maze": ((8, 30), (8, 25)),
}
SIZE = ((22, 75), (16, 45))
ROBOTS = 3
OVERLAPS = [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9]  # on average over a building's robots
LARGER = [0.3, 0.5, 0.7, 0.9]  # tried one after the other where the wanted one cannot be had
SAME_KIND, OTHER_KIND = 3, 1  # unrelated pairs for each map
CASE = ["fixed", "moving", "truth", "kind", "domain", "other"]
PAIR = ["fixed", "moving", "x", "y", "theta", "tolerance", "tier", "overlap"]
# All other columns are figures.
TEXTS = {"kind", "other", "fixed", "moving", "tier", "hypothesis", "truth", "reason"}

Row = dict[str, str]


def read_rows(path: pathlib.Path) -> list[Row]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def write_rows(path: pathlib.Path, columns: list[str], rows: list[Row]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, delimiter="\t", lineterminator="\n", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


# Simulated buildings


def draw_options(kind: str, dice: random.Random) -> dict[str, str]:
    """The options of one building."""
    width, height = (dice.uniform(*side) for side in SIZES.get(kind, SIZE))
    options = {
        "--kind": kind,
        "--size": f"{width:.1f}x{height:.1f}",
        "--robots": str(ROBOTS),
        "--others": "0",
        "--overlap": f"{dice.choice(OVERLAPS)}",
        "--drift": f"{dice.choice([0.0, dice.uniform(0, 0.5), dice.uniform(0.5, 2.0), dice.uniform(1.0, 3.5)]):.2f}",
        "--clutter": f"{dice.uniform(0, 2):.2f}",
        "--noise": f"{dice.uniform(0.005, 0.04):.3f}",
        "--resolution": dice.choice(["0.025", "0.05", "0.05", "0.1", "0.1"]),
        "--range": f"{math.exp(dice.uniform(math.log(3), math.log(30))):.1f}",
        "--angular-step": dice.choice(["0.25", "0.5", "1", "2", "4"]),
        "--seed": str(dice.randrange(1 << 32)),
    }
    if dice.random() < 1 / 3:
        options["--tidy"] = f"{dice.uniform(0.02, 0.1):.2f}"
    return options


def make_building(gridmerge: str, folder: pathlib.Path, options: dict[str, str]) -> bool:
    """Whether there is one: in small and open buildings robots always share much."""
    wanted = " ".join(word for option in options.items() for word in option)
    done = folder / "options.txt"
    if not done.exists() or done.read_text() != wanted:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        overlap = float(options["--overlap"])
        for one in [overlap, *(larger for larger in LARGER if larger > overlap)]:
            words = [word for option in (options | {"--overlap": str(one)}).items() for word in option]
            made = subprocess.run(
                [gridmerge, "simulate", "-o", folder, "--threads", "1", "--quiet", *words],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            if made.returncode == 0:
                break
        done.write_text(wanted)
    return (folder / "pairs.tsv").exists()


def make_buildings(
    gridmerge: str, output: pathlib.Path, count: int, seed: int, jobs: int
) -> dict[str, dict[str, str]]:
    """All buildings that can be had, as <kind>/<building>, and the resolution of each."""
    wanted = {}
    for kind in KINDS:
        dice = random.Random(f"{seed} {kind}")
        wanted |= {f"{kind}/{kind}_{i}": draw_options(kind, dice) for i in range(count)}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        made = list(pool.map(lambda one: make_building(gridmerge, output / one[0], one[1]), wanted.items()))
    return {name: options for (name, options), there in zip(wanted.items(), made, strict=True) if there}


def kind_of(name: str) -> str:
    return name.split("/")[0]


def case(row: Row, truth: str, kind: str) -> Row:
    """A line of a table, whose maps are named <kind>/<building>/<robot>."""
    return row | {
        "truth": truth,
        "kind": kind,
        "domain": kind_of(row["fixed"]),
        "other": kind_of(row["moving"]),
    }


def cases_within(output: pathlib.Path, building: str) -> list[Row]:
    cases = []
    for table, truth, kind in (("pairs.tsv", "pair", "pair"), ("negatives.tsv", "negative", "same_building")):
        for row in read_rows(output / building / table):
            names = {side: f"{building}/{row[side]}" for side in ("fixed", "moving")}
            cases.append(case(row | names, truth, kind))
    return cases


def cases_between(buildings: dict[str, dict[str, str]], dice: random.Random) -> list[Row]:
    """Unrelated pairs of maps of two buildings."""
    alike = collections.defaultdict(list)
    for building, options in buildings.items():
        alike[options["--resolution"]].append(building)
    cases = []
    for building, options in buildings.items():
        others = [other for other in alike[options["--resolution"]] if other != building]
        same = [other for other in others if kind_of(other) == kind_of(building)]
        foreign = [other for other in others if kind_of(other) != kind_of(building)]
        for robot in range(1, ROBOTS + 1):
            for kind, pool, count in (("same_kind", same, SAME_KIND), ("other_kind", foreign, OTHER_KIND)):
                for other in dice.sample(pool, min(count, len(pool))):
                    moving = f"{other}/robot_{dice.randint(1, ROBOTS)}.yaml"
                    cases.append(
                        case({"fixed": f"{building}/robot_{robot}.yaml", "moving": moving}, "negative", kind)
                    )
    return cases


def write_cases(folder: pathlib.Path, root: pathlib.Path, cases: list[Row]) -> None:
    """The tables of one domain. Its maps are named relative to `root`, and in the tables to `folder`."""
    cases = [
        row | {side: os.path.relpath(root / row[side], folder) for side in ("fixed", "moving")}
        for row in cases
    ]
    write_rows(folder / "pairs.tsv", PAIR, [row for row in cases if row["truth"] == "pair"])
    write_rows(folder / "negatives.tsv", CASE[:2], [row for row in cases if row["truth"] == "negative"])
    write_rows(folder / "cases.tsv", CASE, cases)


def draw_unrelated(cases: list[Row], count: int, seed: str) -> list[Row]:
    """All true pairs, and `count` unrelated ones, of each kind in turn."""
    dice = random.Random(seed)
    by_kind = collections.defaultdict(list)
    for row in cases:
        if row["truth"] == "negative":
            by_kind[row["kind"]].append(row)
    for its in by_kind.values():
        dice.shuffle(its)
    in_turn = (row for rows in itertools.zip_longest(*by_kind.values()) for row in rows if row is not None)
    return [row for row in cases if row["truth"] != "negative"] + list(itertools.islice(in_turn, count))


def by_domain(cases: list[Row], unrelated: int, seed: int) -> dict[str, list[Row]]:
    """The cases of each domain, so many unrelated ones of them."""
    domains = collections.defaultdict(list)
    for row in cases:
        domains[row["domain"]].append(row)
    return {domain: draw_unrelated(its, unrelated, f"{seed} {domain}") for domain, its in domains.items()}


def counts(cases: list[Row]) -> str:
    kinds = collections.Counter(row["kind"] for row in cases)
    return ", ".join(f"{kind} {count}" for kind, count in kinds.items())


# Real buildings


def real_cases(folder: pathlib.Path) -> list[Row]:
    truths = {(row["fixed"], row["moving"]): row for row in read_rows(folder / "pairs.tsv")}
    return [truths.get((row["fixed"], row["moving"]), {}) | row for row in read_rows(folder / "cases.tsv")]


# Features


def compact(row: Row, known: Row, folder: pathlib.Path, root: pathlib.Path) -> Row:
    """With what is known of the pair before it, maps named relative to `root`, and figures in six digits."""
    names = {side: os.path.relpath(folder / row[side], root) for side in ("fixed", "moving")}
    entries = {name: value if name in TEXTS else f"{float(value):.6g}" for name, value in row.items()}
    return {"kind": known["kind"], "other": known["other"]} | entries | names


def write_features(
    gridmerge: str, folder: pathlib.Path, root: pathlib.Path, path: pathlib.Path, jobs: int
) -> None:
    """Of the tables in a folder, whose maps are in `root`."""
    found = folder / "features.tsv"
    path.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run(
        [
            gridmerge,
            "evaluate",
            folder / "pairs.tsv",
            "--negatives",
            folder / "negatives.tsv",
            "--features",
            found,
            "--quiet",
            "--threads",
            str(jobs),
        ],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    known = {(row["fixed"], row["moving"]): row for row in read_rows(folder / "cases.tsv")}
    rows = [compact(row, known[row["fixed"], row["moving"]], folder, root) for row in read_rows(found)]
    if rows:
        write_rows(path, list(rows[0]), rows)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gridmerge")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--buildings", type=int, default=50, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--unrelated", type=int, default=130, help="unrelated pairs of each domain")
    parser.add_argument("--domains", help="write features of these only")
    parser.add_argument(
        "--real", type=pathlib.Path, metavar="FOLDER", help="of calibration/make_real_cases.py"
    )
    parser.add_argument("--keep", action="store_true", help="features that are there are not written again")
    arguments = parser.parse_args()
    gridmerge, output = arguments.gridmerge, arguments.output

    buildings = make_buildings(gridmerge, output, arguments.buildings, arguments.seed, arguments.jobs)
    cases = [row for building in buildings for row in cases_within(output, building)]
    cases += cases_between(buildings, random.Random(f"{arguments.seed} unrelated"))
    folders, roots = {}, {}
    for domain, its in by_domain(cases, arguments.unrelated, arguments.seed).items():
        folders[domain], roots[domain] = output / domain, output
        write_cases(folders[domain], output, its)
        made = sum(kind_of(building) == domain for building in buildings)
        print(f"{domain}: {made} of {arguments.buildings} buildings could be made; {counts(its)}", flush=True)
    if arguments.real:
        for domain, its in by_domain(real_cases(arguments.real), arguments.unrelated, arguments.seed).items():
            folders[domain], roots[domain] = output / "real" / domain, arguments.real
            write_cases(folders[domain], arguments.real, its)
            print(f"{domain}: {counts(its)}", flush=True)
    wanted = arguments.domains.split(",") if arguments.domains else list(folders)
    for domain in wanted:
        path = output / "features" / f"{domain}.tsv"
        if not (arguments.keep and path.exists()):
            write_features(gridmerge, folders[domain], roots[domain], path, arguments.jobs)
            print(f"wrote {path}", flush=True)


if __name__ == "__main__":
    main()
