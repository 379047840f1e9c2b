# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from . import _arguments, _bag, _core, _html
from ._message import Content, OccupancyGridMessage, Stamp, fill_message, read_message, to_fields
from ._transform import PoseLike, Transform, to_transform

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FARTHEST_ORIGIN = 1e9

M = TypeVar("M")


class OccupancyGrid:
    """An occupancy grid map: the layout of nav_msgs/OccupancyGrid. It cannot be changed.

    Args:
        data: int8 array of shape (height, width), row 0 at the bottom (y up): -1 unknown, 0 to 100 the occupancy
            in percent. Any strides will do; it is read where it lies.
        resolution: metres per cell.
        origin: pose of the lower left corner of cell (0, 0) in the map frame: (x, y, theta) [m, rad], a Transform
            or a 3x3 matrix.

    A cell is occupied from 65 percent on, free up to 19 and else unknown, as nav2 has it. Where all values are -1, 0
    or 100 the map has these three kinds of cells and no more; with any other value it has probabilities as well,
    which count when maps are merged.

    Raises TypeError for an array or a number of a wrong type, and ValueError for a wrong shape or value; the message
    begins with the argument's name.
    """

    __slots__ = ("_core", "_frame_id", "_source")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, data: NDArray[np.int8], resolution: float, origin: PoseLike = (0.0, 0.0, 0.0)) -> None:
        values = _checked_array("data", data, np.dtype(np.int8))
        place = _checked_place("", resolution, to_transform("origin", origin))
        self._core = _core.Grid.from_percentages(values, *place)
        self._source: str | None = None
        self._frame_id: str | None = None

    @classmethod
    def from_cells(
        cls,
        cells: NDArray[np.uint8],
        resolution: float,
        origin: PoseLike = (0.0, 0.0, 0.0),
        probability: NDArray[np.float32] | None = None,
    ) -> OccupancyGrid:
        """Of what `cells` and `probability` give, both of shape (height, width). Raises as the constructor."""
        values = _checked_array("cells", cells, np.dtype(np.uint8))
        place = _checked_place("", resolution, to_transform("origin", origin))
        if probability is not None:
            probability = _checked_array("probability", probability, np.dtype(np.float32))
        return cls._of(_core.Grid.from_cells(values, *place, probability))

    @classmethod
    def from_msg(cls, msg: OccupancyGridMessage | Mapping[str, Any]) -> OccupancyGrid:
        """Of a message like nav_msgs/OccupancyGrid (see OccupancyGridMessage), or a dict with its fields.

        Raises TypeError for a field that is missing or of a wrong type and ValueError for a wrong value, naming the
        field.
        """
        return cls._from_msg(msg, "")

    @classmethod
    def _from_msg(cls, msg: object, name: str) -> OccupancyGrid:
        content = read_message(msg, name)
        prefix = f"{name}." if name else ""
        place = _checked_place(f"{prefix}info.", content.resolution, content.origin)
        try:
            return cls._of(_core.Grid.from_percentages(content.values, *place), frame_id=content.frame_id)
        except ValueError as error:
            raise ValueError(f"{prefix}{error}") from None

    @classmethod
    def _of(cls, core: _core.Grid, source: str | None = None, frame_id: str | None = None) -> OccupancyGrid:
        grid = cls.__new__(cls)
        grid._core = core
        grid._source = source
        grid._frame_id = frame_id
        return grid

    @property
    def width(self) -> int:
        """Columns."""
        return self._core.width

    @property
    def height(self) -> int:
        """Rows."""
        return self._core.height

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width)."""
        return (self.height, self.width)

    @property
    def resolution(self) -> float:
        """Metres per cell."""
        return self._core.resolution

    @property
    def origin(self) -> Transform:
        """Pose of the lower left corner of cell (0, 0) in the map frame."""
        return Transform(*self._core.origin)

    @property
    def cells(self) -> NDArray[np.uint8]:
        """0 unknown, 1 free, 2 occupied: uint8 of shape (height, width), row 0 at the bottom.

        A read-only view, not a copy. It may outlive the map.
        """
        return self._core.cells()

    @property
    def probability(self) -> NDArray[np.float32] | None:
        """Probabilities of being occupied, NaN where unknown: float32 of shape (height, width), or None.

        A read-only view, not a copy. It may outlive the map.
        """
        return self._core.probability()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the file that the map was loaded from says that its author may not have meant, a sentence each."""
        return tuple(self._core.warnings)

    @property
    def source(self) -> str | None:
        """The path that the map was loaded from, as load() was given it."""
        return self._source

    @property
    def frame_id(self) -> str | None:
        """The frame that the message named which the map was made of."""
        return self._frame_id

    @property
    def _file(self) -> tuple[str, str] | None:
        """The same, wherever the program has gone since: the file or folder, and the topic of a bag or ""."""
        files = self._core.files
        if not files or self._source is None:
            return None
        given, topic = _bag.file_and_topic_of(self._source)
        file = os.fsdecode(files[0])
        metadata = "metadata.yaml"
        # Of a bag that is a folder.
        if os.path.basename(file) == metadata and os.path.basename(given) != metadata:
            file = os.path.dirname(file)
        return file, topic

    def to_numpy(self, *, probabilities: bool | None = None) -> NDArray[np.int8]:
        """The values of nav_msgs/OccupancyGrid: a new int8 array of shape (height, width), row 0 at the bottom.

        With probabilities=False a free cell is 0, an occupied one 100 and an unknown one -1. With True the values
        are the probabilities in percent (ValueError if there are none). Without either they are the percentages if
        these tell the whole map, as they do for a map that was made of percentages, so that
        ``OccupancyGrid(data, ...).to_numpy()`` equals data; for any other map, a merged one for example, they are as
        with False, because what merging calls free may be nearer to 50 percent than nav2's thresholds allow.
        """
        if probabilities is not None and not isinstance(probabilities, (bool, np.bool_)):
            raise TypeError(
                f"probabilities: must be True, False or None, is {_arguments.kind_of(probabilities)}"
            )
        return self._core.to_numpy(None if probabilities is None else bool(probabilities))

    @overload
    def to_msg(
        self,
        message_class: None = None,
        *,
        frame_id: str | None = None,
        stamp: Stamp | None = None,
        probabilities: bool | None = None,
    ) -> dict[str, Any]: ...

    @overload
    def to_msg(
        self,
        message_class: Callable[[], M],
        *,
        frame_id: str | None = None,
        stamp: Stamp | None = None,
        probabilities: bool | None = None,
    ) -> M: ...

    def to_msg(
        self,
        message_class: Callable[[], Any] | None = None,
        *,
        frame_id: str | None = None,
        stamp: Stamp | None = None,
        probabilities: bool | None = None,
    ) -> Any:
        """A message that from_msg() makes this map of: of a class like nav_msgs.msg.OccupancyGrid, or a dict.

        Args:
            message_class: called without arguments, it gives an empty message with the fields of
                nav_msgs/OccupancyGrid, of ROS 1, ROS 2 or anywhere. Without it the result is a dict of plain values, as
                JSON and rosbridge have them.
            frame_id: of the header; by default the one of the message that the map was made of, or "map".
            stamp: of the header, and the time at which the map was made: what the message class takes for it. By
                default the header's is as the class makes it.
            probabilities: as for to_numpy().

        Raises ValueError and TypeError as to_numpy(), and for a frame_id that is no text.
        """
        frame = frame_id if frame_id is not None else self._frame_id if self._frame_id is not None else "map"
        content = Content(
            self.to_numpy(probabilities=probabilities),
            self.resolution,
            self.origin,
            _arguments.text("frame_id", frame),
        )
        if message_class is None:
            return to_fields(content, stamp)
        if not callable(message_class):
            raise TypeError(
                f"message_class: must be a class of messages, is {_arguments.kind_of(message_class)}"
            )
        return fill_message(message_class(), content, stamp)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws the map in its frame [m]. Needs matplotlib: ``pip install 'gridmerge[plot]'``."""
        from . import _plot

        return _plot.plot_grid(self, ax)

    def __eq__(self, other: object) -> bool:
        """Whether sizes, resolution, origin, cells and probabilities are equal."""
        if not isinstance(other, OccupancyGrid):
            return NotImplemented
        return self._core.equals(other._core)

    def __repr__(self) -> str:
        x, y, theta = self.origin
        source = "" if self.source is None else f", source={self.source!r}"
        source += "" if self.frame_id is None else f", frame_id={self.frame_id!r}"
        return (
            f"OccupancyGrid({self.width} x {self.height} cells, resolution={self.resolution:g}, "
            f"origin=({x:g}, {y:g}, {theta:g}){source})"
        )

    def _repr_html_(self) -> str:
        return _html.grid_html(self)

    def __copy__(self) -> OccupancyGrid:
        return self

    def __deepcopy__(self, memo: object) -> OccupancyGrid:
        return self  # as it cannot be changed

    def __reduce__(self) -> tuple[Any, ...]:
        return (
            _unpickle,
            (
                *(self.cells, self.resolution, tuple(self.origin), self.probability),
                *(self.source, self.warnings, self._core.files, self.frame_id),
            ),
        )


MapLike: TypeAlias = OccupancyGrid | OccupancyGridMessage | Mapping[str, Any] | str | os.PathLike[str]
"""A map, a message like nav_msgs/OccupancyGrid or a dict of its fields, or the path of a map file."""


def load(
    path: str | os.PathLike[str],
    resolution: float | None = None,
    *,
    literal_thresholds: bool = False,
    topic: str | None = None,
) -> OccupancyGrid:
    """Reads a map_server YAML with its image, a bare image with its `resolution` [m/cell], or the last map of a bag.

    Images are PGM, PPM, PNG, BMP or JPEG. In trinary mode the gray 205, which map savers write for unknown, is unknown
    whatever the thresholds say, unless `literal_thresholds`.
    Bags are those of ROS 2 (.mcap, .db3, a rosbag2 folder) and, with the extra `rosbags`, of ROS 1 (.bag). The path
    may name the topic, as in ``robot.mcap#/tb1/map``, or `topic` does; without it the bag's only topic of maps is
    taken. Updates of the map (`<topic>_updates`) are applied.
    What the file says that its author may not have meant is in the map's ``warnings``.
    Raises FileError, an OSError, for a file that cannot be read or is no map, and ImportError for a bag of ROS 1
    without rosbags.
    """
    name = _arguments.path("path", path)
    cell = 0.0 if resolution is None else to_resolution("resolution", resolution)
    file, wanted = _bag.split_name(path, topic)
    if _bag.is_ros1(file):
        core, frame = _bag.load_ros1(file, wanted)
    elif _core.is_bag(file):
        core, frame, _, _ = _core.load_topic(file, _arguments.to_bytes(wanted))
    elif topic is None:
        return OccupancyGrid._of(_core.load(name, cell, bool(literal_thresholds)), os.fsdecode(name))
    else:
        raise _core.FileError(f"{os.fsdecode(file)}: is no bag, and so has no topic {topic!r}")
    source = os.fsdecode(file) + (f"#{wanted}" if wanted else "")
    return OccupancyGrid._of(core, source, frame or None)


def save(grid: OccupancyGrid, path: str | os.PathLike[str], *, probabilities: bool = False) -> None:
    """Writes a map for map_server: the YAML `path`, and beside it the image of the same name but for .pgm.

    Loading gives the same cells, resolution and origin. With `probabilities` the mode is raw and the probabilities
    are kept to within a percent; ValueError if there are none. The thresholds in the YAML are then those that tell the
    cells apart. A map whose cells do not follow from its probabilities gets other cells.
    Raises FileError, an OSError, when a file cannot be written; then the old ones are as they were.
    """
    if not isinstance(grid, OccupancyGrid):
        raise TypeError(f"grid: must be an OccupancyGrid, is {_arguments.kind_of(grid)}")
    _core.save(grid._core, _arguments.path("path", path), bool(probabilities))


def _unpickle(
    cells: NDArray[np.uint8],
    resolution: float,
    origin: tuple[float, float, float],
    probability: NDArray[np.float32] | None,
    source: str | None,
    warnings: Sequence[str],
    files: Sequence[bytes],
    frame_id: str | None = None,
) -> OccupancyGrid:
    core = _core.Grid.from_cells(cells, resolution, origin, probability)
    texts = [_arguments.to_bytes(warning) for warning in warnings]
    return OccupancyGrid._of(core.with_files(texts, files), source, frame_id)


def _checked_array(name: str, data: object, dtype: np.dtype[Any]) -> Any:
    if isinstance(data, np.ma.MaskedArray):
        raise TypeError(f"{name}: masked arrays are not taken; data.filled(-1) makes masked cells unknown")
    if not isinstance(data, np.ndarray):
        remedy = f"; np.array({name}, dtype=np.{dtype}) makes one" if isinstance(data, (list, tuple)) else ""
        raise TypeError(f"{name}: must be a numpy array of {dtype}, is {_arguments.kind_of(data)}{remedy}")
    if data.dtype != dtype:
        remedy = f"; {name}.astype(np.{dtype}) converts it" if data.dtype.kind in "biuf" else ""
        raise TypeError(f"{name}: must be of dtype {dtype}, is {data.dtype}{remedy}")
    if data.ndim != 2:
        raise ValueError(f"{name}: must have two dimensions (height, width), has {data.ndim}")
    return np.require(data, requirements=["ALIGNED"])


def to_resolution(name: str, value: object) -> float:
    resolution = _arguments.number(name, value)
    if not _core.MIN_RESOLUTION <= resolution <= _core.MAX_RESOLUTION:
        raise ValueError(
            f"{name}: must be between {_core.MIN_RESOLUTION:g} and {_core.MAX_RESOLUTION:g} metres per cell, is {value}"
        )
    return resolution


def _checked_place(
    prefix: str, resolution: object, origin: Transform
) -> tuple[float, tuple[float, float, float]]:
    cell = to_resolution(f"{prefix}resolution", resolution)
    if max(abs(origin.x), abs(origin.y)) > _FARTHEST_ORIGIN:
        raise ValueError(
            f"{prefix}origin: must lie within {_FARTHEST_ORIGIN:g} m, is at {origin.x}, {origin.y}"
        )
    return cell, (origin.x, origin.y, origin.theta)
