# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Literal, TypeAlias, cast

from . import _arguments, _core
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_map
from ._known_poses import InitialPose, to_core
from ._match import Reason, to_joint_search
from ._merge import to_joint_accept, to_output_resolution
from ._merge_result import MergeResult, to_merge_result
from ._repr import count, short_pose, shortened
from ._transform import PoseLike, Transform

RobotState: TypeAlias = Literal["waiting", "placed", "left_out"]
"""What is known of a robot: nothing to compare it with yet, its place, or that it lies nowhere surely enough."""

TeamEventKind: TypeAlias = Literal["joined", "left", "jumped", "restarted", "renumbered"]
"""What happened to a robot."""

_WAKE = 0.1  # how often a waiting call lets Python handle signals [s]


@dataclass(frozen=True, slots=True)
class RobotStatus:
    """A robot of a team."""

    name: str
    """What Team.hear() calls it."""
    state: RobotState
    """What is known of it."""
    reason: Reason | None
    """Why it was left out."""
    why: str
    """The state in a few words, for people."""
    component: int | None
    """Index into TeamAnswer.components; None for a robot that lies in none."""
    transform: Transform
    """T_world_map: takes the map's frame to its component's."""
    probability: float
    """That it lies there."""
    maps_heard: int
    """Maps and parts of maps, those that changed nothing too."""
    heard_first: float
    """Since when it is heard, by the oldest account: seconds since 1970."""
    has_known_pose: bool = False
    """One was set, and its map has not started anew since (Team.hear)."""

    def __repr__(self) -> str:
        place = f", transform={short_pose(self.transform)}" if self.component is not None else ""
        return f"RobotStatus({self.name!r}, {self.state}: {self.why}{place})"


@dataclass(frozen=True, slots=True)
class TeamComponent:
    """Robots that were placed together."""

    number: int
    """What frames and topics are named after, from 1. It stays while components come, go and grow. The one in the
    frame of fixed poses has 1, and no other one has while there are such poses. A component that is made of several has
    their least. Numbers that no component has any more are given anew, so there may be gaps."""
    anchor: str | None
    """The robot whose map frame is the component's. None where poses are fixed: the frame is then theirs."""
    robots: tuple[str, ...]
    """By name; two or more."""
    grid: OccupancyGrid
    """All their maps, fused."""

    def __repr__(self) -> str:
        robots = ", ".join(map(shortened, self.robots))
        return f"TeamComponent({robots}: {self.grid.width} x {self.grid.height} cells)"


@dataclass(frozen=True, slots=True)
class TeamEvent:
    """What has changed from one answer to the next."""

    kind: TeamEventKind
    """What happened."""
    robot: str
    """To whom."""
    text: str
    """One line that names the robot."""


@dataclass(frozen=True, slots=True)
class TeamAnswer:
    """What a team knows at one moment."""

    number: int
    """Counts up; 0 is the answer before anything was heard. One that differs from the answer before in
    RobotStatus.maps_heard alone has its number."""
    components: tuple[TeamComponent, ...]
    """By number."""
    robots: tuple[RobotStatus, ...]
    """By name."""
    events: tuple[TeamEvent, ...]
    """Since the answer before."""
    seconds: float
    """That it took to find out."""
    settled: bool
    """The newest maps were searched as merge() does, nothing is held against them: components and poses are those of
    merge() with these maps, in the order of first hearing."""
    problem: str | None = field(default=None)
    """Why this is the answer before, made again; None where there is none."""

    def __repr__(self) -> str:
        state = "settled" if self.settled else "not settled"
        robots, components = count(len(self.robots), "robot"), count(len(self.components), "component")
        return f"TeamAnswer({self.number}: {robots}, {components}, {state})"


class Team:
    """Robots that map while they are heard, come and go, and know nothing of each other's frames.

    A thread of its own merges the newest map of each, never a queue of old ones. Methods may be called from any
    thread, and none waits for that work, except wait_until_settled().

    Answers are steady. A robot's pose follows the evidence, but a robot that was placed moves elsewhere only when that
    is confirmed, and each jump is reported. A component's frame is that of the robot that was heard first, for as long
    as it lives.

    Args:
        threads, accept, max_false_joins, output_resolution, search: as of merge().
        search_again: a map is searched anew when this share of its known cells differs from when it was searched last;
            a quarter of it is enough for a robot that lies nowhere yet. In between, the pose follows the map once a
            fiftieth of its cells or walls is new. A smaller change is drawn at once where the robot lies.
        confirmations: a robot that was placed moves when so many answers in a row, each with newer maps, say so in the
            same way.
        quiet: with no newer map for so long [s], all that is left is searched, and what that says is taken at once. At
            most a year.
        max_robots: hear() refuses more.
    """

    def __init__(
        self,
        *,
        threads: int = 0,
        accept: float | None = None,
        max_false_joins: float = _core.DEFAULT_MAX_FALSE_JOINS,
        output_resolution: float | None = None,
        search: str = "exhaustive",
        search_again: float = 0.1,
        confirmations: int = 3,
        quiet: float = 3.0,
        max_robots: int = 256,
    ) -> None:
        options = _core.TeamOptions()
        options.threads = _arguments.threads(threads)
        options.accept = to_joint_accept(accept)
        options.max_false_joins = _arguments.not_negative("max_false_joins", max_false_joins)
        options.output_resolution = to_output_resolution(output_resolution)
        options.set_search(to_joint_search(search))
        options.search_again = _arguments.share("search_again", search_again)
        options.confirmations = _arguments.whole("confirmations", confirmations, 1, 1000)
        options.quiet = _arguments.not_negative("quiet", quiet)
        options.max_robots = _arguments.whole("max_robots", max_robots, 1, 1_000_000)
        self._core = _core.Team(options)
        self._accept = options.accept
        self._files: set[bytes] = (
            set()
        )  # of every map that was heard: a result may still hold one that is gone

    def __repr__(self) -> str:
        return f"Team({self.answer()!r})"

    def hear(self, robot: str, map: MapLike) -> None:
        """The robot's newest map. ValueError for a robot too many.

        A map that differs too much from the one before is that of a robot which started anew in another frame: what was
        known of its pose is forgotten. A known pose is kept if most walls are where they were, as where a closed
        loop bent the map.
        """
        name, core = _name("robot", robot), to_map("map", map)._core
        self._core.hear(name, core)
        self._files.update(core.files)

    def hear_part(self, robot: str, column: int, row: int, part: MapLike) -> bool:
        """New cells of a rectangle of the robot's newest map, with cell (column, row) at its lower left corner.

        The part's resolution and origin play no role. False, and nothing changes, where there is no map that holds the
        rectangle.
        """
        name, core = _name("robot", robot), to_map("part", part)._core
        is_in_place = self._core.hear_part(
            name,
            _arguments.whole("column", column, 0, 2**31 - 1),
            _arguments.whole("row", row, 0, 2**31 - 1),
            core,
        )
        self._files.update(core.files)
        return bool(is_in_place)

    def hear_age(self, robot: str, heard_first: float) -> None:
        """Another node of the same team has heard the robot since then: RobotStatus.heard_first of its answer.

        Nodes that tell each other agree on frames, though they heard robots in another order.
        """
        self._core.hear_age(_name("robot", robot), _arguments.not_negative("heard_first", heard_first))

    def forget(self, robot: str) -> None:
        """The robot is gone, and its map with it.

        From now on the robot has no pose in answer(). Components and merged maps go without it from the next answer on.
        """
        self._core.forget(_name("robot", robot))

    def set_known_pose(self, robot: str, pose: InitialPose | PoseLike | None, *, fixed: bool = False) -> None:
        """What is known of where a robot's map lies, heard or not yet; None for nothing any more.

        It counts for the newest map that was heard before, and holds until the robot's map starts anew (hear()).
        ValueError for `fixed` without a pose: a team's frame is that of the robot which was heard first.
        """
        if pose is None and fixed:
            raise ValueError("fixed: needs a pose")
        known = None if pose is None else to_core(pose, "pose", bool(fixed))
        self._core.set_known_pose(_name("robot", robot), known)

    def answer(self) -> TeamAnswer:
        """The newest."""
        return _to_answer(self._core.answer())

    def merge_result(self) -> MergeResult:
        """The newest answer as merge() would give it: to plot, save and export, with the figures behind each join.

        Components are those of the answer, by number: the first one, saved as merged.yaml, need not be the largest.
        Names are the robots', of those with maps, in the order in which they came. While the answer holds a change
        back, its joins can already say otherwise. No file that a map was heard from is written over.
        """
        merged, names = self._core.merged()
        files = tuple(sorted(self._files))
        return to_merge_result(
            merged, [OccupancyGrid._of(grid) for grid in merged.maps], names, files, self._accept
        )

    def take_events(self) -> tuple[TeamEvent, ...]:
        """What has changed since this was called last, oldest first: the events of every answer, those too that nobody
        asked for.

        Of more than 1000 the newest are kept.
        """
        return tuple(_to_event(event) for event in self._core.take_events())

    def wait_until_settled(self, seconds: float = 60.0) -> bool:
        """Waits until all that was heard is settled, or for so long [s]; says whether it is. Ctrl-C ends it."""
        until = time.monotonic() + _arguments.not_negative("seconds", seconds)
        while True:
            left = until - time.monotonic()
            if self._core.wait_until_settled(max(0.0, min(_WAKE, left))):
                return True
            if left <= 0.0:
                return False


def _name(name: str, value: object) -> bytes:
    """A robot's name as the engine takes it."""
    return _arguments.to_bytes(_arguments.map_name(name, value))


def _to_event(event: _core.TeamEvent) -> TeamEvent:
    return TeamEvent(cast(TeamEventKind, event.kind), event.robot, event.text)


def _to_answer(answer: _core.TeamAnswer) -> TeamAnswer:
    return TeamAnswer(
        number=answer.number,
        components=tuple(
            TeamComponent(one.number, one.anchor or None, tuple(one.robots), OccupancyGrid._of(one.map))
            for one in answer.components
        ),
        robots=tuple(
            RobotStatus(
                robot.name,
                cast(RobotState, robot.state),
                None if robot.reason == "none" else cast(Reason, robot.reason),
                robot.why,
                robot.component,
                Transform(*robot.transform),
                robot.probability,
                robot.maps_heard,
                robot.heard_first,
                robot.has_known_pose,
            )
            for robot in answer.robots
        ),
        events=tuple(_to_event(event) for event in answer.events),
        seconds=answer.seconds,
        settled=answer.settled,
        problem=answer.problem or None,
    )
