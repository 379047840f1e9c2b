#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tables of the documentation, held against what they tell of: the includes of each room against the table of rooms in
CONTRIBUTING.md, and the list of components against README's table of them.

usage: rooms_test.py PROJECT
"""

import pathlib
import re
import sys

ROW = re.compile(r"^\| `(?P<room>[a-z]+)` \|.*\| (?P<uses>[^|]*) \|$", re.MULTILINE)
INCLUDE = re.compile(r'^#include "(?:gridmerge/)?([a-z]+)/', re.MULTILINE)
COMPONENT = re.compile(r"^\| `(?P<component>[a-z]+)` \|[^|]*\|(?P<needs>[^|]*)\|$", re.MULTILINE)
NEEDS = re.compile(r"^set\(gridmerge_([a-z]+)_needs([a-z ]*)\)", re.MULTILINE)


def named_in(cell: str) -> set[str]:
    """The rooms or components that a table's cell names."""
    return set(re.findall(r"`([a-z]+)`", cell))


def faults_of_rooms(project: pathlib.Path) -> list[str]:
    rooms = {path.name for path in (project / "src").iterdir() if path.is_dir()}
    rows = ROW.findall((project / "CONTRIBUTING.md").read_text())
    told = {room: named_in(uses) for room, uses in rows if room in rooms}
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
    return faults


def all_needs(component: str, needs: dict[str, set[str]]) -> set[str]:
    """What a component needs, and what that needs."""
    direct = needs.get(component, set())
    return direct.union(*(all_needs(other, needs) for other in direct))


def faults_of_components(project: pathlib.Path) -> list[str]:
    listed = (project / "cmake" / "GridmergeComponents.cmake").read_text()
    needs = {component: set(others.split()) for component, others in NEEDS.findall(listed)}
    rows = COMPONENT.findall((project / "README.md").read_text())
    told = {component: named_in(others) for component, others in rows}
    faults = [f"README's table of components lacks {one}" for one in sorted(needs.keys() - told.keys())]
    faults += [
        f"README's table has the component {one}, which is none" for one in sorted(told.keys() - needs.keys())
    ]
    for component in sorted(told.keys() & needs.keys()):
        if all_needs(component, told) != all_needs(component, needs):
            faults.append(
                f"README says other needs of {component} than {sorted(all_needs(component, needs))}"
            )
    return faults


def main() -> None:
    project = pathlib.Path(sys.argv[1])
    faults = faults_of_rooms(project) + faults_of_components(project)
    sys.exit("\n".join(faults) if faults else 0)


if __name__ == "__main__":
    main()
