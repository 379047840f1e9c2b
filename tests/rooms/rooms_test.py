#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The table of rooms in CONTRIBUTING.md says of each room which others it may use: holds the includes against it.

usage: rooms_test.py PROJECT
"""

import pathlib
import re
import sys

ROW = re.compile(r"^\| `(?P<room>[a-z]+)` \|.*\| (?P<uses>[^|]*) \|$", re.MULTILINE)
INCLUDE = re.compile(r'^#include "(?:gridmerge/)?([a-z]+)/', re.MULTILINE)


def main() -> None:
    project = pathlib.Path(sys.argv[1])
    rooms = {path.name for path in (project / "src").iterdir() if path.is_dir()}
    rows = ROW.findall((project / "CONTRIBUTING.md").read_text())
    told = {room: set(re.findall(r"`([a-z]+)`", uses)) for room, uses in rows if room in rooms}
    faults = [f"{room}: is not in the table" for room in sorted(rooms - told.keys())]
    for room in sorted(told):
        used = set()
        for folder in (project / "src" / room, project / "include" / "gridmerge" / room):
            for path in sorted(folder.rglob("*.[ch]pp")):
                for other in set(INCLUDE.findall(path.read_text())) & rooms - told[room] - {room}:
                    faults.append(f"{path.relative_to(project)}: includes {other}, which {room} may not use")
                used |= set(INCLUDE.findall(path.read_text()))
        faults += [f"{room}: may use {other}, and does not" for other in sorted(told[room] - used)]
        faults += [
            f"{room} and {other}: each may use the other" for other in told[room] if room in told[other]
        ]
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
