# SPDX-License-Identifier: Apache-2.0
"""The pairs that peers.py gives to every matcher: simulated ones, and real ones where there are any."""

import concurrent.futures
import csv
import dataclasses
import pathlib
import subprocess

OFFICE = ("office", "40x25")
SEEDS = 20  # of each simulated set, from 1
OVERLAPS = ("0.6", "0.3")
TRAINING = (OFFICE, ("hall", "40x25"), ("warehouse", "40x25"), ("apartment", "14x11"))
TRAINING_SEEDS = range(101, 106)


@dataclasses.dataclass(frozen=True)
class Case:
    group: str
    fixed: pathlib.Path
    moving: pathlib.Path
    truth: tuple[float, float, float] | None = None  # None: nothing in common
    tolerance: float = 0.0


def sample(rows: list, limit: int | None) -> list:
    """At most `limit` of them, evenly spaced."""
    if limit is None or len(rows) <= limit:
        return rows
    return [rows[i * len(rows) // limit] for i in range(limit)]


def read_cases(folder: pathlib.Path, group: str) -> list[Case]:
    """Of the folder's pairs.tsv and negatives.tsv. Tiers are groups of their own where there are several of them."""

    def rows(name: str) -> list[dict]:
        with (folder / name).open(newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))

    pairs = rows("pairs.tsv")
    tiers = {row.get("tier") for row in pairs}
    cases = [
        Case(
            f"{group}, tier {row['tier']}" if len(tiers) > 1 else group,
            folder / row["fixed"],
            folder / row["moving"],
            tuple(float(row[key]) for key in ("x", "y", "theta")),
            float(row["tolerance"]),
        )
        for row in pairs
    ]
    return cases + [
        Case(
            f"{group}, unrelated" if len(tiers) > 1 else group, folder / row["fixed"], folder / row["moving"]
        )
        for row in rows("negatives.tsv")
    ]


def simulate(
    gridmerge: pathlib.Path, folder: pathlib.Path, kind: str, size: str, overlap: str, seed: int
) -> bool:
    """Whether there is such a pair: some overlaps cannot be had."""
    if (folder / "negatives.tsv").exists():
        return True
    of_this_pair = f"--kind {kind} --size {size} --overlap {overlap} --seed {seed}"
    of_all = "--robots 2 --drift 0.3 --others 1 --threads 1 --quiet"
    command = [gridmerge, "simulate", "-o", folder, *of_this_pair.split(), *of_all.split()]
    process = subprocess.run(
        [str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    return process.returncode == 0


def simulated_cases(
    pool: concurrent.futures.Executor, gridmerge: pathlib.Path, output: pathlib.Path, limit: int | None
) -> list[Case]:
    seeds = range(1, min(SEEDS, limit or SEEDS) + 1)
    made = [(overlap, seed, output / f"office_{overlap}_{seed}") for overlap in OVERLAPS for seed in seeds]
    jobs = [
        pool.submit(simulate, gridmerge, folder, *OFFICE, overlap, seed) for overlap, seed, folder in made
    ]
    return [
        case
        for (overlap, _, folder), job in zip(made, jobs, strict=True)
        if job.result()
        for case in read_cases(folder, f"simulated office, overlap {overlap}")
    ]


def training_cases(
    pool: concurrent.futures.Executor, gridmerge: pathlib.Path, output: pathlib.Path
) -> list[Case]:
    """Unrelated pairs of simulated maps that are in no set."""
    made = [
        (kind, size, seed, output / f"training_{kind}_{seed}")
        for kind, size in TRAINING
        for seed in TRAINING_SEEDS
    ]
    jobs = [
        pool.submit(simulate, gridmerge, folder, kind, size, OVERLAPS[0], seed)
        for kind, size, seed, folder in made
    ]
    return [
        case
        for (*_, folder), job in zip(made, jobs, strict=True)
        if job.result()
        for case in read_cases(folder, "training")
        if case.truth is None
    ]


def real_cases(data: pathlib.Path) -> list[Case]:
    cases = []
    for group, name in (("laser", "radish"), ("bent, hand-held", "halmstad")):
        if (data / name / "pairs.tsv").is_file():
            cases += read_cases(data / name, group)
        else:
            print(f"{group}: skipped, there are no maps at {data / name}")
    return cases


def limited(cases: list[Case], limit: int | None) -> list[Case]:
    kinds = dict.fromkeys((case.group, case.truth is None) for case in cases)
    return [
        case
        for kind in kinds
        for case in sample([case for case in cases if (case.group, case.truth is None) == kind], limit)
    ]
