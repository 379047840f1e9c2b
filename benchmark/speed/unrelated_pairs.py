#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints a table of pairs of maps of different buildings, for `gridmerge evaluate --negatives`.

Of two folders, halmstad/ and radish/: a map's building is what its name, or its folder's, begins with.
"""

import argparse
import pathlib
import random


def building(data: pathlib.Path, path: pathlib.Path) -> str:
    relative = path.relative_to(data)
    if relative.parts[0] == "halmstad":
        return path.stem.split("_")[0]
    return path.parent.name.rsplit("_", 1)[0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=pathlib.Path, help="folder with halmstad/ and radish/")
    parser.add_argument("--count", type=int, default=1600)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    data = arguments.data.resolve()
    maps = sorted(data.glob("**/*.yaml"))
    dice = random.Random(arguments.seed)
    pairs: set[tuple[pathlib.Path, pathlib.Path]] = set()
    while len(pairs) < arguments.count:
        fixed, moving = dice.sample(maps, 2)
        if building(data, fixed) != building(data, moving):
            pairs.add((fixed, moving))
    print("fixed\tmoving")
    for fixed, moving in sorted(pairs):
        print(fixed, moving, sep="\t")


if __name__ == "__main__":
    main()
