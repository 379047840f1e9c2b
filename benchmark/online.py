#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Simulated teams that are heard while they map: when robots are placed, whether rightly, and whether they stay.

usage: benchmark/online.py [--teams N] [--robots N] [--steps N] [--rate HZ] [--updates N]
       benchmark/online.py --hour [--robots N] [--speed N]

Runs in an environment that has the package gridmerge. Each robot's map is heard at N moments of its way, HZ times a
second. Beside the team stands merge() of the same maps at the same moment. A placement is wrong where the robots' true
transforms, by least squares over all that they drew, are farther off than the tolerance that `gridmerge simulate` gives
them. At last one team is heard for --updates more maps, as fast as it answers, with robots that change a little each
time: time and memory must not grow.

--hour plays what a team publishes within an hour, --speed times as fast: robots that explore, stand, repeat their maps,
and start anew in another frame every ten minutes. Time and memory must be those of the first ten minutes.
"""

from __future__ import annotations

import argparse
import os
import resource
import sys
import time
from dataclasses import dataclass

import gridmerge
import hour
import numpy as np

KINDS = ("office", "hall", "warehouse", "loop", "apartment", "outdoor")
SURE = 0.98


@dataclass
class Count:
    """What came of teams."""

    robots: int = 0
    placed: int = 0  # at the end
    wrong: int = 0  # at the end
    wrong_before: int = 0  # robots that were placed wrongly in some answer before the end
    jumps: int = 0
    sure_jumps: int = 0  # of robots that had been placed with SURE or more
    same: int = 0  # teams whose last answer is merge()'s, to the cell
    teams: int = 0


def true_transform(simulation: gridmerge.Simulation, fixed: int, moving: int) -> gridmerge.Transform:
    one, other = simulation.maps[fixed], simulation.maps[moving]
    return one.transform.inverse() @ other.transform


def tolerance_of(simulation: gridmerge.Simulation, fixed: int, moving: int) -> float:
    bends = simulation.maps[fixed].bend + simulation.maps[moving].bend
    return max(0.5, 0.3 + 2.0 * bends)


def displacement(grid: gridmerge.OccupancyGrid, a: gridmerge.Transform, b: gridmerge.Transform) -> float:
    """Root mean square distance by which two transforms differ over the map's known cells [m]."""
    rows, columns = np.nonzero(grid.cells)
    stride = max(1, len(rows) // 2000)
    x = (columns[::stride] + 0.5) * grid.resolution
    y = (rows[::stride] + 0.5) * grid.resolution
    points = grid.origin.apply(np.stack([x, y], axis=1))
    return float(np.sqrt(np.mean(np.sum((a.apply(points) - b.apply(points)) ** 2, axis=1))))


def wrong_ones(
    simulation: gridmerge.Simulation, grids: list[gridmerge.OccupancyGrid], answer: gridmerge.TeamAnswer
) -> set[str]:
    """Of each component who does not lie where it belongs, relative to the one that makes most of them do."""
    wrong: set[str] = set()
    status = {robot.name: robot for robot in answer.robots}
    for component in answer.components:
        best: set[str] = set(component.robots)
        for reference in component.robots:
            i = int(reference[2:])
            off = set()
            for robot in component.robots:
                k = int(robot[2:])
                found = status[reference].transform.inverse() @ status[robot].transform
                if displacement(grids[k], found, true_transform(simulation, i, k)) > tolerance_of(
                    simulation, i, k
                ):
                    off.add(robot)
            if len(off) < len(best):
                best = off
        wrong |= best
    return wrong


def batch_placed(grids: list[gridmerge.OccupancyGrid]) -> int:
    merged = gridmerge.merge(grids)
    return sum(len(component.members) for component in merged.components)


def simulate_team(number: int, robots: int, steps: int) -> gridmerge.Simulation:
    kind = KINDS[number % len(KINDS)]
    size = (20.0, 14.0) if kind == "apartment" else (44.0, 28.0)
    return gridmerge.simulate(
        kind,
        size=size,
        robots=robots,
        overlap=0.6,
        drift=(0.0, 0.3, 1.0)[number % 3],
        steps=steps,
        others=0,
        seed=100 + number,
    )


def run_team(number: int, arguments: argparse.Namespace, count: Count) -> None:
    kind = KINDS[number % len(KINDS)]
    simulation = simulate_team(number, arguments.robots, arguments.steps)
    team = gridmerge.Team(quiet=max(1.0, 2.0 / arguments.rate))
    wrong_before: set[str] = set()
    sure: set[str] = set()
    first, first_batch, placed, batch = "never", "never", [], []
    seen = 0
    for step in range(arguments.steps):
        start = time.monotonic()
        grids = [(*one.earlier, one.grid)[step] for one in simulation.maps]
        for i, grid in enumerate(grids):
            team.hear(f"tb{i}", grid)
        while time.monotonic() - start < 1.0 / arguments.rate:
            time.sleep(0.02)
            answer = team.answer()
            if answer.number == seen:
                continue
            seen = answer.number
            wrong_before |= wrong_ones(simulation, grids, answer)
            for event in answer.events:
                if event.kind in ("jumped", "left"):
                    count.jumps += 1
                    count.sure_jumps += event.robot in sure
            sure |= {
                robot.name for robot in answer.robots if robot.state == "placed" and robot.probability >= SURE
            }
            if answer.components and first == "never":
                first = f"{step + 1}"
        placed.append(sum(len(component.robots) for component in team.answer().components))
    for step in range(arguments.steps):
        batch.append(batch_placed([(*one.earlier, one.grid)[step] for one in simulation.maps]))
        if batch[-1] and first_batch == "never":
            first_batch = f"{step + 1}"
    if not team.wait_until_settled(600.0):
        sys.exit("the team did not settle")
    answer = team.answer()
    grids = [one.grid for one in simulation.maps]
    wrong = wrong_ones(simulation, grids, answer)
    merged = gridmerge.merge(grids)
    same = [tuple(f"tb{member.map}" for member in one.members) for one in merged.components] == [
        one.robots for one in answer.components
    ] and all(
        np.array_equal(one.grid.cells, other.grid.cells)
        for one, other in zip(merged.components, answer.components, strict=True)
    )
    count.teams += 1
    count.robots += len(grids)
    count.placed += sum(len(component.robots) for component in answer.components)
    count.wrong += len(wrong)
    count.wrong_before += len(wrong_before)
    count.same += same
    print(
        f"{kind:10s} first join at step {first:>5s} (merge() of the same maps: {first_batch:>5s}); placed by step "
        f"{placed} (merge(): {batch}); wrong {len(wrong)}, before {len(wrong_before)}; the same at the end: {same}",
        flush=True,
    )


def run_long(arguments: argparse.Namespace) -> None:
    simulation = gridmerge.simulate(
        "office", size=(44.0, 28.0), robots=arguments.robots, overlap=0.6, others=0, seed=9
    )
    team = gridmerge.Team(quiet=1.0)
    dice = np.random.default_rng(1)
    for i, one in enumerate(simulation.maps):
        team.hear(f"tb{i}", one.grid)
    team.wait_until_settled(600.0)
    parts = 6
    print(f"{arguments.updates} updates of {arguments.robots} robots:")
    for part in range(parts):
        start, cpu = time.monotonic(), time.process_time()
        for _ in range(arguments.updates // parts):
            i = int(dice.integers(len(simulation.maps)))
            grid = simulation.maps[i].grid
            cells = grid.cells.copy()
            cells.flat[dice.integers(cells.size, size=cells.size // 200)] = 0
            before = team.answer().number
            team.hear(f"tb{i}", gridmerge.OccupancyGrid.from_cells(cells, grid.resolution, grid.origin))
            while team.answer().number == before:
                time.sleep(0.002)
        with open("/proc/self/statm") as file:
            resident = int(file.read().split()[1]) * resource.getpagesize() / 1e6
        n = arguments.updates // parts
        print(
            f"  part {part + 1}: {1000 * (time.monotonic() - start) / n:.0f} ms an update, "
            f"{1000 * (time.process_time() - cpu) / n:.0f} ms of CPU, {resident:.0f} MB resident",
            flush=True,
        )


def run_hour(arguments: argparse.Namespace) -> None:
    played = hour.Hour(arguments.robots)
    team = gridmerge.Team()
    heard = 0

    def send(robot: int, second: int) -> None:
        nonlocal heard
        team.hear(f"tb{robot}", played.grid(robot, second))
        heard += 1

    def look(second: int) -> tuple[int, int, int, int]:
        answer = team.answer()
        # One map a second: which one an answer knows tells in which frame its pose is.
        maps = {robot.name: robot.maps_heard for robot in answer.robots}
        laps = [played.lap(robot, max(0, maps.get(f"tb{robot}", 0) - 1))[0] for robot in played.robots]
        placed = sum(len(component.robots) for component in answer.components)
        return heard, answer.number, placed, len(wrong_ones(*played.truth(laps, second), answer))

    print(f"An hour of {arguments.robots} robots, {arguments.speed:g} times as fast:", flush=True)
    hour.play(played, arguments.speed, hour.Cost(os.getpid()), send, look)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--teams", type=int, default=6)
    parser.add_argument("--robots", type=int, default=6)
    parser.add_argument("--steps", type=int, default=12)
    parser.add_argument("--rate", type=float, default=1.0, help="maps of each robot per second")
    parser.add_argument("--updates", type=int, default=600)
    parser.add_argument("--hour", action="store_true", help="play an hour instead")
    parser.add_argument("--speed", type=float, default=20.0, help="with --hour: seconds of it per second")
    arguments = parser.parse_args()
    if arguments.hour:
        run_hour(arguments)
        return
    count = Count()
    for number in range(arguments.teams):
        run_team(number, arguments, count)
    print(
        f"{count.teams} teams, {count.robots} robots: placed {count.placed}, wrong {count.wrong}; "
        f"placed wrongly before the end {count.wrong_before}; "
        f"jumps {count.jumps}, of robots that had been placed with {SURE} or more {count.sure_jumps}; "
        f"the same as merge() at the end: {count.same} of {count.teams}"
    )
    if arguments.updates:
        run_long(arguments)


if __name__ == "__main__":
    main()
