# SPDX-License-Identifier: Apache-2.0
"""The tutorial: its code runs from top to bottom, and prints what stands below it."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT, THREE_ROBOTS

BLOCKS = re.compile(r"^```python\n(.*?)^```\n(?:^```text\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL)


def test_the_code_prints_what_stands_below_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(THREE_ROBOTS, tmp_path / "floor")
    monkeypatch.chdir(tmp_path / "floor")
    blocks = BLOCKS.findall((ROOT / "docs" / "tutorials" / "python.md").read_text())
    assert len(blocks) >= 7
    names: dict[str, Any] = {}
    for code, printed in blocks:
        exec(code, names)
        assert capsys.readouterr().out == printed
    assert (tmp_path / "floor" / "floor.pgm").exists()
    assert (tmp_path / "floor" / "merged" / "report.html").exists()
