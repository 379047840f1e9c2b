# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass

from . import _arguments, _core
from ._merge_result import LeftOut, Member, to_left_out, to_member
from ._plan import PlanPlacement, to_plan_placement
from ._repr import count, listed


@dataclass(frozen=True, slots=True)
class RecordedComponent:
    """Maps that a merge has joined."""

    file: str
    """Of the merged map, beside transforms.json: merged.yaml, merged_2.yaml, ..."""
    members: tuple[Member, ...]
    """Ascending by index, two or more: where each lies, how surely, and how it is bent or stretched."""
    in_world_frame: bool
    """Whether the frame is that of the initial poses or of the plan, instead of the first member's."""

    def __repr__(self) -> str:
        names = listed([member.name for member in self.members])
        return f"RecordedComponent({self.file}, {count(len(self.members), 'map')}: {names})"


@dataclass(frozen=True, slots=True)
class MergeRecord:
    """What transforms.json keeps of a merge, as far as maps are to be laid on each other by it. For the comparisons of
    pairs see the file itself."""

    names: tuple[str, ...]
    """Of all maps that were merged, in their order."""
    components: tuple[RecordedComponent, ...]
    """Of two or more maps each, in the order of their files."""
    left_out: tuple[LeftOut, ...]
    """Maps that joined nothing."""
    plan: PlanPlacement | None
    """Which maps hang on the plan, and how; None if none was given."""

    def placed(self) -> Iterator[tuple[Member, RecordedComponent]]:
        """Each map that lies in a component, with it."""
        for component in self.components:
            for member in component.members:
                yield member, component

    def __repr__(self) -> str:
        joined = sum(len(component.members) for component in self.components)
        return (
            f"MergeRecord({joined} of {count(len(self.names), 'map')} in "
            f"{count(len(self.components), 'component')})"
        )


def read_transforms(path: str | os.PathLike[str]) -> MergeRecord:
    """Where the maps of a merge lie, as its transforms.json says.

    Args:
        path: the file, or the folder that it lies in: what `gridmerge merge -o` or MergeResult.save() wrote to.

    Needs neither the maps nor the merged maps. `Member.to_component()` takes points of a map's frame to the merged
    map's, with its scale or bend, and `Member.to_map()` takes them back. Raises FileError for a file that is not there,
    or that is damaged; the message says what is wrong where.
    """
    names, merged = _core.read_transforms(_arguments.path("path", path))
    return MergeRecord(
        names=tuple(names),
        components=tuple(
            RecordedComponent(
                file=_core.component_file(i),
                members=tuple(to_member(member, names) for member in merged.members(i)),
                in_world_frame=merged.is_in_world_frame(i),
            )
            for i in range(merged.component_count)
        ),
        left_out=tuple(to_left_out(one, names) for one in merged.left_out),
        plan=None if merged.plan is None else to_plan_placement(merged.plan, names),
    )
