#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes a large set of cases from real maps with ground truth: true pairs, true pairs of pieces, and unrelated pairs.

usage: calibration/make_real_cases.py DATA OUTPUT [--seed N]

DATA holds radish/ and halmstad/. Their licences are not this project's, so OUTPUT stays outside of the repository.
Writes
    maps/<domain>/*.yaml, .pgm   whole maps, and rectangles and discs cut out of them, in the frames of their maps
    pairs.tsv, negatives.tsv     as `gridmerge evaluate` takes them
    cases.tsv                    fixed moving truth kind domain other: what else is known of each line of both tables
A domain is a building. `other` is the domain of the moving map. Kinds of true pairs:
    pair           as the data names it
    set            two members of a set
    piece          pieces of the two maps of a pair or set
Kinds of unrelated pairs:
    cross          whole maps of two buildings
    cross_piece    the same, but one of them at least is a piece
    same_building  what the two know lies 3 m apart at least
The same seed makes the same cases. Takes about three minutes.
"""

import argparse
import collections
import csv
import dataclasses
import itertools
import math
import pathlib
import random

from grids import Grid, Pose, compose, cropped, inverse, overlap, read_grid, shared_walls, write_grid
from pieces import BENT, GAP, Map, Relation, cut_apart, cut_overlapping, least_area, places_apart

LASER_PIECES, BENT_PIECES = 400, 300
NEGATIVES = {"same_building": 1500, "cross_piece": 3000, "cross": 6000}
OVERLAPS = (0.05, 0.9)
LEAST_OVERLAP = 0.03  # of two members of a set
TIERS = (("A", 20.0, 0.8), ("B", 7.5, 0.6), ("C", 0.0, 0.0))  # shared wall [m], share of it that matches


@dataclasses.dataclass(frozen=True)
class Case:
    fixed: str
    moving: str
    kind: str
    domain: str
    other: str


@dataclasses.dataclass(frozen=True)
class TrueCase(Case):
    pose: Pose
    tolerance: float
    tier: str
    overlap: float


# What is there


def read_rows(path: pathlib.Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def pose_of(row: dict[str, str]) -> Pose:
    return (float(row["x"]), float(row["y"]), float(row["theta"]))


def read_maps(data: pathlib.Path) -> dict[str, Map]:
    """All maps but the layouts, by their path within the data."""
    maps = {}
    for path in sorted([*data.glob("radish/*/*/*.yaml"), *data.glob("halmstad/*_[0-9]*.yaml")]):
        relative = path.relative_to(data)
        bent = relative.parts[0] == "halmstad"
        domain = path.stem.split("_")[0] if bent else path.parent.name.rsplit("_", 1)[0]
        name = path.stem if bent else "_".join(relative.with_suffix("").parts[1:])
        maps[relative.as_posix()] = Map(f"maps/{domain}/{name}.yaml", domain, cropped(read_grid(path)))
    return maps


def read_relations(data: pathlib.Path, maps: dict[str, Map]) -> list[Relation]:
    """The true pairs, and all pairs of members of a set."""
    marks = collections.defaultdict(list)
    for row in read_rows(data / "halmstad/marks.tsv"):
        marks[row["fixed"], row["moving"]].append(
            tuple(float(row[key]) for key in ("x_fixed", "y_fixed", "x_moving", "y_moving"))
        )
    relations = []
    for source in ("radish", "halmstad"):
        for row in read_rows(data / source / "pairs.tsv"):
            relations.append(
                Relation(
                    "pair",
                    maps[f"{source}/{row['fixed']}"],
                    maps[f"{source}/{row['moving']}"],
                    pose_of(row),
                    float(row["tolerance"]),
                    row["tier"],
                    tuple(marks[row["fixed"], row["moving"]] if source == "halmstad" else ()),
                )
            )
    sets = collections.defaultdict(list)
    for row in read_rows(data / "radish/sets.tsv"):
        sets[row["set"]].append(row)
    for members in sets.values():
        for a, b in itertools.combinations(members, 2):
            relations.append(
                Relation(
                    "set",
                    maps[f"radish/{a['map']}"],
                    maps[f"radish/{b['map']}"],
                    compose(inverse(pose_of(a)), pose_of(b)),
                    float(b["tolerance"]),
                )
            )
    return relations


# True pairs


def tier_of(fixed: Grid, moving: Grid, pose: Pose) -> str:
    cells, share = shared_walls(fixed, moving, pose)
    length = cells * fixed.resolution
    return next(tier for tier, least, matching in TIERS if length >= least and share >= matching)


def true_case(relation: Relation) -> TrueCase:
    fixed, moving = relation.fixed, relation.moving
    tier = relation.tier or tier_of(fixed.grid, moving.grid, relation.pose)
    return TrueCase(
        fixed.name,
        moving.name,
        relation.kind,
        relation.domain,
        relation.domain,
        relation.pose,
        relation.tolerance,
        tier,
        overlap(fixed.grid, moving.grid, relation.pose),
    )


def cut_true_pieces(relations: list[Relation], count: int, seed: str) -> list[Relation]:
    """`count` pairs of pieces of one domain's maps, with overlaps all over the range. Fewer, if they cannot be had."""
    dice, result = random.Random(seed), []
    for i in range(count):
        wanted = OVERLAPS[0] + (OVERLAPS[1] - OVERLAPS[0]) * (i + dice.random()) / count
        for relation in dice.sample(relations, len(relations)):
            pieces = cut_overlapping(relation, wanted, f"piece_{i:03}", dice)
            if pieces:
                result.append(pieces)
                break
    return result


# Unrelated pairs


def negative(kind: str, a: Map, b: Map) -> Case:
    return Case(a.name, b.name, kind, a.domain, b.domain)


def same_building(relations: list[Relation], count: int, seed: str) -> tuple[list[Case], list[Map]]:
    """Of one domain: members of sets that share no place, then pieces; and the pieces' maps."""
    dice, maps = random.Random(seed), []
    cases = [
        negative("same_building", relation.fixed, relation.moving)
        for relation in relations
        if relation.kind == "set" and places_apart(relation, GAP)
    ]
    selves = [
        Relation("self", a, a, (0.0, 0.0, 0.0), 0.5)
        for a in {relation.fixed.name: relation.fixed for relation in relations}.values()
    ]
    for share in (1.0, 0.5):  # small buildings do not hold two pieces of full size
        for _ in range(2 * count):
            if len(cases) >= count:
                break
            relation = dice.choice(selves if dice.random() < 0.5 else relations)
            pieces = cut_apart(relation, share * least_area(relation.domain), f"apart_{len(cases):03}", dice)
            if pieces:
                cases.append(negative("same_building", *pieces))
                maps += pieces
    return cases, maps


def fair_shares(available: dict, total: int) -> dict:
    """`total` parted as evenly as what there is of each allows."""
    shares, left = {}, total
    for i, key in enumerate(sorted(available, key=lambda key: (available[key], key))):
        shares[key] = min(available[key], left // (len(available) - i))
        left -= shares[key]
    return shares


def cross_pairs(
    kind: str, maps: list[Map], pieces: list[Map], total: int, listed: list[Case], seed: str
) -> list[Case]:
    """Pairs of maps of two buildings, each two buildings about as often. Those that are listed come first. If there are
    pieces, one of the two is one at least."""
    dice, by_domain = random.Random(seed), collections.defaultdict(list)
    for one in maps + pieces:
        by_domain[one.domain].append(one)
    cut = {one.name for one in pieces}
    fits = {}
    for a, b in itertools.combinations(sorted(by_domain), 2):
        fits[a, b] = [
            (p, q) for p in by_domain[a] for q in by_domain[b] if not cut or p.name in cut or q.name in cut
        ]
    cases = {frozenset((case.fixed, case.moving)): case for case in listed}
    for domains, count in fair_shares(
        {domains: len(all_of) for domains, all_of in fits.items()}, total
    ).items():
        have = sum({case.domain, case.other} == set(domains) for case in listed)
        for p, q in dice.sample(fits[domains], len(fits[domains])):
            if have >= count:
                break
            key = frozenset((p.name, q.name))
            if key not in cases:
                cases[key] = negative(kind, *dice.sample((p, q), 2))
                have += 1
    return list(cases.values())


def listed_negatives(data: pathlib.Path, maps: dict[str, Map]) -> list[Case]:
    cases = []
    for source in ("radish", "halmstad"):
        for row in read_rows(data / source / "negatives.tsv"):
            a, b = maps[f"{source}/{row['fixed']}"], maps[f"{source}/{row['moving']}"]
            cases.append(negative("same_building" if a.domain == b.domain else "cross", a, b))
    return cases


# All together


def make_cases(data: pathlib.Path, seed: int) -> tuple[list[Map], list[TrueCase], list[Case]]:
    maps = read_maps(data)
    relations = read_relations(data, maps)
    by_domain = collections.defaultdict(list)
    for relation in relations:
        by_domain[relation.domain].append(relation)

    true_cases = [
        case for case in map(true_case, relations) if case.kind == "pair" or case.overlap >= LEAST_OVERLAP
    ]
    pieces, apart_maps, negatives = [], [], []
    listed = listed_negatives(data, maps)
    for domain, its in sorted(by_domain.items()):
        usable = [
            relation
            for relation in its
            if overlap(relation.fixed.grid, relation.moving.grid, relation.pose) >= LEAST_OVERLAP
        ]
        count = BENT_PIECES // 2 if domain in BENT else math.ceil(LASER_PIECES / (len(by_domain) - len(BENT)))
        cut = cut_true_pieces(usable, count, f"{seed} pieces {domain}")
        true_cases += map(true_case, cut)
        pieces += [one for relation in cut for one in (relation.fixed, relation.moving)]
        known = [case for case in listed if case.kind == "same_building" and case.domain == domain]
        wanted = round(NEGATIVES["same_building"] / len(by_domain)) - len(known)
        cases, its_maps = same_building(its, wanted, f"{seed} apart {domain}")
        negatives += known + cases
        apart_maps += its_maps
        print(
            f"{domain}: {len(cut)} true pairs of pieces, {len(known) + len(cases)} unrelated pairs",
            flush=True,
        )
    whole = list(maps.values())
    negatives += cross_pairs(
        "cross",
        whole,
        [],
        NEGATIVES["cross"],
        [case for case in listed if case.kind == "cross"],
        f"{seed} cross",
    )
    negatives += cross_pairs(
        "cross_piece", whole, pieces, NEGATIVES["cross_piece"], [], f"{seed} cross_piece"
    )
    return whole + pieces + apart_maps, true_cases, negatives


def write_table(path: pathlib.Path, columns: list[str], rows: list[list]) -> None:
    lines = ["\t".join(map(str, row)) for row in [columns, *rows]]
    path.write_text("\n".join(lines) + "\n")


def write_cases(
    output: pathlib.Path, maps: list[Map], true_cases: list[TrueCase], negatives: list[Case]
) -> None:
    for one in maps:
        write_grid(output / one.name, one.grid)
    write_table(
        output / "pairs.tsv",
        ["fixed", "moving", "x", "y", "theta", "tolerance", "tier", "overlap"],
        [
            [
                case.fixed,
                case.moving,
                *(f"{value:.6f}" for value in (*case.pose, case.tolerance)),
                case.tier,
                f"{case.overlap:.4f}",
            ]
            for case in true_cases
        ],
    )
    write_table(
        output / "negatives.tsv", ["fixed", "moving"], [[case.fixed, case.moving] for case in negatives]
    )
    write_table(
        output / "cases.tsv",
        ["fixed", "moving", "truth", "kind", "domain", "other"],
        [
            [
                case.fixed,
                case.moving,
                "pair" if isinstance(case, TrueCase) else "negative",
                case.kind,
                case.domain,
                case.other,
            ]
            for case in [*true_cases, *negatives]
        ],
    )


def summary(true_cases: list[TrueCase], negatives: list[Case]) -> str:
    columns = ["pair", "set", "piece", "A", "B", "C", "sensor", *NEGATIVES]
    counts = collections.Counter()
    for case in true_cases:
        counts[case.domain, case.kind] += 1
        counts[case.domain, case.tier] += 1
    for case in negatives:
        counts[case.domain, case.kind] += 1
    rows = [["domain", *columns]]
    for domain in sorted({case.domain for case in [*true_cases, *negatives]}):
        rows.append([domain, *(counts[domain, column] for column in columns)])
    rows.append(["all", *(sum(row[i] for row in rows[1:]) for i in range(1, len(columns) + 1))])
    return "\n".join(f"{row[0]:<18}" + "".join(f"{cell:>14}" for cell in row[1:]) for row in rows)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    maps, true_cases, negatives = make_cases(arguments.data, arguments.seed)
    write_cases(arguments.output, maps, true_cases, negatives)
    print(summary(true_cases, negatives))


if __name__ == "__main__":
    main()
