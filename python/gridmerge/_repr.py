# SPDX-License-Identifier: Apache-2.0
"""Short texts for prompts, one line each."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence

from ._transform import Transform


def short_pose(transform: Transform) -> str:
    """x, y [m] and theta [rad] to the millimetre and a tenth of a milliradian."""
    x, y, theta = transform
    # Adding zero turns -0.0, which rounding leaves, into 0.0.
    return f"({round(x, 3) + 0.0:.3f}, {round(y, 3) + 0.0:.3f}, {round(theta, 4) + 0.0:.4f})"


def short_scale(scale: float) -> str:
    """``, scale=0.826`` for a map of another scale."""
    return "" if scale == 1.0 else f", scale={scale:.4f}"


def probability(value: float | None) -> str:
    """``probability=0.998``; rounded down, so that what falls short of a bound does not look as if it reached it."""
    if value is None:
        return "probability=None"
    if 0.999 < value < 1.0:
        return "probability>0.999"
    if 0.0 < value < 0.001:
        return "probability<0.001"
    return f"probability={math.floor(1e3 * value + 1e-6) / 1e3:.3f}"


def count(number: int, what: str, several: str | None = None) -> str:
    """1 map, 2 maps; 1 match, 2 matches."""
    return f"{number} {what}" if number == 1 else f"{number} {several or what + 's'}"


def listed(names: Sequence[str], most: int = 3) -> str:
    """Names, of paths the last parts where these tell them apart, and how many more there are."""
    last = [os.path.basename(name) for name in names]
    if all(last) and len(set(last)) == len(last):
        names = last
    shown = ", ".join(map(shortened, names[:most]))
    more = len(names) - most
    return f"{shown} and {more} more" if more > 0 else shown


def shortened(name: str, most: int = 40) -> str:
    """A name as Python spells it, or the end of it, which tells most of a path."""
    return repr(name if len(name) <= most else f"…{name[1 - most :]}")
