# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments. Every error begins with the argument's name."""

from __future__ import annotations

import math
import numbers
import operator
import os
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import _core

PathLike: TypeAlias = str | os.PathLike[str]
Progress: TypeAlias = Callable[[float], object]

_MOST_THREADS = 2**16


def number(name: str, value: object) -> float:
    """A finite number."""
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name}: must be a number, is {kind_of(value)}")
    try:
        converted = float(value)
    except OverflowError:
        converted = math.inf
    if not math.isfinite(converted):
        raise ValueError(f"{name}: must be finite, is {_shown(value)}")
    return converted


def not_negative(name: str, value: object) -> float:
    converted = number(name, value)
    if converted < 0.0:
        raise ValueError(f"{name}: must not be negative, is {value}")
    return converted


def share(name: str, value: object) -> float:
    """A number in [0, 1]."""
    converted = number(name, value)
    if not 0.0 <= converted <= 1.0:
        raise ValueError(f"{name}: must lie in [0, 1], is {value}")
    return converted


def index(name: str, value: object, what: str = "a whole number") -> int:
    try:
        converted = None if isinstance(value, bool) else operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        converted = None
    if converted is None:
        raise TypeError(f"{name}: must be {what}, is {kind_of(value)}")
    return converted


def whole(name: str, value: object, least: int, most: int) -> int:
    converted = index(name, value)
    if not least <= converted <= most:
        raise ValueError(f"{name}: must be between {least} and {most}, is {_shown(converted)}")
    return converted


def threads(value: object) -> int:
    return whole("threads", value, 0, _MOST_THREADS)


def choice(name: str, value: object, choices: tuple[str, ...]) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name}: must be one of {', '.join(choices)}, is {kind_of(value)}")
    if value not in choices:
        raise ValueError(f"{name}: must be one of {', '.join(choices)}, is {value!r}")
    return value


def scales(name: str, value: object, search: str) -> tuple[float, float]:
    """A range of scales that match() searches."""
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise TypeError(f"{name}: must be a pair of numbers, is {kind_of(value)}")
    least, most = (number(name, one) for one in value)
    if search not in _core.joint_search_methods():
        raise ValueError(f"{name}: does not go with the search {search!r}")
    if not 1e-3 <= least <= most <= 1e3 or most > 20.0 * least:
        raise ValueError(
            f"{name}: must go from a smaller to a larger one within [0.001, 1000], at most 20 times as large, "
            f"is {least:g} to {most:g}"
        )
    return least, most


def path(name: str, value: object) -> bytes:
    """A path as the file system spells it."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: must be a path, is {kind_of(value)}")
    try:
        converted = os.fsencode(value)
    except UnicodeEncodeError as error:
        raise ValueError(f"{name}: {value!r} is no path: {error.reason}") from None
    if not converted:
        raise ValueError(f"{name}: is an empty path")
    if b"\0" in converted:
        raise ValueError(f"{name}: a path cannot hold a null character")
    return converted


def text(name: str, value: object) -> str:
    """Text that can be written to files."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: must be a string, is {kind_of(value)}")
    try:
        to_bytes(value)
    except UnicodeEncodeError as error:
        raise ValueError(f"{name}: {value!r} cannot be written: {error.reason}") from None
    return value


def map_name(name: str, value: object) -> str:
    """What a map is to be called: text that every file of a merge can hold."""
    converted = text(name, value)
    if not converted:
        raise ValueError(f"{name}: is empty")
    if "\0" in converted:
        raise ValueError(f"{name}: cannot hold a null character")
    return converted


def to_bytes(text: str) -> bytes:
    """Text as the engine holds it: names of files may be any bytes, which os.fsdecode() makes surrogates of."""
    return text.encode("utf-8", "surrogateescape")


def array(name: str, value: object, dtype: type[np.generic] | None = None) -> NDArray[Any]:
    """What numpy makes of it: numbers of a regular shape."""
    try:
        return np.asarray(value, dtype=dtype)
    except TypeError as error:
        raise TypeError(f"{name}: cannot be read as an array: {error}") from None
    except (ValueError, OverflowError) as error:
        raise ValueError(f"{name}: cannot be read as an array: {error}") from None


def several(name: str, value: object, what: str) -> list[Any]:
    """The items of a sequence or of an array, which is no text."""
    if not isinstance(value, (Sequence, np.ndarray)) or isinstance(value, (str, bytes)):
        raise TypeError(f"{name}: must be {what}, is {kind_of(value)}")
    if isinstance(value, np.ndarray) and value.ndim == 0:
        raise TypeError(f"{name}: must be {what}, is a single value")
    return list(value)


def _shown(value: object) -> str:
    try:
        return str(value)
    except ValueError:  # Python writes no more digits
        return "a number of more than 4000 digits"


def progress(value: object) -> Progress | None:
    if value is not None and not callable(value):
        raise TypeError(f"progress: must be callable, is {kind_of(value)}")
    return value


def kind_of(value: object) -> str:
    """The name of a value's type, for messages."""
    return "None" if value is None else f"of type {type(value).__name__}"
