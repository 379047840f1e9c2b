# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest
from gridmerge_ros import lines as lines_module
from gridmerge_ros.lines import WINDOW, Lines


def test_each_kind_once_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 0.0
    monkeypatch.setattr(lines_module, "monotonic", lambda: now)
    written: list[str] = []
    lines = Lines(written.append)
    for number in range(50):
        lines(f"tb1: started anew: {number} x 3 cells")
        lines("tb2: first map: in its frame")
    lines("tb3 joined tb1, tb2")
    assert written == [
        "tb1: started anew: 0 x 3 cells",
        "tb2: first map: in its frame",
        "tb3 joined tb1, tb2",
    ]
    written.clear()
    now = WINDOW - 1.0
    lines.look()
    assert written == []
    now = WINDOW
    lines.look()
    assert written == [
        "tb1: started anew: 49 x 3 cells (49 more like it in 60 s)",
        "tb2: first map: in its frame (49 more like it in 60 s)",
    ]
    written.clear()
    # It goes on, less often.
    lines("tb1: started anew: 7 x 3 cells")
    now = 2 * WINDOW
    lines.look()
    assert written == ["tb1: started anew: 7 x 3 cells (once more)"]
    written.clear()
    # What has not come for a minute is new.
    now = 3 * WINDOW
    lines("tb2: first map: again")
    assert written == ["tb2: first map: again"]
