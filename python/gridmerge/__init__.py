# SPDX-License-Identifier: Apache-2.0
"""Merges occupancy grid maps made by robots that do not know where the others are.

>>> import gridmerge
>>> result = gridmerge.merge(["robot_1.yaml", "robot_2.yaml", "robot_3.yaml"])
>>> for member in result.components[0].members:
...     print(member.name, member.transform)
>>> result.save("merged")

Metres and radians, angles counter-clockwise. A transform takes points of the frame that is named last to the one
that is named first: that of ``match(fixed, moving)`` takes a point of the moving map to the fixed one.
"""

from importlib.metadata import version
from types import FunctionType

from ._bag import BagTopic, RecordedMap, bag_topics, recorded_maps
from ._cache import CacheWarning
from ._core import FileError
from ._deformation import Deformation
from ._evaluate import (
    Evaluation,
    MatchCase,
    NegativeCounts,
    PairCounts,
    SetCase,
    SetCounts,
    TimeSummary,
    evaluate,
)
from ._executor import ExecutorError
from ._grid import MapLike, OccupancyGrid, load, save
from ._inputs import MapWarning
from ._known_poses import InitialPose
from ._match import Hypothesis, MatchResult, PairPose, Reason, Verdict, match
from ._measure import (
    CellClass,
    CommonCells,
    DistancePass,
    JointMeasure,
    PoseMeasure,
    PsiTerms,
    count_equal_cells,
    distance_map,
    draw_on_lattice,
    measure,
    measure_maps,
    measure_poses,
    poses_between,
)
from ._merge import merge
from ._merge_result import (
    Component,
    ExportFormat,
    Join,
    JoinOutcome,
    LeftOut,
    Member,
    MergeResult,
    NotCompared,
    OpenWay,
)
from ._merger import Merger
from ._message import OccupancyGridMessage
from ._plan import PlanPart, PlanPlacement
from ._random_walk import RandomWalkMatch, Trace, Walk, match_by_random_walk, plot_walk
from ._record import MergeRecord, RecordedComponent, read_transforms
from ._simulate import BUILDING_KINDS, SimulatedMap, SimulatedPair, Simulation, simulate
from ._team import RobotState, RobotStatus, Team, TeamAnswer, TeamComponent, TeamEvent, TeamEventKind
from ._transform import PoseLike, Transform

__version__ = version("gridmerge")

__all__ = [
    "BUILDING_KINDS",
    "BagTopic",
    "CacheWarning",
    "CellClass",
    "CommonCells",
    "Component",
    "Deformation",
    "DistancePass",
    "Evaluation",
    "ExecutorError",
    "ExportFormat",
    "FileError",
    "Hypothesis",
    "InitialPose",
    "Join",
    "JoinOutcome",
    "JointMeasure",
    "LeftOut",
    "MapLike",
    "MapWarning",
    "MatchCase",
    "MatchResult",
    "Member",
    "MergeRecord",
    "MergeResult",
    "Merger",
    "NegativeCounts",
    "NotCompared",
    "OccupancyGrid",
    "OccupancyGridMessage",
    "OpenWay",
    "PlanPart",
    "PlanPlacement",
    "PairCounts",
    "PairPose",
    "PoseLike",
    "PoseMeasure",
    "PsiTerms",
    "RandomWalkMatch",
    "Reason",
    "RecordedComponent",
    "RecordedMap",
    "RobotState",
    "RobotStatus",
    "SetCase",
    "SetCounts",
    "SimulatedMap",
    "SimulatedPair",
    "Simulation",
    "Team",
    "TeamAnswer",
    "TeamComponent",
    "TeamEvent",
    "TeamEventKind",
    "TimeSummary",
    "Trace",
    "Transform",
    "Verdict",
    "Walk",
    "bag_topics",
    "count_equal_cells",
    "distance_map",
    "draw_on_lattice",
    "evaluate",
    "load",
    "match",
    "match_by_random_walk",
    "measure",
    "measure_maps",
    "measure_poses",
    "merge",
    "plot_walk",
    "poses_between",
    "read_transforms",
    "recorded_maps",
    "save",
    "simulate",
]

FileError.__doc__ = (
    "A file that cannot be read or written. The message is one line that names the file and the cause."
)

# In messages and help() things are where they are imported from.
for _public in [globals()[_name] for _name in __all__]:
    if isinstance(_public, (type, FunctionType)):
        _public.__module__ = __name__
