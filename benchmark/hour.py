# SPDX-License-Identifier: Apache-2.0
"""Robots that map for an hour, and what it costs who hears them. benchmark/online.py and benchmark/live.py play it."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace

import gridmerge
import numpy as np

SECONDS = 3600
LAP = 600  # s: then a robot starts anew in another frame
STEPS = 40  # moments of its way, one each STEP
STEP = 10  # s: in between, and once it stands, its map is repeated
STIR = 0.001  # the share of cells that differ in every second map of a robot that stands


class Hour:
    """What each robot publishes in each second. Robots start anew one after the other, each once in a lap."""

    def __init__(self, robots: int) -> None:
        self.simulation = gridmerge.simulate(
            "office", size=(44.0, 28.0), robots=robots, overlap=0.6, drift=0.0, steps=STEPS, others=0, seed=9
        )
        self.robots = range(robots)

    def lap(self, robot: int, second: int) -> tuple[int, int]:
        """The number of the robot's lap, and the seconds since it began."""
        return divmod(second + LAP * robot // len(self.robots), LAP)

    def shift(self, robot: int, lap: int) -> gridmerge.Transform:
        """From the frame of the simulation to that of the lap."""
        dice = np.random.default_rng((robot, lap))
        return gridmerge.Transform(*dice.uniform(-20.0, 20.0, 2), dice.uniform(-3.0, 3.0))

    def grid(self, robot: int, second: int) -> gridmerge.OccupancyGrid:
        lap, into = self.lap(robot, second)
        one = self.simulation.maps[robot]
        grid = (*one.earlier, one.grid)[min(into // STEP, STEPS - 1)]
        cells = grid.cells
        if into >= STEP * STEPS and into % 2 == 0:
            cells = cells.copy()
            dice = np.random.default_rng((robot, second))
            cells.flat[dice.integers(cells.size, size=round(STIR * cells.size))] = 0
        return gridmerge.OccupancyGrid.from_cells(
            cells, grid.resolution, self.shift(robot, lap) @ grid.origin
        )

    def truth(
        self, laps: Sequence[int], second: int
    ) -> tuple[SimpleNamespace, list[gridmerge.OccupancyGrid]]:
        """The simulation's true transforms, and the robots' maps of this second, in the frames of these laps."""
        maps, grids = [], []
        for robot, (lap, one) in enumerate(zip(laps, self.simulation.maps, strict=True)):
            shift, grid = self.shift(robot, lap), self.grid(robot, second)
            maps.append(SimpleNamespace(transform=one.transform @ shift.inverse(), bend=one.bend))
            origin = shift @ self.shift(robot, self.lap(robot, second)[0]).inverse() @ grid.origin
            grids.append(gridmerge.OccupancyGrid.from_cells(grid.cells, grid.resolution, origin))
        return SimpleNamespace(maps=maps), grids


@dataclass
class Cost:
    """CPU and memory of a process, each second."""

    process: int
    resident: list[float] = field(default_factory=list)  # MB
    cpu: float = 0.0  # s

    def look(self) -> None:
        with open(f"/proc/{self.process}/statm") as file:
            self.resident.append(int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6)
        with open(f"/proc/{self.process}/stat") as file:
            words = file.read().rpartition(")")[2].split()
        self.cpu = (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def play(
    hour: Hour,
    speed: float,
    cost: Cost,
    send: Callable[[int, int], None],
    look: Callable[[int], tuple[int, int, int, int]],
) -> None:
    """Sends each robot's map of each second, `speed` seconds in one. A line for each lap: look() gives the maps that
    were heard and the answers so far, the robots that are placed, and those of them that lie wrongly. Robots are
    counted halfway between two starts."""
    done = threading.Event()

    def watch() -> None:
        while not done.wait(1.0):
            cost.look()

    watcher = threading.Thread(target=watch)
    cost.look()
    watcher.start()
    try:
        begin, cpu, heard, answers, placed, wrong, moments = time.monotonic(), cost.cpu, 0, 0, 0, 0, 0
        between = LAP // len(hour.robots)
        for second in range(SECONDS):
            for robot in hour.robots:
                time.sleep(max(0.0, begin + (second + robot / len(hour.robots)) / speed - time.monotonic()))
                send(robot, second)
            if second % between == between // 2:
                _, _, here, off = look(second)
                placed, wrong, moments = placed + here, wrong + off, moments + 1
            if (second + 1) % LAP == 0:
                cost.look()
                now_heard, now_answers, _, _ = look(second)
                part = cost.resident
                print(
                    f"minutes {(second + 1 - LAP) // 60:2d} to {(second + 1) // 60:2d}: "
                    f"{now_heard - heard:5d} maps heard, {now_answers - answers:4d} answers, "
                    f"{cost.cpu - cpu:5.1f} s of CPU, {min(part):4.0f} to {max(part):4.0f} MB, "
                    f"mean {sum(part) / len(part):4.0f}; "
                    f"placed {placed / moments:.1f} of {len(hour.robots)}, wrong {wrong}",
                    flush=True,
                )
                cpu, heard, answers, placed, wrong, moments = cost.cpu, now_heard, now_answers, 0, 0, 0
                cost.resident = []
        print(f"{SECONDS * len(hour.robots)} maps were sent, in {time.monotonic() - begin:.0f} s", flush=True)
    finally:
        done.set()
        watcher.join()
