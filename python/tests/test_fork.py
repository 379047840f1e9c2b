# SPDX-License-Identifier: Apache-2.0
"""A process that is forked has none of the threads that were at work: it ends all the same, or says so."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

START = """
import os, sys, threading, time
import gridmerge
maps = sys.argv[1:]

def wait_for(child):
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
"""

FORKED = {
    # Another thread is at work.
    "while a thread matches": """
begun = threading.Event()
def work():
    for _ in range(20):
        gridmerge.match(maps[0], maps[1], progress=lambda share: begun.set())
threading.Thread(target=work, daemon=True).start()
begun.wait()
child = os.fork()
if child == 0:
    sys.exit(7)
print(wait_for(child))
""",
    "beside a team": """
team = gridmerge.Team()
team.hear("a", maps[0])
child = os.fork()
if child == 0:
    try:
        team.answer()
    except RuntimeError as error:
        assert "forked" in str(error), error
        del team
        sys.exit(7)
print(wait_for(child))
assert team.wait_until_settled()
""",
    # The copy of the thread that waits for the work goes on in its progress function.
    "in a progress function": """
class Enough(Exception):
    pass
def fork(share):
    global child
    child = os.fork()
    if child:
        raise Enough
    # What the worker's thread has left may be used again.
    threading.Thread(target=print, args=("started", )).start()
    assert gridmerge.match(maps[0], maps[1], threads=2).accepted
try:
    gridmerge.simulate("office", size=(200, 150), robots=8, overlap=0.4, progress=fork)
except RuntimeError as error:
    assert child == 0 and "forked" in str(error), error
    sys.exit(7)
except Enough:
    print(wait_for(child))
""",
    "to work in it": """
gridmerge.match(maps[0], maps[1])
child = os.fork()
if child == 0:
    result = gridmerge.match(maps[0], maps[1])
    team = gridmerge.Team()
    team.hear("a", maps[0])
    sys.exit(7 if result.accepted and team.wait_until_settled() else 1)
print(wait_for(child))
""",
}


@pytest.mark.parametrize("way", FORKED)
def test_a_forked_process_ends(way: str, robots: list[str]) -> None:
    done = subprocess.run(
        [sys.executable, "-c", START + FORKED[way], *robots],
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert done.stdout.removeprefix("started\n") == "7\n", done.stderr
    assert done.returncode == 0, done.stderr


def test_a_table_that_comes_slowly_holds_no_thread_up(robots: list[str], tmp_path: Path) -> None:
    program = """
import os, sys, threading, time
import gridmerge
pipe, *maps = sys.argv[1:]
os.mkfifo(pipe)
def write():
    time.sleep(0.2)
    with open(pipe, "w") as table:
        table.write("map\\tx\\ty\\ttheta\\n" + maps[0] + "\\t0\\t0\\t0\\n")
threading.Thread(target=write).start()
print(len(gridmerge.merge(maps, init=pipe).components))
"""
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "init.tsv"), *robots[:2]],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert (done.stdout, done.returncode) == ("1\n", 0), done.stderr
