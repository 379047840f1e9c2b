#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the verdict's model, and shows how well it does in domains that it has not seen.

usage: calibration/fit.py                 the model, as src/match/verdict_model.hpp has it
       calibration/fit.py --folds         every domain left out in turn, as docs/verdict.md has it
       calibration/fit.py --pack FOLDER   writes calibration/cases.tsv.gz from FOLDER/features
                                          (calibration/make_cases.py)

The model is a nested logit. Which of a pair's hypotheses is the best: each has the rank weights . terms, and the share
exp(rank) of the sum of all. Whether the best one is to be believed: the log-odds bias + weights . terms. A hypothesis's
probability is its share times that belief. Names and values of the terms come from the engine: the columns "rank: ..."
and "term: ..." of `gridmerge evaluate --features`. One of the latter, how far a hypothesis stands out, comes from the
engine's own ranking, so that features have to be written anew when that has changed.
Fitted by penalised maximum likelihood (projected Newton steps), first the ranking, then the belief; a weight stays
within its bounds, so that what speaks for a pose never counts against it. Laser, hand-held and simulated maps weigh the
same, in each of these kinds every domain, and in each domain true pairs as much as unrelated ones. Needs numpy; the
same cases give the same digits.
"""

import argparse
import collections
import csv
import gzip
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
CASES = HERE / "cases.tsv.gz"
TERM, RANK = "term: ", "rank: "
STANDS_OUT = "stands out"  # the term that tells the share: the logarithm of its odds
RIDGE = 1.0  # on weights of terms that are scaled to unit variance
# Corners fit corners, plain rooms fit plain rooms, and corridors slide: of these the cases hold too few. So weights are
# this at least, and more is added to one than was fitted.
LEAST_WEIGHT = {"tells apart": 1.0, "held": 1.0}
CAUTION = {"tells apart": 2.0}
# Hardly a wrong pose has any of it, so the cases alone would give it any weight.
MOST_WEIGHT = {"far ahead, bent": 12.0}
CASES_A_KIND = 540.0  # what the true pairs of a kind of maps weigh together, and the unrelated ones
FEWEST_CASES = 30  # a side with fewer cases weighs less
NOT_PACKED = {"arena"}  # several poses are equally right there, and the truth names one of them
KEPT = 8  # hypotheses of a case that are packed, the most probable ones; right ones are kept always
THRESHOLDS = (0.8, 0.9, 0.95, 0.98)
REAL = {
    "aces": "laser",
    "belgioioso": "laser",
    "csail": "laser",
    "edmonton": "laser",
    "fhw": "laser",
    "freiburg-101": "laser",
    "infinite-corridor": "laser",
    "intel": "laser",
    "seattle": "laser",
    "E5": "hand-held",
    "HIH": "hand-held",
}

Case = collections.namedtuple("Case", "domain other negative tier terms ranks right")
Names = collections.namedtuple("Names", "terms ranks")
Model = collections.namedtuple("Model", "bias terms ranks")


def read_cases(path: pathlib.Path) -> tuple[Names, list[Case]]:
    cases = []
    with gzip.open(path, "rt", newline="") as file:
        rows = csv.reader(file, delimiter="\t")
        columns = next(rows)[5:]
        names = Names(
            *([name.removeprefix(kind) for name in columns if name.startswith(kind)] for kind in (TERM, RANK))
        )
        split = 5 + len(names.terms)
        key, part = None, []
        for row in [*rows, None]:
            if row is None or row[0] != key:
                if part:
                    _, domain, other, tier, _ = part[0][:5]
                    cases.append(
                        Case(
                            domain,
                            other,
                            part[0][4] == "negative",
                            tier,
                            np.array([[float(v) for v in one[5:split]] for one in part]),
                            np.array([[float(v) for v in one[split:]] for one in part]),
                            np.array([one[4] == "right" for one in part]),
                        )
                    )
                part = []
            if row is not None:
                key = row[0]
                part.append(row)
    return names, cases


def pack(folder: pathlib.Path) -> None:
    """One table of all domains' features, with what the fit needs of them."""
    names, packed, number = None, [], 0
    for path in sorted((folder / "features").glob("*.tsv")):
        domain = path.stem
        if domain in NOT_PACKED:
            continue
        with path.open(newline="") as file:
            by_pair = collections.OrderedDict()
            for row in csv.DictReader(file, delimiter="\t"):
                by_pair.setdefault((row["fixed"], row["moving"]), []).append(row)
        for hypotheses in by_pair.values():
            names = names or [
                name for kind in (TERM, RANK) for name in hypotheses[0] if name.startswith(kind)
            ]
            number += 1
            for i, row in enumerate(hypotheses):
                if i < KEPT or row["truth"] == "right":
                    packed.append(
                        [
                            str(number),
                            domain,
                            row.get("other") or domain,
                            row["tier"] or "-",
                            row["truth"],
                            *(f"{float(row[name]):.4g}" for name in names),
                        ]
                    )
    with gzip.GzipFile(CASES, "wb", mtime=0) as file:
        lines = [
            "\t".join(["case", "domain", "other", "tier", "truth", *names]),
            *("\t".join(row) for row in packed),
        ]
        file.write(("\n".join(lines) + "\n").encode())
    print(f"{number} cases, {len(packed)} hypotheses: {CASES}")


def logistic(log_odds):
    """The probability of these log-odds."""
    return 1.0 / (1.0 + np.exp(-log_odds))


def kind_of(domain: str) -> str:
    return REAL.get(domain, "simulated")


def minimise(loss, start: np.ndarray, least: np.ndarray, most: np.ndarray) -> np.ndarray:
    """Projected Newton steps; `loss` gives a value, its gradient and a positive definite second derivative."""
    w = np.clip(start, least, most)
    value, gradient, hessian = loss(w)
    for _ in range(200):
        free = ((w > least) | (gradient < 0.0)) & ((w < most) | (gradient > 0.0))
        step = np.zeros_like(w)
        step[free] = -np.linalg.solve(hessian[np.ix_(free, free)], gradient[free])
        length = 1.0
        while True:
            tried = np.clip(w + length * step, least, most)
            found = loss(tried)
            if found[0] <= value or length < 1e-8:
                break
            length /= 2.0
        moved = np.abs(tried - w).max()
        w, (value, gradient, hessian) = tried, found
        if moved < 1e-9:
            break
    return w


def weigh(cases: list[Case]) -> np.ndarray:
    """What each case counts."""
    sides = collections.Counter((case.domain, case.negative) for case in cases)
    domains = collections.Counter(kind_of(domain) for domain in {case.domain for case in cases})
    return np.array(
        [
            CASES_A_KIND
            / domains[kind_of(case.domain)]
            / max(sides[case.domain, case.negative], FEWEST_CASES)
            for case in cases
        ]
    )


def fit_ranks(cases: list[Case]) -> np.ndarray:
    """Weights of the ranking, from the pairs of which some hypotheses are right and some are not."""
    cases = [case for case in cases if case.right.any() and not case.right.all()]
    weight = weigh(cases)
    terms = np.concatenate([case.ranks for case in cases])
    owner = np.repeat(np.arange(len(cases)), [len(case.ranks) for case in cases])
    right = np.concatenate([case.right for case in cases])
    scale = terms.std(axis=0) + 1e-12
    x = terms / scale

    def loss(w):
        ranks = x @ w
        top = np.full(len(cases), -np.inf)
        np.maximum.at(top, owner, ranks)
        odds = np.exp(ranks - top[owner])
        total = np.bincount(owner, odds, len(cases))
        right_sum = np.bincount(owner, odds * right, len(cases))
        share, of_right = odds / total[owner], odds * right / np.maximum(right_sum, 1e-300)[owner]
        value = -(weight * np.log(np.maximum(right_sum, 1e-300) / total)).sum() + 0.5 * RIDGE * w @ w
        means = np.zeros((len(cases), x.shape[1]))
        np.add.at(means, owner, x * share[:, None])
        hessian = (
            x.T @ (x * (weight[owner] * share)[:, None])
            - (means * weight[:, None]).T @ means
            + RIDGE * np.eye(len(w))
        )
        return value, x.T @ (weight[owner] * (share - of_right)) + RIDGE * w, hessian

    return minimise(loss, np.full(x.shape[1], 0.3), np.zeros(x.shape[1]), np.full(x.shape[1], np.inf)) / scale


def best_of(names: Names, ranks: np.ndarray, case: Case) -> tuple[int, float]:
    """The hypothesis of the largest rank, and its share of what there is."""
    best = int((case.ranks @ ranks).argmax())
    stands_out = case.terms[best][names.terms.index(STANDS_OUT)]
    return best, float(logistic(stands_out))


def fit(names: Names, cases: list[Case]) -> Model:
    ranks = fit_ranks(cases)
    weight = weigh(cases)
    best, share = (
        np.array(part) for part in zip(*(best_of(names, ranks, case) for case in cases), strict=True)
    )
    right = np.array([case.right[i] for case, i in zip(cases, best, strict=True)])
    terms = np.array([case.terms[i] for case, i in zip(cases, best, strict=True)])
    scale = terms.std(axis=0) + 1e-12
    x = np.column_stack([np.ones(len(terms)), terms / scale])
    scaled = list(zip(names.terms, scale, strict=True))
    least = np.array([-np.inf, *(LEAST_WEIGHT.get(name, 0.0) * s for name, s in scaled)])
    most = np.array([np.inf, *(MOST_WEIGHT.get(name, np.inf) * s for name, s in scaled)])
    ridge = np.array([0.0, *([RIDGE] * len(names.terms))])

    def loss(w):
        belief = logistic(np.clip(x @ w, -200.0, 200.0))
        refused = 1.0 - share * belief
        value = -(weight * np.where(right, np.log(np.maximum(share * belief, 1e-300)), np.log(refused))).sum()
        slope = weight * np.where(right, belief - 1.0, share * belief * (1.0 - belief) / refused)
        # Of the logistic part alone, which is positive: an ascent direction everywhere.
        hessian = x.T @ (x * (weight * belief * (1.0 - belief))[:, None]) + np.diag(ridge + 1e-9)
        return value + 0.5 * (ridge * w * w).sum(), x.T @ slope + ridge * w, hessian

    w = minimise(loss, np.array([-5.0, *([0.3] * len(names.terms))]), least, most)
    return Model(
        float(w[0]), w[1:] / scale + np.array([CAUTION.get(name, 0.0) for name in names.terms]), ranks
    )


def judge(names: Names, model: Model, cases: list[Case]) -> list[tuple[float, str]]:
    """The probability of each case's best hypothesis, and whether it is right, wrong or of an unrelated pair."""
    judged = []
    for case in cases:
        best, share = best_of(names, model.ranks, case)
        truth = "negative" if case.negative else "right" if case.right[best] else "wrong"
        judged.append((share * float(logistic(model.bias + case.terms[best] @ model.terms)), truth))
    return judged


def calibration_error(judged: list[tuple[float, str]]) -> float:
    """Expected calibration error in ten bins."""
    bins = collections.defaultdict(list)
    for p, truth in judged:
        bins[min(9, int(10 * p))].append(p - (truth == "right"))
    return sum(abs(sum(part)) for part in bins.values()) / max(1, len(judged))


def count(judged, truth, threshold=-1.0) -> int:
    return sum(t == truth and p >= threshold for p, t in judged)


def row(name: str, judged) -> str:
    counts = [
        f"{count(judged, 'wrong', t)} / {count(judged, 'negative', t)} / {count(judged, 'right', t)}"
        for t in THRESHOLDS
    ]
    pairs = count(judged, "right") + count(judged, "wrong")
    return (
        f"| {name} | {pairs} | {count(judged, 'right')} | {count(judged, 'negative')} | "
        + " | ".join(counts)
        + f" | {calibration_error(judged):.3f} |"
    )


def folds(names: Names, cases: list[Case]) -> None:
    print(
        "| left out | pairs | best right | unrelated | "
        + " | ".join(f"from {t}: wrong / unrelated / right" for t in THRESHOLDS)
        + " | calibration error |"
    )
    print("|" + " --- |" * (5 + len(THRESHOLDS)))
    everything, by_group = [], collections.defaultdict(list)
    groups = {domain: REAL.get(domain, domain) for domain in sorted({case.domain for case in cases})}
    for domain in sorted(groups, key=lambda d: (groups[d] == d, groups[d], d)):
        seen = [case for case in cases if domain not in (case.domain, case.other)]
        judged = judge(names, fit(names, seen), [case for case in cases if case.domain == domain])
        everything += judged
        by_group[groups[domain]] += judged
        print(row(domain, judged))
    for group in ("laser", "hand-held"):
        print(row(f"*all {group} folds*", by_group[group]))
    print(row("*all folds*", everything))
    for kind in ("laser", "hand-held"):
        seen = [case for case in cases if kind not in (REAL.get(case.domain), REAL.get(case.other))]
        print(
            row(
                f"*all {kind} maps at once*",
                judge(names, fit(names, seen), [c for c in cases if REAL.get(c.domain) == kind]),
            )
        )
    seen = [case for case in cases if case.domain not in REAL]
    print(
        row(
            "*all real maps at once*",
            judge(names, fit(names, seen), [case for case in cases if case.domain in REAL]),
        )
    )


def header(names: Names, model: Model) -> str:
    def weights(array: str, of: str, table) -> list[str]:
        rows = [f'    VerdictWeight{{"{name}", {weight:.3f}}},' for name, weight in table]
        return [
            f"/// In the order of {of}().",
            "// clang-format off",
            f"inline constexpr std::array {array}{{",
            *rows,
            "};",
            "// clang-format on",
            "",
        ]

    lines = [
        "// SPDX-License-Identifier: Apache-2.0",
        "// Made by calibration/fit.py; not to be changed by hand.",
        "#pragma once",
        "",
        "#include <array>",
        "",
        "namespace gridmerge::internal {",
        "",
        "/// A term of verdict_terms() or rank_terms(), and what it weighs.",
        "struct VerdictWeight {",
        "  const char* term;",
        "  double weight;",
        "};",
        "",
        f"inline constexpr double kVerdictBias = {model.bias:.3f};",
        "",
        *weights("kVerdictWeights", "verdict_terms", zip(names.terms, model.terms, strict=True)),
        *weights("kRankWeights", "rank_terms", zip(names.ranks, model.ranks, strict=True)),
        "}  // namespace gridmerge::internal",
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--folds", action="store_true")
    parser.add_argument("--pack", type=pathlib.Path, metavar="FOLDER")
    arguments = parser.parse_args()
    if arguments.pack:
        return pack(arguments.pack)
    names, cases = read_cases(CASES)
    if arguments.folds:
        return folds(names, cases)
    sys.stdout.write(header(names, fit(names, cases)))


if __name__ == "__main__":
    main()
