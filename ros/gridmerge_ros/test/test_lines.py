# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest
from gridmerge_ros import lines as lines_module
from gridmerge_ros.lines import MOST_KINDS, WINDOW, Lines


def test_a_few_of_each_kind_in_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0
    monkeypatch.setattr(lines_module, "monotonic", lambda: now)
    written: list[str] = []
    lines = Lines(written.append)
    for number in range(50):
        lines("anew tb1", f"tb1: started anew: {number} x 3 cells")
    for _ in range(2):
        lines("joined tb3", "tb3 joined tb1, tb2")
    assert written == [
        "tb1: started anew: 0 x 3 cells",
        "tb1: started anew: 1 x 3 cells",
        "tb1: started anew: 2 x 3 cells",
        "tb3 joined tb1, tb2",
        "tb3 joined tb1, tb2",
    ]
    written.clear()
    now = WINDOW - 1.0
    lines.look()
    assert written == []
    now = WINDOW
    lines.look()
    assert written == ["tb1: started anew: 49 x 3 cells (47 more like it in 60 s)"]
    written.clear()
    # It goes on, less often.
    lines("anew tb1", "tb1: started anew: 7 x 3 cells")
    assert written == []
    now = 2 * WINDOW
    lines.look()
    assert written == ["tb1: started anew: 7 x 3 cells (1 more like it in 60 s)"]
    written.clear()
    # What has not come for a minute is new.
    now = 3 * WINDOW
    lines("anew tb1", "tb1: started anew: 8 x 3 cells")
    assert written == ["tb1: started anew: 8 x 3 cells"]


def test_lines_that_differ_in_numbers_are_of_one_kind() -> None:
    written: list[str] = []
    lines = Lines(written.append)
    for probability in range(100):
        lines("joined tb3", f"tb3 joined tb1 (probability 0.{probability:02})")
    assert len(written) == 3


def test_so_many_kinds_are_told_apart() -> None:
    written: list[str] = []
    lines = Lines(written.append)
    for number in range(MOST_KINDS + 100):
        lines(f"first map {number}", "a line")
    assert len(written) == MOST_KINDS + 3
