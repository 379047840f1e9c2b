# SPDX-License-Identifier: Apache-2.0
"""What tests beside rclpy share: three robots that explored a building, and nodes that talk over loopback alone."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import count
from typing import TYPE_CHECKING

import gridmerge
import pytest

if TYPE_CHECKING:
    from ros_peer import Peer

# Before anything of ROS starts.
os.environ["ROS_LOCALHOST_ONLY"] = "1"
for _variable in ("ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_STATIC_PEERS", "RMW_IMPLEMENTATION", "ROS_NAMESPACE"):
    os.environ.pop(_variable, None)

_domains = count(1 + os.getpid() % 70)


@pytest.fixture(scope="session")
def explored() -> gridmerge.Simulation:
    """Three robots of one building, at four moments each."""
    return gridmerge.simulate(size=(24.0, 16.0), robots=3, overlap=0.7, drift=0.0, steps=4, others=0, seed=5)


@pytest.fixture
def peer() -> Iterator[Peer]:
    """A node of ROS 2 in a domain of its own, with the node under test beside it once it is started."""
    pytest.importorskip("rclpy", reason="tests beside ROS 2: './dev test --ros' runs them")
    from ros_peer import Peer

    one = Peer(next(_domains))
    yield one
    one.close()
