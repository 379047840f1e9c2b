#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Changes the code of a room in one small place at a time and says which changes its tests notice.

A change is an operator that becomes another one, a condition that is negated, a number that becomes another one, or a
statement that is left out. They are drawn at random with a fixed seed; a longer run goes on where a shorter one ended.
What does not compile, and what leaves the object file as it was, is no change. The sources that are changed are a copy
in the build folder, where no real maps are beside the project.
"""

import argparse
import collections
import dataclasses
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

PROJECT = pathlib.Path(__file__).resolve().parent.parent

# What one operator becomes; clang-format puts spaces around binary ones, and around no other.
OPERATORS = {
    "<": ("<=", ">"), "<=": ("<", ">"), ">": (">=", "<"), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "+": ("-",), "-": ("+",), "*": ("/",), "/": ("*",), "+=": ("-=",), "-=": ("+=",), "*=": ("/=",), "/=": ("*=",),
    "&&": ("||",), "||": ("&&",),
}  # fmt: skip
ANY_OPERATOR = "|".join(map(re.escape, sorted(OPERATORS, key=len, reverse=True)))
OPERATOR = re.compile(rf"(?<=[\w)\]] )({ANY_OPERATOR})(?=\s)")
CONDITION = re.compile(r"\b(?:if|while) \(")
NUMBER = re.compile(r"(?<![\w.'\"])(\d+(?:\.\d*)?(?:e-?\d+)?)(?=f?\b)(?![\w.']*['\"x])")
WORD = re.compile(r"\b(true|false|std::min|std::max|std::floor|std::ceil)\b(?! *<)")
WORDS = {
    "true": "false", "false": "true", "std::min": "std::max", "std::max": "std::min",
    "std::floor": "std::ceil", "std::ceil": "std::floor",
}  # fmt: skip
# An assignment or a call on a line of its own.
STATEMENT = re.compile(
    r"^\s+(?!return\b|throw\b|else\b|break;|case\b|using\b)"
    r"(?:[\w.\->:]+(?:\[[^]]*\])?(?: [-+*/|&]?= .*|\(.*\))|\+\+[\w.]+);$"
)


@dataclasses.dataclass(frozen=True)
class Change:
    path: str
    start: int  # offset in the file
    end: int
    text: str  # what stands there instead


def without_words(source):
    """The source with comments, texts, characters and directives blanked out, each character where it was."""
    pattern = r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\])\'|^#[^\n]*'
    return re.sub(pattern, lambda m: re.sub(r"[^\n]", " ", m[0]), source, flags=re.S | re.M)


def closing(code, start):
    """The place of the bracket that closes the one at `start`."""
    depth = 0
    for i in range(start, len(code)):
        depth += (code[i] == "(") - (code[i] == ")")
        if depth == 0:
            return i
    raise ValueError("a bracket that nothing closes")


def changes_of(path, source):
    code = without_words(source)
    for found in OPERATOR.finditer(code):
        for other in OPERATORS[found[0]]:
            yield Change(path, *found.span(), other)
    for found in CONDITION.finditer(code):
        start, end = found.end(), closing(code, found.end() - 1)
        if ";" not in code[start:end]:
            yield Change(path, start, end, f"!({source[start:end]})")
    for found in NUMBER.finditer(code):
        number = found[0]
        other = (
            str(int(number) + 1) if number.isdigit() else "1.0" if float(number) == 0 else f"{number} * 1.5"
        )
        yield Change(path, *found.span(), other)
    for found in WORD.finditer(code):
        yield Change(path, *found.span(), WORDS[found[0]])
    start = 0
    before = ";"
    for line in code.splitlines(keepends=True):
        if STATEMENT.match(line.rstrip("\n")) and before[-1] in ";{}:)":
            yield Change(path, start + len(line) - len(line.lstrip()), start + len(line.rstrip()), ";")
        before = line.strip() or before
        start += len(line)


class Room:
    """A copy of the project, built, in which a room is changed."""

    def __init__(self, name, folder, jobs, longest):
        self.name = name
        self.copy = folder / "source"
        self.build = folder / "build"
        self.target = f"gridmerge_{name}_test"
        self.sources = sources_of(name)
        self.jobs = jobs
        listed = subprocess.run(
            ["git", "ls-files", "-z", "-co", "--exclude-standard"],
            cwd=PROJECT,
            check=True,
            capture_output=True,
        )
        wanted = {file for file in listed.stdout.decode().split("\0") if file and (PROJECT / file).is_file()}
        for file in wanted:
            target = self.copy / file
            if not target.exists() or target.read_bytes() != (PROJECT / file).read_bytes():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(PROJECT / file, target)
        for file in self.copy.rglob("*"):
            if file.is_file() and str(file.relative_to(self.copy)) not in wanted:
                file.unlink()
        configure = ["cmake", "-S", self.copy, "-B", self.build, "-G", "Ninja", "--log-level=WARNING"]
        configure += ["-DCMAKE_BUILD_TYPE=None", "-DCMAKE_CXX_FLAGS=-O1 -w"]
        configure += [
            "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST"
        ]  # a changed program may never end
        subprocess.run(configure, check=True, stdout=subprocess.DEVNULL)
        self.ninja(self.target, check=True)
        self.time_tests(longest)

    def ninja(self, *arguments, check=False):
        done = subprocess.run(
            ["ninja", "-C", self.build, "-j", str(self.jobs), *arguments], capture_output=True, text=True
        )
        if check and done.returncode != 0:
            sys.exit(done.stdout)
        return done.returncode == 0

    def run(self, *arguments, limit=None):
        """ "passed", "failed" or "ran away": then they are ended, with what they started."""
        command = [self.build / "bin" / self.target, *arguments]
        nowhere = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        with subprocess.Popen(command, cwd=self.copy, start_new_session=True, **nowhere) as tests:
            try:
                return "passed" if tests.wait(limit) == 0 else "failed"
            except subprocess.TimeoutExpired:
                os.killpg(tests.pid, signal.SIGKILL)
                return "ran away"

    def time_tests(self, longest):
        """Quick tests are to run first: one of them mostly notices a change. Slow ones may be left out."""
        told, kept = self.build / "tests.json", self.build / f"times-{self.name}.json"
        earlier = json.loads(kept.read_text()) if kept.exists() else {}
        times = {name: seconds for name, seconds in earlier.items() if seconds > longest}
        slow = ":".join(times)
        start = time.monotonic()
        if self.run(f"--gtest_output=json:{told}", f"--gtest_filter=-{slow}") != "passed":
            sys.exit(f"{self.target} fails without a change")
        seconds_of_all = time.monotonic() - start
        for suite in json.loads(told.read_text())["testsuites"]:
            for test in suite["testsuite"]:
                times[f"{suite['name']}.{test['name']}"] = float(test["time"].rstrip("s"))
        kept.write_text(json.dumps(times))
        quick = {name: seconds for name, seconds in times.items() if seconds < min(0.5, longest)}
        self.quick = ":".join(quick)
        self.slow = ":".join(name for name, seconds in times.items() if seconds > longest)
        # What runs five times as long will hardly end.
        self.limits = (30 + 5 * sum(quick.values()), 30 + 5 * seconds_of_all)

    def object_of(self, path):
        listed_in = "src" if self.sources.startswith("src/") else self.sources  # where CMakeLists.txt is
        (found,) = self.build.glob(f"{listed_in}/CMakeFiles/*/{pathlib.Path(path).relative_to(listed_in)}.o")
        return found

    def try_change(self, change):
        """ "no change", "failed" or "ran away" (noticed both), or "passed"."""
        file = self.copy / change.path
        source = file.read_text()
        compiled = self.object_of(change.path)
        before = compiled.read_bytes()
        file.write_text(source[: change.start] + change.text + source[change.end :])
        try:
            if not self.ninja(str(compiled.relative_to(self.build))) or compiled.read_bytes() == before:
                return "no change"
            if not self.ninja(self.target):
                return "no change"
            for tests, limit in zip((self.quick, f"-{self.quick}:{self.slow}"), self.limits, strict=True):
                result = self.run("--gtest_fail_fast", f"--gtest_filter={tests}", limit=limit)
                if result != "passed":
                    return result
            return "passed"
        finally:
            file.write_text(source)
            self.ninja(str(compiled.relative_to(self.build)), check=True)

    def check_unchanged(self):
        """What fails at the end without a change, too, would have counted as noticing each change."""
        self.ninja(self.target, check=True)
        if self.run(f"--gtest_filter=-{self.slow}", limit=self.limits[1]) != "passed":
            sys.exit(f"{self.target} fails without a change at the end: the share above is worth nothing")

    def changes(self, seed):
        found = []
        for file in sorted((self.copy / self.sources).rglob("*.cpp")):
            found += changes_of(str(file.relative_to(self.copy)), file.read_text())
        random.Random(seed).shuffle(found)
        return found

    def describe(self, change):
        source = (self.copy / change.path).read_text()
        number = source.count("\n", 0, change.start) + 1
        start, end = source.rfind("\n", 0, change.start) + 1, source.find("\n", change.end)
        changed = f"[{source[change.start : change.end]} -> {change.text}]"
        line = source[start : change.start] + changed + source[change.end : end]
        return f"{change.path}:{number}: {' '.join(line.split())}"


def sources_of(room):
    """The folder of the code that the tests in tests/`room` are for."""
    return "apps/gridmerge" if room == "cli" else f"src/{room}"


def rooms_with_tests():
    rooms = (tests.parent.name for tests in PROJECT.glob("tests/*/CMakeLists.txt"))
    return sorted(room for room in rooms if (PROJECT / sources_of(room)).is_dir())


def measure(room, seconds, seed):
    counts = collections.Counter()
    end = time.monotonic() + seconds
    print(f"{room.name}: one change at a time for {seconds} seconds", flush=True)
    for change in room.changes(seed):
        if time.monotonic() >= end:
            break
        result = room.try_change(change)
        counts[result] += 1
        if result == "passed":
            print(f"  not noticed: {room.describe(change)}", flush=True)
        if result == "ran away":
            print(f"  ran away: {room.describe(change)}", flush=True)
    noticed = counts["failed"] + counts["ran away"]
    tried = noticed + counts["passed"]
    share = f"{100 * noticed / tried:.0f} %" if tried else "none tried"
    print(f"{room.name}: noticed {noticed} of {tried} ({share})", flush=True)
    print(f"  {counts['ran away']} of them because the tests did not end", flush=True)
    print(f"  and {counts['no change']} that did not compile or changed nothing", flush=True)
    room.check_unchanged()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "rooms",
        metavar="ROOM",
        nargs="*",
        help="of src/, or cli: apps/gridmerge; all that have tests if none is given",
    )
    parser.add_argument(
        "--seconds", type=int, default=600, help="for each room, after its build (default: %(default)s)"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="of the order of the changes (default: %(default)s)"
    )
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the build (default: one a core)")
    parser.add_argument(
        "--longest",
        metavar="SECONDS",
        type=float,
        default=math.inf,
        help="leave out tests that took longer in an earlier run here: the share is a lower bound then",
    )
    parser.add_argument(
        "--folder",
        type=pathlib.Path,
        default=PROJECT / "build/mutate",
        help="where the copy is built (default: build/mutate)",
    )
    arguments = parser.parse_args()
    known = rooms_with_tests()
    for name in arguments.rooms:
        if name not in known:
            parser.error(f"there is no room '{name}' with tests, but: {' '.join(known)}")
    for name in arguments.rooms or known:
        room = Room(name, arguments.folder.resolve(), arguments.jobs, arguments.longest)
        measure(room, arguments.seconds, arguments.seed)


if __name__ == "__main__":
    main()
