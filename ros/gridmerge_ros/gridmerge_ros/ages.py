# SPDX-License-Identifier: Apache-2.0
"""Since when nodes of one team have heard each robot: what they tell each other in /diagnostics.

The oldest account of all nodes counts, so that they agree on whose frame is the world's. `gridmerge node` tells and
hears the same.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

TOPIC, FRAME, PUBLISHER, HEARD_FIRST = "topic", "frame", "publisher", "heard first"
"""Keys of a robot's diagnosis."""

_GUID_BYTES = 16  # of the number that DDS gives a publisher; what follows in ROS's is filled up
_TIME = re.compile(r"([0-9]{1,10})\.([0-9]{9})\Z", re.ASCII)


@dataclass(frozen=True, slots=True)
class RobotAge:
    """Since when a node has heard a robot's map frame.

    The publisher's number and the frame's name tell whether it is the frame that is meant: a robot that starts anew
    has others.
    """

    topic: str
    publisher: str
    frame: str
    heard_first: float
    """Seconds since 1970."""


def publisher_digits(number: tuple[int, ...]) -> str:
    """The number of a publisher as diagnoses have it."""
    return bytes(number[:_GUID_BYTES]).hex()


def format_time(seconds: float) -> str:
    """With nine digits behind the point: "1764224401.250000000"."""
    return f"{seconds:.9f}"


def read_time(text: str) -> float | None:
    """The same back; None for what format_time() does not write."""
    match = _TIME.match(text)
    return None if match is None else int(match[1]) + int(match[2]) * 1e-9


def read_ages(message: Any) -> list[RobotAge]:
    """Out of a `diagnostic_msgs/DiagnosticArray` of anybody's."""
    ages = []
    for status in message.status:
        values = {one.key: one.value for one in status.values}
        heard_first = read_time(values.get(HEARD_FIRST, ""))
        if heard_first is not None:
            ages.append(
                RobotAge(values.get(TOPIC, ""), values.get(PUBLISHER, ""), values.get(FRAME, ""), heard_first)
            )
    return ages
