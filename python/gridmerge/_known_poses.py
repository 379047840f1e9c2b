# SPDX-License-Identifier: Apache-2.0
"""What is known beforehand of where maps lie."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import SupportsIndex, TypeAlias

import numpy as np

from . import _arguments, _bag, _core
from ._grid import OccupancyGrid
from ._transform import PoseLike, Transform, to_transform


@dataclass(frozen=True, slots=True)
class InitialPose:
    """What is known of a map's pose: where it lies in the world, and how well that is known."""

    transform: PoseLike
    """Takes the map's frame to the world's."""
    sd: float = 1.0
    """Standard deviation of the position [m]."""
    sd_theta: float = 0.1
    """Standard deviation of theta [rad]."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "transform", to_transform("transform", self.transform))


MapKey: TypeAlias = SupportsIndex | str | os.PathLike[str]
"""A map by its index, its name, or the path that it was loaded from."""

InitialPoses: TypeAlias = (
    str
    | os.PathLike[str]
    | Mapping[int, InitialPose | PoseLike]
    | Mapping[str, InitialPose | PoseLike]
    | Mapping[int | str, InitialPose | PoseLike]
    | Mapping[MapKey, InitialPose | PoseLike]
)
"""A table of poses (a TSV file, as `gridmerge merge --init` reads it), or poses by the maps' indices or names."""

CoreKnown: TypeAlias = tuple[tuple[float, float, float], float, float, bool]

_IDENTITY = Transform(0.0, 0.0, 0.0)


class NamedMaps:
    """Maps that go by what they are called, and by the files that they were loaded from."""

    def __init__(self, names: Sequence[str], grids: Sequence[OccupancyGrid]) -> None:
        self.names = names
        self._files = [grid._file for grid in grids]

    def __len__(self) -> int:
        return len(self.names)

    def at(self, path: str | os.PathLike[str]) -> int | None:
        """The map that lies there, by whichever way."""
        try:
            file, topic = _bag.split_name(path, None)
            there = os.stat(file)
        except (OSError, ValueError):
            return None
        for index, own in enumerate(self._files):
            try:
                if (
                    own is not None
                    and own[1] == topic.lstrip("/")
                    and os.path.samestat(there, os.stat(own[0]))
                ):
                    return index
            except OSError:
                continue
        return None

    def called(self, name: str) -> int | None:
        return self.names.index(name) if name in self.names else None


def to_known_poses(
    maps: NamedMaps, init: InitialPoses | None, fix: MapKey | Iterable[MapKey] | None
) -> list[CoreKnown | None]:
    """For each map what is known of its pose."""
    poses = _initial_poses(maps, init)
    fixed = _fixed_maps(maps, fix)
    for index in sorted(fixed):
        # A single map holds its own frame; how several lie to each other has to be said.
        if index not in poses and (len(fixed) > 1 or init is not None):
            raise ValueError(f"fix: {maps.names[index]!r} needs a pose in init")
    known: list[CoreKnown | None] = []
    for index in range(len(maps)):
        if index not in poses and index not in fixed:
            known.append(None)
            continue
        known.append(to_core(poses.get(index, InitialPose(_IDENTITY)), f"init[{index}]", index in fixed))
    return known


def to_core(pose: InitialPose | PoseLike, name: str, fixed: bool) -> CoreKnown:
    if not isinstance(pose, InitialPose):
        pose = InitialPose(to_transform(name, pose))
    x, y, theta = to_transform(name, pose.transform)
    sd = _arguments.number(f"{name}.sd", pose.sd)
    sd_theta = _arguments.number(f"{name}.sd_theta", pose.sd_theta)
    known = ((x, y, theta), sd, sd_theta, fixed)
    try:
        _core.validate_known_pose(known)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from None
    return known


def _initial_poses(maps: NamedMaps, init: InitialPoses | None) -> dict[int, InitialPose | PoseLike]:
    if init is None:
        return {}
    if isinstance(init, (str, os.PathLike)):
        return _poses_of_file(maps, init)
    if not isinstance(init, Mapping):
        raise TypeError(f"init: must be a path or a mapping, is {_arguments.kind_of(init)}")
    poses: dict[int, InitialPose | PoseLike] = {}
    for key, pose in init.items():
        index = _index_of(maps, key, "init")
        if index in poses:
            raise ValueError(f"init: {maps.names[index]!r} is named twice")
        poses[index] = pose
    return poses


def _poses_of_file(maps: NamedMaps, path: str | os.PathLike[str]) -> dict[int, InitialPose | PoseLike]:
    poses: dict[int, InitialPose | PoseLike] = {}
    for pose in _core.read_initial_poses(_arguments.path("init", path)):
        index = maps.at(pose.path)
        if index is None:
            index = maps.called(pose.name)
        if index is None:
            raise ValueError(f"init: {os.fsdecode(path)}: {pose.name!r} is none of the maps to be merged")
        if index in poses:
            raise ValueError(f"init: {os.fsdecode(path)}: {pose.name!r} is a map that it named before")
        poses[index] = InitialPose(Transform(*pose.transform), pose.sd, pose.sd_theta)
    return poses


def _fixed_maps(maps: NamedMaps, fix: MapKey | Iterable[MapKey] | None) -> set[int]:
    if fix is None:
        return set()
    if isinstance(fix, np.ndarray):
        fix = fix.tolist()
    if isinstance(fix, Iterable) and not isinstance(fix, (str, bytes, os.PathLike, Mapping)):
        return {_index_of(maps, key, "fix") for key in fix}
    return {_index_of(maps, fix, "fix")}


def _index_of(maps: NamedMaps, key: object, name: str) -> int:
    if isinstance(key, (str, os.PathLike)):
        text = os.fsdecode(key)
        found = maps.called(text)
        if found is None:
            found = maps.at(text)
        if found is None:
            raise ValueError(f"{name}: {text!r} is none of the maps")
        return found
    index = _arguments.index(name, key, "a map's index, name or path")
    if not 0 <= index < len(maps):
        raise ValueError(f"{name}: there is no map {index}")
    return index
