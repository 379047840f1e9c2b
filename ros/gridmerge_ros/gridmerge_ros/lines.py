# SPDX-License-Identifier: Apache-2.0
"""A log that nobody can flood."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic

WINDOW, MOST = 60.0, 3
"""So many lines of one kind are written in so long [s], and how many more there were."""

MOST_KINDS = 1024
"""Further kinds count as one."""


@dataclass(slots=True)
class _Kind:
    since: float
    lines: int = 0
    last: str = ""


class Lines:
    """Writes lines for people, a few of each kind in a minute: what peers do decides how many there are."""

    def __init__(self, write: Callable[[str], None]) -> None:
        self._write = write
        self._kinds: dict[str, _Kind] = {}

    def __call__(self, kind: str, line: str) -> None:
        """A line; `kind` is the same for lines that differ in numbers alone."""
        self.look()
        if kind not in self._kinds and len(self._kinds) >= MOST_KINDS:
            kind = ""
        seen = self._kinds.setdefault(kind, _Kind(monotonic()))
        seen.lines += 1
        seen.last = line
        if seen.lines <= MOST:
            self._write(line)

    def look(self) -> None:
        """Tells of what was held back, once its minute is over."""
        now = monotonic()
        for name, kind in list(self._kinds.items()):
            if now < kind.since + WINDOW:
                continue
            del self._kinds[name]
            if kind.lines <= MOST:
                continue
            # It may go on: then a line a minute is enough.
            self._kinds[name] = _Kind(now, MOST)
            self._write(f"{kind.last} ({kind.lines - MOST} more like it in {WINDOW:.0f} s)")
