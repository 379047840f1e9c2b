# SPDX-License-Identifier: Apache-2.0
"""What a prompt and a notebook show."""

from __future__ import annotations

import base64
import dataclasses
import html
import re
import struct
import zlib
from pathlib import Path
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import values_in
from numpy.typing import NDArray

UNKNOWN, FREE, WALL = (221, 221, 217), (255, 255, 255), (32, 32, 36)


def test_every_result_is_a_line_that_names_its_class(results: list[Any]) -> None:
    seen = set()
    for value in values_in(tuple(results)):
        text = repr(value)
        seen.add(type(value).__name__)
        assert text.startswith(type(value).__name__ + "("), text
        assert len(text) <= 330, text
        assert "\n" not in text
        assert " at 0x" not in text
    classes = {name for name in gridmerge.__all__ if isinstance(getattr(gridmerge, name), type)}
    no_results = {
        *("CacheWarning", "ExecutorError", "FileError", "MapWarning"),
        *("OccupancyGridMessage", "PairPose"),
    }
    assert classes - seen == no_results


def test_what_they_say(results: list[Any]) -> None:
    match, merged, *_ = results
    assert re.fullmatch(
        r"MatchResult\(accepted, transform=\(-6\.798, -21\.877, 1\.4398\), probability>0\.999, overlap=0\.48, "
        r"hypotheses: \d+\)",
        repr(match),
    )
    assert repr(merged).startswith("MergeResult(3 of 4 maps in 1 component; left out: ")
    assert repr(merged.components[0]).startswith(
        "Component(3 maps: 'robot_1.yaml', 'robot_2.yaml', 'robot_3.yaml'; "
    )
    left_out = merged.left_out[0]
    assert left_out.explanation
    assert repr(left_out).endswith(f"elsewhere.yaml': {left_out.explanation})")


@pytest.mark.parametrize(
    ("value", "shown"),
    [(0.94999, "0.949"), (0.57, "0.570"), (0.9985, "0.998"), (1.0, "1.000"), (0.0, "0.000")],
)
def test_probabilities_are_rounded_down(value: float, shown: str, robots: list[str]) -> None:
    pose = dataclasses.replace(gridmerge.match(robots[0], robots[1]), probability=value)
    assert f"probability={shown}" in repr(pose)


def test_names_are_kept_to_themselves_and_short() -> None:
    name = "\x1b[2J\n" + "long/" * 100 + "map.yaml"
    grid = gridmerge.OccupancyGrid(np.zeros((4, 4), dtype=np.int8), 0.05)
    result = gridmerge.merge([grid] * 3, names=[name, "<script>", "'\""])
    for text in (repr(result), repr(result.left_out), repr(result.components)):
        assert "\x1b" not in text
        assert "\n" not in text
        assert len(text) < 600
    assert "<script>" not in result._repr_html_()


def pixels(png: bytes) -> NDArray[np.uint8]:
    """Of a PNG with a palette and no filters: RGB, top row first."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    chunks, at = {}, 8
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        data = png[at + 8 : at + 8 + length]
        assert struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0] == zlib.crc32(kind + data)
        chunks[kind] = data
        at += 12 + length
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), dtype=np.uint8).reshape(height, width + 1)
    assert not rows[:, 0].any()
    colours = np.frombuffer(chunks[b"PLTE"], dtype=np.uint8).reshape(-1, 3)
    shown: NDArray[np.uint8] = colours[rows[:, 1:]]
    return shown


def picture_in(text: str) -> bytes:
    found = re.search(r'<img src="data:image/png;base64,([A-Za-z0-9+/=]+)"', text)
    assert found
    return base64.b64decode(found[1])


def test_a_notebook_shows_a_grid() -> None:
    data = np.array([[100, 0, -1], [-1, 0, 0]], dtype=np.int8)  # the wall is at the bottom left
    text = gridmerge.OccupancyGrid(data, 0.05)._repr_html_()
    assert "3 x 2 cells" in text
    shown = pixels(picture_in(text))
    assert [tuple(pixel) for pixel in shown[1]] == [WALL, FREE, UNKNOWN]
    assert [tuple(pixel) for pixel in shown[0]] == [UNKNOWN, FREE, FREE]


def test_large_grids_are_reduced_and_keep_their_walls() -> None:
    data = np.zeros((1900, 2500), dtype=np.int8)
    data[:, 1234] = 100
    data[-1, -1] = 100
    shown = pixels(picture_in(gridmerge.OccupancyGrid(data, 0.05)._repr_html_()))
    assert max(shown.shape) <= 600
    walls = (shown == WALL).all(axis=2)
    assert walls.any(axis=1).all()
    assert walls[0, -1]
    assert walls.sum() == shown.shape[0] + 1


def test_a_notebook_shows_a_merge_as_its_preview(robots: list[str], tmp_path: Path) -> None:
    result = gridmerge.merge(robots[:2])
    text = result._repr_html_()
    assert html.escape(repr(result)) in text
    result.save(tmp_path)
    assert picture_in(text) == (tmp_path / "preview.png").read_bytes()
    assert result.components[0]._repr_html_() == result.components[0].grid._repr_html_()
