# SPDX-License-Identifier: Apache-2.0
"""The node: a lifecycle node around a team."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from time import monotonic
from typing import Any

from gridmerge import Team
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.timer import Timer

from gridmerge_ros.initial_poses import AXES, is_initial_pose, parameter_names, read_known_pose
from gridmerge_ros.lines import Lines
from gridmerge_ros.names import Selection, check_topic
from gridmerge_ros.parameters import PARAMETERS, Settings, read_settings
from gridmerge_ros.publishers import Publishers
from gridmerge_ros.robots import KnownPose, Robots
from gridmerge_ros.status import NodeHealth, TeamTransforms, diagnose, team_transforms
from gridmerge_ros.subscriptions import HEARS_UPDATES, MapSubscriptions

_ANSWERS_EVERY = 0.1  # so often the team is asked for news [s]
_DIAGNOSES_EVERY = 1.0  # [s]
_DIAGNOSES_APART = 0.25  # at least, whatever merging_rate is [s]
_EVENTS_KEPT = 5


class GridmergeNode(LifecycleNode):  # type: ignore[misc]
    """Hears the maps of robots, merges them, and publishes the merged maps, transforms and diagnostics.

    - configure: reads the parameters. Those are not taken while the node is configured.
    - activate: hears and publishes. What the team knows stays through deactivate and activate.
    - cleanup: forgets all robots.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("gridmerge", **options)
        for parameter in PARAMETERS:
            default = list(parameter.default) if isinstance(parameter.default, tuple) else parameter.default
            # ROS would refuse 4 for 4.0, and takes an empty list for one of bytes: read_settings() looks at types.
            description = ParameterDescriptor(description=parameter.text, dynamic_typing=True)
            self.declare_parameter(parameter.name, default, description)
        self.add_on_set_parameters_callback(self._on_set_parameters)
        self._tell = Lines(lambda line: self.get_logger().info(line))
        self._warn = Lines(lambda line: self.get_logger().warning(line))
        self._settings: Settings | None = None
        self._selection: Selection | None = None
        self._team: Team | None = None
        self._robots: Robots | None = None
        self._publishers_of_team: Publishers | None = None
        self._subscriptions_of_team: MapSubscriptions | None = None
        self._timers_of_team: list[Timer] = []
        self._forget_answers()

    @property
    def starts_itself(self) -> bool:
        """The parameter autostart. Raises ValueError where it is neither true nor false."""
        return read_settings({"autostart": self.get_parameter("autostart").value}).autostart

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Fails where parameters cannot be; the log says which."""
        try:
            self._configure()
        except Exception as error:  # of many kinds; rclpy would drop it without a word
            self.get_logger().error(f"not configured: {error}")
            self._release()
            return TransitionCallbackReturn.FAILURE
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """From now on robots are discovered."""
        try:
            self._activate()
        except Exception as error:  # likewise
            self.get_logger().error(f"not activated: {error}")
            self._rest()
            return TransitionCallbackReturn.FAILURE
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Nothing is heard or published any more; what was latched stays."""
        self._rest()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """All robots are forgotten, and what was latched is gone."""
        self._release()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """As cleanup."""
        self._release()
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Back to where it can be configured again."""
        self._release()
        return TransitionCallbackReturn.SUCCESS

    def _configure(self) -> None:
        settings = read_settings({one.name: self.get_parameter(one.name).value for one in PARAMETERS})
        check_topic(self.resolve_topic_name(settings.merged_map_topic))
        # Two names of topics may be one only in the node's namespace.
        selection = Selection(
            settings.robot_map_topic,
            settings.robot_map_updates_topic,
            settings.robot_namespace,
            {name: self.resolve_topic_name(topic) for name, topic in settings.robots},
            self.resolve_topic_name(settings.merged_map_topic),
        )
        self._settings = settings
        self._selection = selection
        self._team = Team(
            threads=settings.threads,
            accept=settings.accept,
            max_false_joins=settings.max_false_joins,
            output_resolution=settings.output_resolution or None,
            search_again=settings.search_again,
            confirmations=settings.confirmations,
            quiet=settings.quiet,
            max_robots=settings.max_robots,
        )
        for robot in settings.fixed_robots:
            pose = self._known_pose(robot)
            if isinstance(pose, str):
                raise ValueError(f"{robot}: {pose}")
        self._robots = Robots(self._team, settings.max_robots, self._tell, self._warn)
        self._publishers_of_team = Publishers(self, settings)
        if not HEARS_UPDATES:
            self._warn("no updates", _NO_UPDATES)

    def _activate(self) -> None:
        settings, robots = self._settings, self._robots
        assert settings is not None and robots is not None
        merged = self.resolve_topic_name(settings.merged_map_topic)
        assert self._selection is not None
        self._subscriptions_of_team = MapSubscriptions(self, self._selection, robots, self._known_pose)
        # A clock that stands or jumps, as that of a simulation may, must not hold the work up.
        clock = Clock(clock_type=ClockType.STEADY_TIME)
        work = [(1.0 / settings.discovery_rate, self._discover), (_ANSWERS_EVERY, self._look_for_answers)]
        work.append((_DIAGNOSES_EVERY, self._send_diagnoses))
        if settings.transforms == "dynamic":
            work.append((1.0 / settings.transform_rate, self._send_transforms))
        self._timers_of_team = [self.create_timer(period, call, clock=clock) for period, call in work]
        self._discover()
        wanted = ", ".join(topic for _, topic in settings.robots) or f"<namespace>/{settings.robot_map_topic}"
        self.get_logger().info(f"waiting for maps on {wanted}; the merged map will be on {merged}")

    def _rest(self) -> None:
        for timer in self._timers_of_team:
            self.destroy_timer(timer)
        self._timers_of_team = []
        if self._subscriptions_of_team is not None:
            self._subscriptions_of_team.close()
            self._subscriptions_of_team = None

    def _release(self) -> None:
        self._rest()
        if self._publishers_of_team is not None:
            self._publishers_of_team.close()
        self._settings = self._selection = self._team = self._robots = self._publishers_of_team = None
        self._forget_answers()

    def _forget_answers(self) -> None:
        self._told_answer = 0
        self._sent_answer = 0
        self._next_maps = 0.0
        self._diagnosed = 0.0
        self._transforms = TeamTransforms((), {})
        self._events = 0
        self._last_events: deque[str] = deque(maxlen=_EVENTS_KEPT)

    def _known_pose(self, robot: str) -> KnownPose | str | None:
        assert self._settings is not None
        for axis in AXES:
            for name in parameter_names(robot, axis):
                if not self.has_parameter(name):
                    self.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
        return read_known_pose(robot, self._settings, lambda name: self.get_parameter(name).value)

    def _discover(self) -> None:
        assert self._subscriptions_of_team is not None
        self._subscriptions_of_team.discover()

    def _look_for_answers(self) -> None:
        assert self._team is not None and self._settings is not None and self._robots is not None
        assert self._publishers_of_team is not None
        answer = self._team.answer()
        if answer.number != self._told_answer:
            for event in self._team.take_events():
                self._events += 1
                self._last_events.append(event.text)
                if event.kind == "restarted":
                    self._robots.count_restart(event.robot)
                self._tell(f"{event.kind} {event.robot}", event.text)
            self._robots.follow(answer)
            self._told_answer = answer.number
        if answer.number == self._sent_answer or monotonic() < self._next_maps:
            return
        self._sent_answer = answer.number
        self._next_maps = monotonic() + 1.0 / self._settings.merging_rate
        transforms = team_transforms(
            answer, self._robots.all, self._settings.world_frame, self._settings.robot_map_frame
        )
        for robot in sorted(transforms.withheld.keys() - self._transforms.withheld.keys()):
            self._warn(
                f"no transform {robot}", f"{robot}: no transform is published: {transforms.withheld[robot]}"
            )
        self._transforms = transforms
        self._publishers_of_team.send_transforms(transforms.transforms)
        self._publishers_of_team.send_maps(answer)
        if monotonic() >= self._diagnosed + _DIAGNOSES_APART:  # or the timer soon sends them
            self._send_diagnoses()

    def _send_transforms(self) -> None:
        assert self._publishers_of_team is not None
        self._publishers_of_team.send_transforms(self._transforms.transforms)

    def _send_diagnoses(self) -> None:
        self._tell.look()
        self._warn.look()
        assert self._team is not None and self._robots is not None and self._publishers_of_team is not None
        health = NodeHealth(
            # As other nodes of this name may have it, in namespaces of theirs.
            self.get_fully_qualified_name().lstrip("/"),
            self._robots.undecodable,
            len(self._robots.over_limit),
            self._events,
            tuple(self._last_events),
            () if HEARS_UPDATES else (_NO_UPDATES,),
        )
        diagnoses = diagnose(self._team.answer(), self._robots.all, self._transforms, health)
        self._publishers_of_team.send_diagnoses(diagnoses)
        self._diagnosed = monotonic()

    def _on_set_parameters(self, parameters: Sequence[Any]) -> SetParametersResult:
        own = {one.name for one in PARAMETERS}
        for parameter in parameters:
            # A declaration sets it too, but then it is not there yet.
            is_own = parameter.name in own or is_initial_pose(parameter.name)
            if self._settings is not None and is_own and self.has_parameter(parameter.name):
                reason = f"{parameter.name} is read when the node is configured: deactivate it and clean it up first"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)


_NO_UPDATES = "updates of maps are not heard: the package map_msgs is not installed"
