# SPDX-License-Identifier: Apache-2.0
"""Shared libraries show what public headers declare, what another component needs, and nothing else.

What the headers declare is known by the objects: names in the namespace gridmerge, members of its
classes, and the type information of its exceptions. All else belongs into gridmerge::internal.
"""

import argparse
import re
import subprocess
import sys

CALLABLE = r"(?:~?\w+|operator\(\)|operator[^\s\w(]+)"
PUBLIC = re.compile(
    rf"(?:(?:typeinfo|typeinfo name|vtable) for )?gridmerge::(?!internal::)(?:\w+::)?{CALLABLE}"
)
INTERNAL = re.compile(rf"(?:(?:typeinfo|typeinfo name|vtable) for )?gridmerge::internal::{CALLABLE}")

# What the component dds shows to take the place of Cyclone DDS's own (src/dds/participant.cpp).
REPLACED = {"ddsi_tl_handle_request", "ddsi_tl_handle_reply"}


def symbols(nm: str, file: str, *options: str) -> set[tuple[str, str]]:
    """The external symbols of a file: (letter of their kind, demangled name)."""
    listing = subprocess.run([nm, "-C", *options, file], check=True, capture_output=True, text=True).stdout
    found = re.findall(r"^[0-9a-f ]{16} (\w) (.*)$", listing, re.MULTILINE)
    return {(kind, name) for kind, name in found if kind.isupper() or kind in "iuvw"}


def subject(name: str) -> str:
    """What a name is without its arguments: `gridmerge::Merger::add` of `gridmerge::Merger::add(...)`."""
    call = re.match(r"(.*?operator\(\)|[^(]*)", name.replace("[abi:cxx11]", ""))
    assert call is not None
    return call[1]


def belongs_to(name: str) -> str:
    """The class or function of gridmerge::internal that has to be marked for a symbol."""
    found = re.search(r"gridmerge::internal::(\w+)", name)
    return found[1] if found else name


def check(nm: str, libraries: dict[str, str], archives: dict[str, str], programs: list[str]) -> list[str]:
    """What is wrong, a sentence each."""
    shown = {
        component: {name for _, name in symbols(nm, file, "-D", "--defined-only")}
        for component, file in libraries.items()
    }
    needed = {
        file: {name for _, name in symbols(nm, file, "-D", "--undefined-only")}
        for file in [*libraries.values(), *programs]
    }
    wanted = {belongs_to(name) for names in needed.values() for name in names if INTERNAL.match(name)}
    wrong = []
    for component, archive in archives.items():
        defined = {
            name
            for kind, name in symbols(nm, archive, "--defined-only")
            if kind in "TBDRV" and PUBLIC.fullmatch(subject(name))
        }
        if not defined:
            wrong.append(f"{component} has no public name")
        wrong += [
            f"{component} hides {name}: mark it with GRIDMERGE_EXPORT, or put it into gridmerge::internal"
            for name in sorted(defined - shown[component])
        ]
        for name in sorted(shown[component] - defined - REPLACED):
            if PUBLIC.fullmatch(subject(name)):
                continue  # an inline member of a public class
            if not INTERNAL.match(name):
                wrong.append(f"{component} shows {name}: it is neither public nor gridmerge::internal")
            elif belongs_to(name) not in wanted:
                wrong.append(
                    f"{component} shows {name}, which nothing else needs: take GRIDMERGE_INTERNAL_EXPORT away"
                )
        print(f"{component}: {len(defined)} public symbols, {len(shown[component] - defined)} others")
    return wrong


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nm", required=True, help="binutils' nm or LLVM's")
    parser.add_argument(
        "--component",
        nargs=3,
        action="append",
        required=True,
        metavar=("NAME", "LIBRARY", "ARCHIVE"),
        help="the shared library and an archive of the same objects",
    )
    parser.add_argument(
        "--program", action="append", default=[], help="a program of the project that links shared libraries"
    )
    arguments = parser.parse_args()
    libraries = {name: library for name, library, _ in arguments.component}
    archives = {name: archive for name, _, archive in arguments.component}
    wrong = check(arguments.nm, libraries, archives, arguments.program)
    print("\n".join(wrong), file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
