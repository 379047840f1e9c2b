#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the verdict on maps of unknown scale, and writes it as src/match/scaled_verdict_model.hpp has it.

usage: gridmerge_plan_cases 0 35 > plan_cases.tsv; calibration/fit_plans.py plan_cases.tsv

The model has the form of calibration/fit.py's: which of a case's hypotheses is the best one, and whether that is
believed. Names and values of its terms come from the engine, as columns "rank: ..." and "term: ...". The term
"stands out" depends on the ranking: when the ranking's weights change, build the engine with them, make the cases
anew, and fit again.
Penalised maximum likelihood (Newton steps), true and unrelated cases as they come. A summary goes to standard error.
Needs numpy; the same cases give the same digits.
"""

import collections
import csv
import pathlib
import sys

import numpy as np

RANK_RIDGE = 0.1  # on the weights of the ranking, whose terms are logarithms
RIDGE = 0.1  # on the belief's weights, of terms that are scaled to unit variance
ACCEPT = 0.95
# A hypothesis is right within the first, and wrong beyond the second: of the scale, and in metres. A bent map has no
# exact pose, so what lies between is left out.
SCALE_TOLERANCES = 0.03, 0.06
TOLERANCES = 1.5, 3.0
# Corridors slide, and of these the cases hold none. What speaks for a pose never counts against it.
LEAST_WEIGHT = {"held": 1.0}
RANK, TERM = "rank: ", "term: "
STANDS_OUT = "stands out"

Case = collections.namedtuple("Case", "name ranks terms right near")


def read_cases(path: pathlib.Path) -> tuple[list[str], list[str], list[Case]]:
    """The names of rank terms and terms, and the cases with a row for each hypothesis, the engine's best one first."""
    with path.open(newline="", encoding="utf-8") as file:
        reader = csv.DictReader(file, delimiter="\t")
        columns = reader.fieldnames or []
        rows = list(reader)
    ranks = [name for name in columns if name.startswith(RANK)]
    terms = [name for name in columns if name.startswith(TERM)]
    by_case: dict[str, list[dict[str, str]]] = {}
    for row in rows:
        by_case.setdefault(row["case"], []).append(row)
    cases = [
        Case(
            name,
            np.array([[float(row[column]) for column in ranks] for row in of_case]),
            np.array([[float(row[column]) for column in terms] for row in of_case]),
            *(
                np.array(
                    [
                        float(row["scale_error"]) <= of_scale and float(row["error"]) <= metres
                        for row in of_case
                    ]
                )
                for of_scale, metres in zip(SCALE_TOLERANCES, TOLERANCES, strict=True)
            ),
        )
        for name, of_case in by_case.items()
    ]
    return [name.removeprefix(RANK) for name in ranks], [name.removeprefix(TERM) for name in terms], cases


def fit_ranking(cases: list[Case]) -> np.ndarray:
    """Conditional logit: the right hypothesis against the case's others."""
    used = [case for case in cases if case.right.any()]
    weights = np.zeros(used[0].ranks.shape[1])
    for _ in range(50):
        gradient = -2.0 * RANK_RIDGE * weights
        curvature = 2.0 * RANK_RIDGE * np.eye(len(weights))
        for case in used:
            share = softmax(case.ranks @ weights)
            mean = share @ case.ranks
            gradient += case.ranks[np.argmax(case.right)] - mean
            curvature += (case.ranks - mean).T @ np.diag(share) @ (case.ranks - mean)
        step = np.linalg.solve(curvature, gradient)
        weights += step / max(1.0, float(np.linalg.norm(step)))
    return weights


def softmax(ranks: np.ndarray) -> np.ndarray:
    odds = np.exp(ranks - ranks.max())
    return odds / odds.sum()


def logistic(log_odds: np.ndarray) -> np.ndarray:
    return 1.0 / (1.0 + np.exp(-log_odds))


def fit_belief(terms: np.ndarray, right: np.ndarray, offset: np.ndarray) -> tuple[float, np.ndarray]:
    """Logistic regression: the bias, and the weights of the terms as they are, beside log-odds that are given."""
    mean, spread = terms.mean(axis=0), terms.std(axis=0) + 1e-9
    scaled = np.column_stack([np.ones(len(terms)), (terms - mean) / spread])
    ridge = 2.0 * RIDGE * np.diag([0.0] + [1.0] * terms.shape[1])
    weights = np.zeros(scaled.shape[1])
    for _ in range(100):
        share = logistic(scaled @ weights + offset)
        gradient = scaled.T @ (right - share) - ridge @ weights
        curvature = (
            scaled.T @ (scaled * (share * (1.0 - share))[:, None]) + ridge + 1e-9 * np.eye(len(weights))
        )
        step = np.linalg.solve(curvature, gradient)
        weights += step / max(1.0, float(np.linalg.norm(step)))
    of_terms = weights[1:] / spread
    return float(weights[0] - of_terms @ mean), of_terms


def fit_bounded_belief(terms: np.ndarray, right: np.ndarray, least: np.ndarray) -> tuple[float, np.ndarray]:
    """The same with weights of `least` or more."""
    used = np.ones(terms.shape[1], dtype=bool)
    while True:
        bias, of_used = fit_belief(terms[:, used], right, terms[:, ~used] @ least[~used])
        weights = least.copy()
        weights[used] = of_used
        below = weights < least
        if not below.any():
            return bias, weights
        used &= ~below


def header(ranks: dict[str, float], bias: float, terms: dict[str, float]) -> str:
    def rows(weights: dict[str, float]) -> str:
        return "".join(f'    VerdictWeight{{"{name}", {weight:.2f}}},\n' for name, weight in weights.items())

    return f"""// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit_plans.py; not to be changed by hand.
#pragma once

#include <array>

#include "match/verdict_model.hpp"

namespace gridmerge::internal {{

inline constexpr double kScaledBias = {bias:.2f};

/// In the order of the terms of scaled_model().
// clang-format off
inline constexpr std::array kScaledWeights{{
{rows(terms)}}};

/// In the order of the rank terms of scaled_model().
inline constexpr std::array kScaledRankWeights{{
{rows(ranks)}}};
// clang-format on

}}  // namespace gridmerge::internal
"""


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    rank_names, term_names, cases = read_cases(pathlib.Path(sys.argv[1]))
    ranking = fit_ranking(cases)
    cases = [case for case in cases if case.right[0] or not case.near[0]]
    terms = np.array([case.terms[0] for case in cases])
    right = np.array([case.right[0] for case in cases])
    least = np.array([LEAST_WEIGHT.get(name, 0.0) for name in term_names])
    bias, weights = fit_bounded_belief(terms, right, least)
    stands_out = terms[:, term_names.index(STANDS_OUT)]
    probability = logistic(bias + terms @ weights) * logistic(stands_out)
    accepted = probability >= ACCEPT
    own = np.array([case.name.startswith("own") for case in cases])
    print(
        f"{own.sum()} maps on their plans: best right {right[own].sum()}, accepted {accepted[own & right].sum()}, "
        f"wrongly {accepted[own & ~right].sum()}; {(~own).sum()} unrelated: accepted {accepted[~own].sum()}, "
        f"most probable {probability[~own].max():.3f}",
        file=sys.stderr,
    )
    print(
        header(
            dict(zip(rank_names, ranking, strict=True)), bias, dict(zip(term_names, weights, strict=True))
        ),
        end="",
    )


if __name__ == "__main__":
    main()
