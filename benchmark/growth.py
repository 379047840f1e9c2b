#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the model of docs/scale.md to merges of a campus, and draws both.

usage: benchmark/growth.py ROWS.md [--plot FILE.png]

ROWS.md has the table that benchmark/fleet.py prints; merges of all pairs are drawn, and not fitted. The model:

    core seconds = comparison * maps * (maps - 1) / 2 + match * pairs that are looked at

A comparison is measured apart. A match, with all that comes with it, is what gives the least sum of squares of relative
errors. Prints it, and how far each row is off. A row that was left out while the rest was fitted says more: that is in
the last column.
"""

import argparse
import dataclasses
import pathlib
import re


@dataclasses.dataclass(frozen=True)
class Row:
    maps: int
    is_of_all_pairs: bool
    seconds: float  # of processor cores
    megabytes: float
    looked_at: int  # pairs

    @property
    def pairs(self) -> int:
        return self.maps * (self.maps - 1) // 2


@dataclasses.dataclass(frozen=True)
class Model:
    comparison: float  # core seconds
    match: float

    def of(self, row: Row) -> float:
        return self.comparison * row.pairs + self.match * row.looked_at

    def off(self, row: Row) -> float:
        """A share of what the row took."""
        return self.of(row) / row.seconds - 1.0


def read_rows(path: pathlib.Path) -> list[Row]:
    rows = []
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if len(cells) < 5 or not re.match(r"\d+( |$)", cells[0]):
            continue
        looked_at = int(cells[4].split()[0])
        is_of_all = "all pairs" in cells[0] or looked_at == int(cells[3])
        rows.append(Row(int(cells[0].split()[0]), is_of_all, float(cells[1]), float(cells[2]), looked_at))
    return rows


def fit(rows: list[Row], comparison: float) -> Model:
    """What a match takes. Three rows or so cannot tell both factors apart: both grow with pairs."""
    shares = [row.looked_at / row.seconds for row in rows]
    rest = [1.0 - comparison * row.pairs / row.seconds for row in rows]
    match = sum(x * y for x, y in zip(shares, rest, strict=True)) / sum(x * x for x in shares)
    return Model(comparison, max(match, 0.0))


def draw(rows: list[Row], model: Model, path: pathlib.Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    every = [row for row in rows if row.is_of_all_pairs]
    likely = [row for row in rows if not row.is_of_all_pairs]
    if every:
        axes.plot([r.maps for r in every], [r.seconds for r in every], "s--", color="0.5", label="all pairs")
    axes.plot([r.maps for r in likely], [r.seconds for r in likely], "o", color="C0", label="likely pairs")
    axes.plot([r.maps for r in likely], [model.of(r) for r in likely], "-", color="C1", label="model")
    axes.set(xscale="log", yscale="log", xlabel="maps", ylabel="core time [s]")
    axes.grid(which="both", alpha=0.25)
    axes.legend()
    figure.savefig(path, dpi=110, metadata={"Software": None})


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rows", type=pathlib.Path, metavar="ROWS.md")
    parser.add_argument("--plot", type=pathlib.Path, metavar="FILE.png")
    parser.add_argument(
        "--comparison", type=float, default=0.15, help="milliseconds, as gridmerge_signatures measures it"
    )
    arguments = parser.parse_args()
    comparison = arguments.comparison / 1000

    rows = read_rows(arguments.rows)
    likely = [row for row in rows if not row.is_of_all_pairs]
    if not likely:
        parser.error(f"{arguments.rows} has no row of likely pairs")
    model = fit(likely, comparison)
    print(f"a comparison {1000 * model.comparison:.3f} ms, a match {1000 * model.match:.1f} ms\n")
    print(
        "| maps | core time [s] | model [s] | off | off, if fitted without it |\n| --- | --- | --- | --- | --- |"
    )
    for row in likely:
        others = [one for one in likely if one is not row]
        without = f"{fit(others, comparison).off(row):+.0%}" if others else ""
        print(f"| {row.maps} | {row.seconds:.1f} | {model.of(row):.1f} | {model.off(row):+.0%} | {without} |")
    if arguments.plot:
        draw(rows, model, arguments.plot)


if __name__ == "__main__":
    main()
