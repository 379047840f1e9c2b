# SPDX-License-Identifier: Apache-2.0
"""What notebooks show of maps and merges. Needs numpy alone."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import _arguments

if TYPE_CHECKING:
    from ._grid import OccupancyGrid
    from ._merge_result import MergeResult

_MOST_PIXELS = 600  # per side
_COLOURS = bytes((221, 221, 217, 255, 255, 255, 32, 32, 36))  # unknown, free, occupied: those of preview.png


def grid_html(grid: OccupancyGrid) -> str:
    cells = _reduced(grid.cells)
    side = max(1, _MOST_PIXELS // (2 * max(cells.shape)))
    return _figure(repr(grid), _palette_png(cells[::-1]), cells.shape[1] * side)


def merge_html(result: MergeResult) -> str:
    names = [_arguments.to_bytes(name) for name in result.names]
    return _figure(repr(result), result._core.preview(names), _MOST_PIXELS)


def _figure(caption: str, png: bytes, width: int) -> str:
    encoded = base64.b64encode(png).decode("ascii")
    return (
        f"<div>{html.escape(caption)}</div>"
        f'<img src="data:image/png;base64,{encoded}" alt="" '
        f'style="width: {width}px; max-width: 100%; image-rendering: pixelated">'
    )


def _reduced(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """At most so many pixels per side: occupied wins over free, and free over unknown, so that no wall is lost."""
    step = -(-max(cells.shape) // _MOST_PIXELS)
    if step == 1:
        return cells
    height, width = (-(-side // step) for side in cells.shape)
    padded = np.zeros((height * step, width * step), dtype=np.uint8)
    padded[: cells.shape[0], : cells.shape[1]] = cells
    reduced: NDArray[np.uint8] = padded.reshape(height, step, width, step).max(axis=(1, 3))
    return reduced


def _palette_png(rows: NDArray[np.uint8]) -> bytes:
    """A PNG (ISO/IEC 15948) of indices of colours, top row first."""
    height, width = rows.shape
    lines = np.zeros((height, width + 1), dtype=np.uint8)  # each line begins with its filter: none
    lines[:, 1:] = rows
    chunks = (
        (b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)),
        (b"PLTE", _COLOURS),
        (b"IDAT", zlib.compress(lines.tobytes())),
        (b"IEND", b""),
    )
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )
