#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the verdict's model: a logistic regression from the features of a match to the probability that its best hypothesis
is the true pose. Prints the model as a C++ header (src/match/verdict_model.hpp), or how well it does on other cases.

usage: calibration/fit.py FEATURES.tsv...                 the header
       calibration/fit.py FEATURES.tsv... --check CHECK.tsv   counts, calibration error and reliability on CHECK

FEATURES are tables of `gridmerge evaluate --features`. Needs nothing but Python; the same tables give the same digits.
"""

import argparse
import csv
import math
import pathlib

RIDGE = 1.0  # on weights of features that are scaled to unit variance

# What the model sees of the features: (name of the term, transform of a row, the same in C++). Logarithms, because shares
# and counts act by their ratios; bounds, because beyond them a feature says how clean or large maps are, not whether they
# belong together.
TERMS = [
    ("lead", lambda f: min(f["lead"], 100.0) / 10.0, "std::min(f.lead, 100.0) / 10.0"),
    ("wall lines", lambda f: math.log(clamp(f["wall_lines"], 1.0, 8.0)), "std::log(std::clamp(f.wall_lines, 1.0, 8.0))"),
    ("walls met locally", lambda f: -math.log(max(1.0 - f["walls_met_locally"], 0.05)),
     "-std::log(std::max(1.0 - f.walls_met_locally, 0.05))"),
    ("walls met rigidly", lambda f: -math.log(max(1.0 - f["walls_met"], 0.05)), "-std::log(std::max(1.0 - f.walls_met, 0.05))"),
]
FEATURES = ["lead", "wall_lines", "walls_met_locally", "walls_met"]


def clamp(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)


def read_cases(paths: list[pathlib.Path]) -> list[tuple[list[float], bool, dict[str, str]]]:
    cases = []
    for path in paths:
        with path.open(newline="") as file:
            for row in csv.DictReader(file, delimiter="\t"):
                features = {name: float(row[name]) for name in FEATURES}
                cases.append(([transform(features) for _, transform, _ in TERMS], row["truth"] == "right", row))
    return cases


def solve(matrix: list[list[float]], right: list[float]) -> list[float]:
    """By Gauss' elimination; the matrix is positive definite and small."""
    size = len(right)
    rows = [row[:] + [value] for row, value in zip(matrix, right)]
    for i in range(size):
        pivot = max(range(i, size), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(i + 1, size):
            factor = rows[r][i] / rows[i][i]
            for c in range(i, size + 1):
                rows[r][c] -= factor * rows[i][c]
    result = [0.0] * size
    for i in reversed(range(size)):
        result[i] = (rows[i][size] - sum(rows[i][c] * result[c] for c in range(i + 1, size))) / rows[i][i]
    return result


def sigmoid(logit: float) -> float:
    return 1.0 / (1.0 + math.exp(-max(-700.0, min(700.0, logit))))


def fit(cases) -> tuple[float, list[float]]:
    """Bias and weights: penalised maximum likelihood by Newton's method on standardised terms."""
    count, size = len(cases), len(TERMS)
    mean = [sum(case[0][i] for case in cases) / count for i in range(size)]
    deviation = [math.sqrt(sum((case[0][i] - mean[i]) ** 2 for case in cases) / count) or 1.0 for i in range(size)]
    inputs = [[1.0] + [(case[0][i] - mean[i]) / deviation[i] for i in range(size)] for case in cases]
    weights = [0.0] * (size + 1)
    for _ in range(50):
        gradient = [-RIDGE * w for w in weights]
        gradient[0] = 0.0
        hessian = [[RIDGE if r == c and r > 0 else 0.0 for c in range(size + 1)] for r in range(size + 1)]
        for x, (_, right, _) in zip(inputs, cases):
            p = sigmoid(sum(w * v for w, v in zip(weights, x)))
            for r in range(size + 1):
                gradient[r] += ((1.0 if right else 0.0) - p) * x[r]
                for c in range(size + 1):
                    hessian[r][c] += p * (1.0 - p) * x[r] * x[c]
        step = solve(hessian, gradient)
        weights = [w + s for w, s in zip(weights, step)]
        if max(abs(s) for s in step) < 1e-10:
            break
    scaled = [w / d for w, d in zip(weights[1:], deviation)]
    return weights[0] - sum(w * m for w, m in zip(scaled, mean)), scaled


def probability(model: tuple[float, list[float]], terms: list[float], lead: float, wall_lines: float) -> float:
    """As probability_of() in verdict.cpp, which says why."""
    fits = sigmoid(model[0] + sum(w * t for w, t in zip(model[1], terms)))
    return fits * sigmoid(lead) * sigmoid(3.0 * (wall_lines - 3.5))


def header(model: tuple[float, list[float]]) -> str:
    bias, weights = model
    lines = ["// SPDX-License-Identifier: Apache-2.0",
             "// Made by calibration/fit.py from calibration/fit.tsv; not to be changed by hand.",
             "#pragma once", "", "#include <algorithm>", "#include <cmath>", "",
             '#include "gridmerge/match/verdict.hpp"', "", "namespace gridmerge {", "",
             "/// The logit of the probability that a best hypothesis with these features is the true pose.",
             "inline double verdict_logit(const VerdictFeatures& f) {", f"  double logit = {bias:.4f};"]
    lines += [f"  logit += {weight:.4f} * {code};" for weight, (_, _, code) in zip(weights, TERMS)]
    return "\n".join(lines + ["  return logit;", "}", "", "}  // namespace gridmerge"]) + "\n"


def check(model: tuple[float, list[float]], cases) -> str:
    judged = [(probability(model, terms, float(row["lead"]), float(row["wall_lines"])), right, row["truth"]) for terms, right, row in cases]
    text = f"{'from':>8} {'right':>7} {'wrong':>7} {'negative':>9}   accepted\n"
    for threshold in (0.5, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999):
        accepted = [truth for p, _, truth in judged if p >= threshold]
        text += f"{threshold:>8} {accepted.count('right'):>7} {accepted.count('wrong'):>7} {accepted.count('negative'):>9}\n"
    totals = [truth for _, _, truth in judged]
    text += f"{'of':>8} {totals.count('right'):>7} {totals.count('wrong'):>7} {totals.count('negative'):>9}\n\n"
    text += f"{'probability':>14} {'cases':>6} {'mean':>7} {'right':>7}\n"
    error = 0.0
    for low in range(10):
        inside = [(p, right) for p, right, _ in judged if low / 10 <= p < (low + 1) / 10 or (low == 9 and p == 1.0)]
        if not inside:
            continue
        mean = sum(p for p, _ in inside) / len(inside)
        share = sum(right for _, right in inside) / len(inside)
        error += abs(mean - share) * len(inside) / len(judged)
        text += f"{low / 10:>7.1f} - {(low + 1) / 10:.1f} {len(inside):>6} {mean:>7.3f} {share:>7.3f}\n"
    return text + f"expected calibration error {error:.4f} over {len(judged)} cases\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("features", type=pathlib.Path, nargs="+")
    parser.add_argument("--check", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    model = fit(read_cases(arguments.features))
    if arguments.check:
        print(check(model, read_cases(arguments.check)), end="")
    else:
        print(header(model), end="")


if __name__ == "__main__":
    main()
