# SPDX-License-Identifier: Apache-2.0
"""Invents a building, has robots map it, and holds what gridmerge makes of their maps against the truth."""

import tempfile
from pathlib import Path

import gridmerge


def main() -> None:
    simulation = gridmerge.simulate("office", size=(30.0, 20.0), robots=3, overlap=0.5, seed=7)
    for i, robot in enumerate(simulation.maps):
        print(f"robot {i}: {robot.grid!r}, {len(robot.path)} scans, bent by {robot.bend:.2f} m")

    for pair in simulation.pairs:
        result = gridmerge.match(simulation.maps[pair.fixed].grid, simulation.maps[pair.moving].grid)
        error = pair.transform.inverse() @ result.transform
        print(
            f"{pair.fixed} and {pair.moving}: overlap {pair.overlap:.2f}, {result.verdict} ({result.probability:.3f}), "
            f"the map's origin is off by {(error.x**2 + error.y**2) ** 0.5:.2f} m"
        )

    with tempfile.TemporaryDirectory() as folder:
        simulation.save(folder)
        tables = [Path(folder) / name for name in ("pairs.tsv", "negatives.tsv", "sets.tsv")]
        evaluation = gridmerge.evaluate(*tables)
    print(evaluation.summary())


if __name__ == "__main__":
    main()
