#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws what the paper measures along a cut through the truth: psi, agr - dis, omega and Delta.

usage: experiments/paper/plot_landscape.py TABLE.tsv PICTURE.png

TABLE.tsv is what `gridmerge_paper fig 3` writes. Needs matplotlib.
"""

import csv
import pathlib
import sys


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot

    with pathlib.Path(sys.argv[1]).open(newline="") as file:
        rows = list(csv.reader(file, delimiter="\t"))
    names, columns = rows[0], list(zip(*[[float(value) for value in row] for row in rows[1:]], strict=True))
    figure, axes = pyplot.subplots(len(names) - 1, 1, sharex=True, figsize=(7, 8), constrained_layout=True)
    for axis, name, values in zip(axes, names[1:], columns[1:], strict=True):
        axis.plot(columns[0], values, color="#005a9c", linewidth=1)
        axis.axvline(0.0, color="#cc2020", linewidth=0.8)
        axis.set_ylabel(name, fontsize=8)
        axis.tick_params(labelsize=8)
    axes[-1].set_xlabel("shift from the truth along x [cells]")
    figure.savefig(sys.argv[2], dpi=100)
    return 0


if __name__ == "__main__":
    sys.exit(main())
