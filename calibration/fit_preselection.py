#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the model that says of two signatures how likely match() joins their maps, and prints it as the code has it.

usage: calibration/fit_preselection.py GRIDMERGE SIGNATURES FOLDER [FOLDER...] [--test FOLDER]

FOLDERs are made by `benchmark/fleet.py --campus fitted --make-only`; SIGNATURES is the program `gridmerge_signatures`.
A pair counts as joined if match() finds its true pose with a probability of at least 0.9. Pairs of one building that it
does not find are left out. Logistic regression with a weak ridge; no weight has a sign that it should not have.
With --test prints, for maps that nothing was fitted to, how many unrelated pairs reach what joined pairs reach, and a
table of calibration.
"""

import argparse
import csv
import json
import pathlib
import re
import subprocess

import numpy as np

TERMS = (
    "better than chance",
    "met",
    "open",
    "seen",
    "votes",
    "rival's votes",
    "likeness",
    "walls",
    "seen of walls",
)
SIGNS = (1, 1, -1, 0, 1, -1, 1, 0, 0)  # which a weight may have; 0 = both
JOINED = 0.9


def read(gridmerge: str, signatures: str, folder: pathlib.Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Terms, and whether each pair is joined and whether it is unrelated."""
    maps = sorted(folder.glob("map_*.yaml"))
    table = folder / "signatures.tsv"
    if not table.exists():
        table.write_text(
            subprocess.run([signatures, *map(str, maps)], capture_output=True, text=True, check=True).stdout
        )
    judged = folder / "evaluated.json"
    if not judged.exists():
        subprocess.run(
            [gridmerge, "evaluate", str(folder / "pairs.tsv"), "--json", str(judged)],
            check=True,
            stdout=subprocess.DEVNULL,
        )
    found = {
        frozenset((pathlib.Path(case["fixed"]).name, pathlib.Path(case["moving"]).name))
        for case in json.loads(judged.read_text())["cases"]
        if case["correct"] and case["probability"] >= JOINED
    }
    with (folder / "sets.tsv").open(newline="") as file:
        home = {row["map"]: row["set"] for row in csv.DictReader(file, delimiter="\t")}
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file, delimiter="\t"))
    names = [(pathlib.Path(row["fixed"]).name, pathlib.Path(row["moving"]).name) for row in rows]
    value = {
        key: np.array([float(row[key]) for row in rows])
        for key in ("seen", "met", "open", "chance", "votes", "next_votes", "likeness", "walls_a", "walls_b")
    }
    walls = np.minimum(value["walls_a"], value["walls_b"])
    terms = np.stack(
        [
            (value["met"] - value["chance"]) / np.sqrt(value["seen"] + 10),
            value["met"] / (value["seen"] + 5),
            value["open"] / (value["seen"] + 5),
            np.log(value["seen"] + 5),
            np.sqrt(value["votes"]),
            np.sqrt(value["next_votes"]),
            value["likeness"],
            np.log(walls + 5),
            value["seen"] / (walls + 5),
        ],
        1,
    )
    joined = np.array([frozenset(pair) in found for pair in names])
    unrelated = np.array([home[a] != home[b] for a, b in names])
    return terms, joined, unrelated


def fit(terms: np.ndarray, joined: np.ndarray, ridge: float = 1.0) -> np.ndarray:
    """Weights and the bias. Terms whose weight has the wrong sign are left out, the worst first."""
    mean, spread = terms.mean(0), terms.std(0) + 1e-9
    used = list(range(terms.shape[1]))
    while True:
        z = np.c_[(terms[:, used] - mean[used]) / spread[used], np.ones(len(terms))]
        penalty = ridge * np.eye(z.shape[1])
        penalty[-1, -1] = 0
        weights = np.zeros(z.shape[1])
        weights[-1] = -4.0
        for _ in range(100):
            p = 1 / (1 + np.exp(-z @ weights))
            step = np.linalg.solve(
                (z * (p * (1 - p))[:, None]).T @ z + penalty, z.T @ (p - joined) + penalty @ weights
            )
            weights -= step * min(1.0, 3.0 / max(np.abs(step).max(), 1e-12))
        wrong = [
            (abs(weight), term)
            for weight, term in zip(weights[:-1], used, strict=True)
            if SIGNS[term] * weight < 0
        ]
        if not wrong:
            break
        used.remove(max(wrong)[1])
    result = np.zeros(terms.shape[1] + 1)
    for weight, term in zip(weights[:-1], used, strict=True):
        result[term] = weight / spread[term]
    result[-1] = weights[-1] - sum(result[term] * mean[term] for term in used)
    return result


def after_a_look(log_odds: np.ndarray, probability: np.ndarray, joined: np.ndarray) -> np.ndarray:
    """Bias, and weights of the log-odds and of the first look's."""
    p = np.clip(probability, 1e-4, 0.999)
    z = np.stack([np.ones(len(p)), log_odds, np.log(p / (1 - p))], 1)
    weights = np.array([-1.0, 0.5, 0.5])
    for _ in range(100):
        q = 1 / (1 + np.exp(-z @ weights))
        step = np.linalg.solve(
            (z * (q * (1 - q))[:, None]).T @ z + 0.1 * np.eye(3), z.T @ (q - joined) + 0.1 * weights
        )
        weights -= step * min(1.0, 3.0 / max(np.abs(step).max(), 1e-12))
    return weights


def shift_of(log_odds: np.ndarray, fitted_share: float) -> float:
    """As shift_to_this_set() of the code."""
    share, shift = fitted_share, 0.0
    for _ in range(100):
        shift = np.log(share / (1 - share)) - np.log(fitted_share / (1 - fitted_share))
        share = min(max(float(np.mean(1 / (1 + np.exp(-log_odds - shift)))), 0.1 / len(log_odds)), 0.9)
    return shift


def read_model(source: pathlib.Path) -> tuple[np.ndarray, float]:
    """Weights with the bias, and the share of joined pairs, of src/preselect/chance.cpp."""
    text = source.read_text()
    weights = re.search(r"kWeights\{([^}]*)\}", text)
    bias, share = (re.search(rf"{name} = ([-0-9.e]+);", text) for name in ("kBias", "kFittedShare"))
    if not (weights and bias and share):
        raise SystemExit(f"{source}: has no model")
    return np.array([*map(float, weights[1].split(",")), float(bias[1])]), float(share[1])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("gridmerge")
    parser.add_argument("signatures")
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    parser.add_argument("--test", type=pathlib.Path, action="append", default=[])
    parser.add_argument("--code", type=pathlib.Path, help="fit nothing: judge the model that this source has")
    arguments = parser.parse_args()
    parts = [read(arguments.gridmerge, arguments.signatures, folder) for folder in arguments.folders]
    terms, joined, unrelated = (np.concatenate([part[i] for part in parts]) for i in range(3))
    use = joined | unrelated
    if arguments.code:
        weights, share = read_model(arguments.code)
    else:
        weights, share = fit(terms[use], joined[use].astype(float)), float(np.mean(joined[use]))
    print(
        "constexpr std::array<double, 9> kWeights{"
        + ", ".join(f"{weight:.4g}" for weight in weights[:-1])
        + "};"
    )
    print(f"constexpr double kBias = {weights[-1]:.4g};\nconstexpr double kFittedShare = {share:.4g};")
    for name, part in [
        ("fitted", (terms, joined, unrelated)),
        *(
            (str(folder), read(arguments.gridmerge, arguments.signatures, folder))
            for folder in arguments.test
        ),
    ]:
        log_odds = part[0] @ weights[:-1] + weights[-1]
        print(f"{name}: {part[1].sum()} joined, {part[2].sum()} unrelated")
        for recall in (0.9, 0.95, 0.98, 0.99, 1.0):
            least = np.quantile(log_odds[part[1]], 1 - recall, method="lower")
            print(
                f"  {100 * recall:.0f} % of the joined reach what "
                f"{100 * np.mean(log_odds[part[2]] >= least):.2f} % of the unrelated do"
            )
        keep = part[1] | part[2]
        p = 1 / (1 + np.exp(-log_odds[keep] - shift_of(log_odds[keep], share)))
        print(f"  expected {p.sum():.1f} joined, true {part[1].sum()}")
        for low, high in (
            (0, 1e-4),
            (1e-4, 1e-3),
            (1e-3, 0.01),
            (0.01, 0.1),
            (0.1, 0.5),
            (0.5, 0.9),
            (0.9, 1.01),
        ):
            inside = (p >= low) & (p < high)
            print(
                f"  {low:g} to {min(high, 1):g}: {inside.sum()} pairs, "
                f"expected {p[inside].sum():.2f}, true {part[1][keep][inside].sum()}"
            )


if __name__ == "__main__":
    main()
