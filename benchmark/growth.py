#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fits the model of docs/scale.md to merges of a campus, and draws both.

usage: benchmark/growth.py ROWS.md [--plot FILE.png]

ROWS.md has the table that benchmark/fleet.py prints; merges of all pairs are drawn, and not fitted. The model:

    core seconds = comparison * maps * (maps - 1) / 2 + match * pairs that are looked at

Both factors are those with the least sum of squares of relative errors, and none is negative. Prints them, and how far
each row is off. A row that was left out while the rest was fitted says more: that is in the last column.
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


def fit(rows: list[Row]) -> Model:
    """By the normal equations of what each row's seconds are divided by."""
    a = [row.pairs / row.seconds for row in rows]
    b = [row.looked_at / row.seconds for row in rows]
    aa, ab, bb = (sum(x * y for x, y in zip(u, v, strict=True)) for u, v in ((a, a), (a, b), (b, b)))
    determinant = aa * bb - ab * ab
    if len(rows) > 1 and determinant > 1e-12 * aa * bb:
        comparison = (sum(a) * bb - sum(b) * ab) / determinant
        match = (sum(b) * aa - sum(a) * ab) / determinant
        if comparison >= 0.0 and match >= 0.0:
            return Model(comparison, match)
    # One of them is at its bound: the better of the two.
    alone = (Model(sum(a) / aa, 0.0), Model(0.0, sum(b) / bb))
    return min(alone, key=lambda model: sum(model.off(row) ** 2 for row in rows))


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
    arguments = parser.parse_args()

    rows = read_rows(arguments.rows)
    likely = [row for row in rows if not row.is_of_all_pairs]
    if not likely:
        parser.error(f"{arguments.rows} has no row of likely pairs")
    model = fit(likely)
    print(f"a comparison {1000 * model.comparison:.3f} ms, a match {1000 * model.match:.1f} ms\n")
    print(
        "| maps | core time [s] | model [s] | off | off, if fitted without it |\n| --- | --- | --- | --- | --- |"
    )
    for row in likely:
        others = [one for one in likely if one is not row]
        without = f"{fit(others).off(row):+.0%}" if others else ""
        print(f"| {row.maps} | {row.seconds:.1f} | {model.of(row):.1f} | {model.off(row):+.0%} | {without} |")
    if arguments.plot:
        draw(rows, model, arguments.plot)


if __name__ == "__main__":
    main()
