# SPDX-License-Identifier: Apache-2.0
"""Poses (x, y, theta) in metres and radians, for the scripts beside this file."""

import math

Pose = tuple[float, float, float]


def read_pose(transform: dict) -> Pose:
    """As gridmerge's JSON has it."""
    return transform["x"], transform["y"], transform["theta"]


def compose(a: Pose, b: Pose) -> Pose:
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2])


def inverse(a: Pose) -> Pose:
    c, s = math.cos(a[2]), math.sin(a[2])
    return (-(c * a[0] + s * a[1]), -(-s * a[0] + c * a[1]), -a[2])
