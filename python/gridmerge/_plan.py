# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import cast

from . import _arguments, _core
from ._grid import MapLike, OccupancyGrid
from ._inputs import to_map
from ._match import Reason
from ._repr import count, listed, probability, shortened
from ._transform import Transform


@dataclass(frozen=True, slots=True)
class PlanPart:
    """Maps that merge() joins without a plan, or a map alone, and how they lie on the plan."""

    maps: tuple[int, ...]
    """Indices of input maps, ascending."""
    names: tuple[str, ...]
    """Of these maps."""
    transform: Transform
    """Takes points of the first map's frame to the plan's, in metres of the maps: the best way that there is."""
    scale: float
    """By which the plan is too small if they lie so."""
    probability: float
    """That they lie so."""
    on_plan: bool
    """Whether they hang on the plan."""
    reason: Reason | None
    """Why they do not; None if they do."""
    explanation: str
    """The reason as the end of a sentence that begins with the maps' names; empty if there is none."""

    def __repr__(self) -> str:
        why = "on the plan" if self.on_plan else self.explanation
        return f"PlanPart({listed(self.names)}: {why}, {probability(self.probability)})"


@dataclass(frozen=True, slots=True)
class PlanPlacement:
    """An architect's plan, and which maps hang on it."""

    name: str
    """Of the plan: its file, its frame, or "plan"."""
    scale: float | None
    """By which the plan is too small: a point p of the plan, in its own metres, lies at scale * p in the frame of the
    component on the plan. None if no map hangs on it."""
    probability: float | None
    """Of the surest part, which decides the scale. None if no map hangs on it."""
    parts: tuple[PlanPart, ...]
    """In the order of their first maps."""

    def __repr__(self) -> str:
        on_plan = sum(len(part.maps) for part in self.parts if part.on_plan)
        scale = "" if self.scale is None else f", scale={self.scale:.4f}"
        return f"PlanPlacement({shortened(self.name)}, {count(on_plan, 'map')} on it{scale})"


def to_plan_placement(plan: _core.PlanPlacement, names: Sequence[str]) -> PlanPlacement:
    any_on_plan = any(part.on_plan for part in plan.parts)
    return PlanPlacement(
        name=plan.name,
        scale=plan.scale if any_on_plan else None,
        probability=plan.probability if any_on_plan else None,
        parts=tuple(
            PlanPart(
                maps=tuple(part.maps),
                names=tuple(names[i] for i in part.maps),
                transform=Transform(*part.transform),
                scale=part.scale,
                probability=part.probability,
                on_plan=part.on_plan,
                reason=None if part.on_plan else cast(Reason, part.reason),
                explanation="" if part.on_plan else part.explanation,
            )
            for part in plan.parts
        ),
    )


def choose_plan(
    grids: Sequence[OccupancyGrid],
    plan: MapLike | None,
    scale: object,
    up_the_tree: bool,
    is_fixed: bool,
    search: str,
    threads: int,
) -> tuple[OccupancyGrid, tuple[float, float]] | None:
    """The plan and its range of scales, as merge() takes them; none if there is none."""
    if plan is None:
        if scale is not None:
            raise ValueError("plan_scale: there is no plan")
        return None
    if up_the_tree:
        raise ValueError("strategy: plan needs 'joint'")
    if is_fixed:
        raise ValueError("plan: excludes fix: a merged map has one frame")
    scales = _core.DEFAULT_LEAST_PLAN_SCALE, _core.DEFAULT_MOST_PLAN_SCALE
    if scale is not None:
        scales = _arguments.scales("plan_scale", scale, search)
    drawing = to_map("plan", plan)
    try:
        _core.validate_plan([grid._core for grid in grids], drawing._core, threads)
    except ValueError as error:
        raise ValueError(f"plan: {error}") from None
    return drawing, scales
