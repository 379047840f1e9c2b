# SPDX-License-Identifier: Apache-2.0
"""A log that nobody can flood."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import monotonic

WINDOW = 60.0
"""Of lines of one kind the first is written, and how many followed in so long [s]."""


@dataclass(slots=True)
class _Kind:
    since: float
    more: int = 0
    last: str = ""


class Lines:
    """Writes lines for people, each kind once a minute.

    Lines that begin alike, up to the second colon, are of one kind: "tb1: started anew: ...".
    """

    def __init__(self, write: Callable[[str], None]) -> None:
        self._write = write
        self._kinds: dict[str, _Kind] = {}

    def __call__(self, line: str) -> None:
        self.look()
        kind = ":".join(line.split(":", 2)[:2])
        before = self._kinds.get(kind)
        if before is None:
            self._kinds[kind] = _Kind(monotonic())
            self._write(line)
        else:
            before.more += 1
            before.last = line

    def look(self) -> None:
        """Tells of what was held back, once its minute is over."""
        now = monotonic()
        for name, kind in list(self._kinds.items()):
            if now < kind.since + WINDOW:
                continue
            if kind.more == 0:
                del self._kinds[name]
                continue
            more = f"{kind.more} more like it in {WINDOW:.0f} s" if kind.more > 1 else "once more"
            self._kinds[name] = _Kind(now)
            self._write(f"{kind.last} ({more})")
