# SPDX-License-Identifier: Apache-2.0
"""What is known beforehand of where maps lie."""

from __future__ import annotations

import operator
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from . import _arguments, _core
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


MapKey: TypeAlias = int | str
"""A map by its index or its name."""

InitialPoses: TypeAlias = (
    str
    | os.PathLike[str]
    | Mapping[int, InitialPose | PoseLike]
    | Mapping[str, InitialPose | PoseLike]
    | Mapping[MapKey, InitialPose | PoseLike]
)
"""A table of poses (a TSV file, as `gridmerge merge --init` reads it), or poses by the maps' indices or names."""

CoreKnown: TypeAlias = tuple[tuple[float, float, float], float, float, bool]

_IDENTITY = Transform(0.0, 0.0, 0.0)


def to_known_poses(
    names: Sequence[str], init: InitialPoses | None, fix: MapKey | Sequence[MapKey] | None
) -> list[CoreKnown | None]:
    """For each map what is known of its pose."""
    poses = _initial_poses(names, init)
    fixed = _fixed_maps(names, fix)
    for index in fixed:
        # A single map holds its own frame; how several lie to each other has to be said.
        if index not in poses and (len(fixed) > 1 or init is not None):
            raise ValueError(f"fix: {names[index]!r} needs a pose in init")
    known: list[CoreKnown | None] = []
    for index in range(len(names)):
        if index not in poses and index not in fixed:
            known.append(None)
            continue
        known.append(to_core(poses.get(index, InitialPose(_IDENTITY)), f"init[{index}]", index in fixed))
    return known


def to_core(pose: InitialPose | PoseLike, name: str, fixed: bool) -> CoreKnown:
    if not isinstance(pose, InitialPose):
        pose = InitialPose(pose)
    x, y, theta = to_transform(name, pose.transform)
    sd = _arguments.number(f"{name}.sd", pose.sd)
    sd_theta = _arguments.number(f"{name}.sd_theta", pose.sd_theta)
    return ((x, y, theta), sd, sd_theta, fixed)


def _initial_poses(names: Sequence[str], init: InitialPoses | None) -> dict[int, InitialPose | PoseLike]:
    if init is None:
        return {}
    if isinstance(init, (str, os.PathLike)):
        return _poses_of_file(names, init)
    if not isinstance(init, Mapping):
        raise TypeError(f"init: must be a path or a mapping, is {_arguments.kind_of(init)}")
    poses: dict[int, InitialPose | PoseLike] = {}
    for key, pose in init.items():
        index = _index_of(names, key, "init")
        if index in poses:
            raise ValueError(f"init: {names[index]!r} is named twice")
        poses[index] = pose
    return poses


def _poses_of_file(names: Sequence[str], path: str | os.PathLike[str]) -> dict[int, InitialPose | PoseLike]:
    poses: dict[int, InitialPose | PoseLike] = {}
    for pose in _core.read_initial_poses(_arguments.path("init", path)):
        index = _find_map(names, pose.name, pose.path)
        if index is None:
            raise ValueError(f"init: {os.fsdecode(path)}: {pose.name!r} is none of the maps to be merged")
        if index in poses:
            raise ValueError(f"init: {os.fsdecode(path)}: {pose.name!r} is a map that it named before")
        poses[index] = InitialPose(Transform(*pose.transform), pose.sd, pose.sd_theta)
    return poses


def _fixed_maps(names: Sequence[str], fix: MapKey | Sequence[MapKey] | None) -> set[int]:
    if fix is None:
        return set()
    keys = [fix] if isinstance(fix, (str, int)) else fix
    if not isinstance(keys, Sequence):
        raise TypeError(f"fix: must be an index or a name, or several, is {_arguments.kind_of(fix)}")
    return {_index_of(names, key, "fix") for key in keys}


def _index_of(names: Sequence[str], key: object, name: str) -> int:
    if isinstance(key, (str, os.PathLike)):
        text = os.fsdecode(key)
        found = _find_map(names, text, text)
        if found is None:
            raise ValueError(f"{name}: {text!r} is none of the maps")
        return found
    try:
        index = operator.index(key)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(
            f"{name}: maps are told by index or name, not by what is {_arguments.kind_of(key)}"
        ) from None
    if not 0 <= index < len(names):
        raise ValueError(f"{name}: there is no map {index}")
    return index


def _find_map(names: Sequence[str], name: str, path: str) -> int | None:
    """The map that lies at `path`, by whichever way, or is named so."""
    for index, other in enumerate(names):
        try:
            if os.path.samefile(path, other):
                return index
        except (OSError, ValueError):
            continue
    return names.index(name) if name in names else None
