# SPDX-License-Identifier: Apache-2.0
"""Holds two transforms.json against each other: all that they say is the same, and numbers but for rounding.

A wheel brings a Ceres of its own, whose last bits may differ from those of Debian's.
"""

import json
import math
import sys
from pathlib import Path

TOLERANCE = 1e-6  # metres, radians, and shares; probabilities are given with six digits


def differences(expected: object, found: object, where: str) -> list[str]:
    if isinstance(expected, dict) and isinstance(found, dict) and expected.keys() == found.keys():
        return [text for key in expected for text in differences(expected[key], found[key], f"{where}.{key}")]
    if isinstance(expected, list) and isinstance(found, list) and len(expected) == len(found):
        pairs = enumerate(zip(expected, found, strict=True))
        return [text for at, (one, other) in pairs for text in differences(one, other, f"{where}[{at}]")]
    if isinstance(expected, int | float) and isinstance(found, int | float):
        same = math.isclose(expected, found, rel_tol=TOLERANCE, abs_tol=TOLERANCE)
    else:
        same = expected == found
    if same:
        return []
    return [f"{where}: {expected!r} here, {found!r} there"]


def main() -> int:
    first, second = (Path(name).read_text(encoding="utf-8") for name in sys.argv[1:3])
    found = differences(json.loads(first), json.loads(second), "")
    for text in found:
        print(text)
    if not found:
        print("The same merge" + (", to the last digit" if first == second else f", to within {TOLERANCE}"))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
