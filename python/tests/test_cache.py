# SPDX-License-Identifier: Apache-2.0
"""Matches that are kept on disk: made once, whoever asks, and shared with the command line."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import gridmerge
import pytest
from conftest import Cli
from gridmerge import _executor


class Counting(Executor):
    """Runs each task at once, and counts its matches; ends the program's work after so many."""

    def __init__(self, most: int = 10**9) -> None:
        self.matches = 0
        self._most = most

    def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        if self.matches >= self._most:
            raise KeyboardInterrupt
        self.matches += len(args[3])
        future: Future[Any] = Future()
        future.set_result(task(*args, **kwargs))
        return future


def matches_in(folder: Path) -> set[Path]:
    return set(folder.rglob("*.match"))


def texts_of(result: gridmerge.MergeResult, folder: Path) -> tuple[bytes, bytes]:
    result.save(folder)
    return (folder / "transforms.json").read_bytes(), (folder / "merged.pgm").read_bytes()


def without_times(json: str) -> str:
    return re.sub(r'"(seconds|median|p90|max)": *[0-9.e+-]+', "", json)


@pytest.fixture(scope="module")
def four(robots: list[str], elsewhere: str) -> list[str]:
    return [*robots, elsewhere]


@pytest.fixture
def tables(team_folder: Path) -> dict[str, Any]:
    return {name: team_folder / f"{name}.tsv" for name in ("pairs", "negatives", "sets")}


def merged_with(how: str, four: list[str], folder: Path, progress: Any = None) -> gridmerge.MergeResult:
    if how == "executor":
        with ThreadPoolExecutor(2) as executor:
            return gridmerge.merge(four, cache=folder, executor=executor, progress=progress)
    if how == "merger":
        merger = gridmerge.Merger()
        for path in four:
            merger.add(path)
        return merger.solve(cache=folder, progress=progress)
    return gridmerge.merge(four, cache=folder, progress=progress)


@pytest.mark.parametrize("how", ["here", "executor", "merger"])
def test_a_second_run_makes_no_match_and_the_answer_is_the_same(
    how: str, four: list[str], tmp_path: Path
) -> None:
    folder = tmp_path / "matches" / "deeper"
    expected = texts_of(gridmerge.merge(four), tmp_path / "plain")
    assert texts_of(merged_with(how, four, folder), tmp_path / "first") == expected
    kept = matches_in(folder)
    assert len(kept) == 9  # six pairs, and three of the map that is elsewhere again
    written = {path: path.stat().st_mtime_ns for path in kept}
    for again in ("here", "executor", "merger"):
        assert texts_of(merged_with(again, four, folder), tmp_path / again) == expected
    counting = Counting()
    assert texts_of(gridmerge.merge(four, cache=folder, executor=counting), tmp_path / "none") == expected
    assert counting.matches == 0
    assert {path: path.stat().st_mtime_ns for path in matches_in(folder)} == written


def test_a_merge_that_was_ended_goes_on(
    four: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_executor, "TASK_SECONDS", 1e-9)
    monkeypatch.setattr(_executor, "_MOST_WAITING", 1)
    with pytest.raises(KeyboardInterrupt):
        gridmerge.merge(four, cache=tmp_path, executor=Counting(4))
    assert len(matches_in(tmp_path)) == 4
    rest = Counting()
    gridmerge.merge(four, cache=tmp_path, executor=rest)
    assert rest.matches == 5


def test_other_options_are_other_matches(four: list[str], tmp_path: Path) -> None:
    gridmerge.merge(four, cache=tmp_path)
    before = matches_in(tmp_path)
    with pytest.warns(gridmerge.CacheWarning, match="they were made with accept 0.95"):
        gridmerge.merge(four, cache=tmp_path, accept=0.9)
    assert matches_in(tmp_path) > before


def test_the_command_line_shares_it(four: list[str], cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "matches"
    gridmerge.merge(four, cache=folder)
    ran = cli("merge", "--cache", folder, *four, "-o", tmp_path / "told", "--verbose")
    assert "9 matches of the cache, 0 made" in ran.stderr
    other = tmp_path / "of_the_tool"
    cli("merge", "--cache", other, *four, "-o", tmp_path / "told")
    counting = Counting()
    gridmerge.merge(four, cache=other, executor=counting)
    assert counting.matches == 0
    assert {path.name for path in matches_in(other)} == {path.name for path in matches_in(folder)}


@pytest.mark.parametrize("how", ["here", "executor", "merger"])
def test_shards_that_do_not_fit_are_named(how: str, four: list[str], cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "matches"
    for shard in ("1/3", "2/4"):
        assert cli("merge", "--cache", folder, "--shard", shard, *four).returncode == 3
    with pytest.warns(gridmerge.CacheWarning) as told:
        merged_with(how, four, folder)
    assert [str(one.message) for one in told] == [
        f"{folder}: shards do not fit: 1/3, 2/4 are of different numbers of shards. Run all shards with the same N, "
        "maps, options and version of gridmerge"
    ]
    assert told[0].filename == __file__
    merged_with(how, four, folder)  # nothing is missing by now


@pytest.mark.parametrize("how", ["here", "executor", "merger"])
def test_matches_of_another_engine_are_named(how: str, four: list[str], tmp_path: Path) -> None:
    (tmp_path / "made-with").mkdir()
    (tmp_path / "made-with" / "0.0.9+0123456789abcdef_accept_0.95").touch()
    with pytest.warns(gridmerge.CacheWarning, match=r"they are of gridmerge 0\.0\.9\+0123456789abcdef, and"):
        merged_with(how, four, tmp_path)
    merged_with(how, four, tmp_path)


def test_an_evaluation_names_matches_of_other_options(tables: dict[str, Any], tmp_path: Path) -> None:
    gridmerge.evaluate(pairs=tables["pairs"], cache=tmp_path)
    for executor in (None, Counting()):
        accept = 0.9 if executor is None else 0.8
        with pytest.warns(gridmerge.CacheWarning, match="they were made with accept 0.9"):
            gridmerge.evaluate(pairs=tables["pairs"], cache=tmp_path, accept=accept, executor=executor)


@pytest.mark.parametrize("how", ["here", "executor", "merger"])
def test_how_much_was_there_is_logged(
    how: str, four: list[str], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO", "gridmerge")
    merged_with(how, four[:2], tmp_path)
    merged_with(how, four, tmp_path)
    assert [record.getMessage() for record in caplog.records] == [
        "0 matches of the cache, 1 made",
        "1 match of the cache, 8 made",
    ]


def test_an_evaluation_logs_how_much_was_there(
    tables: dict[str, Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level("INFO", "gridmerge")
    gridmerge.evaluate(**tables, cache=tmp_path)
    gridmerge.evaluate(**tables, cache=tmp_path, executor=Counting())
    gridmerge.evaluate(**tables, cache=tmp_path)
    told = [record.getMessage() for record in caplog.records]
    assert told[0].startswith("0 matches of the cache") or not told[0].endswith(" 0 made")
    assert all(message.endswith(" of the cache, 0 made") for message in told[1:]) and len(told) == 3


def test_an_evaluation_keeps_its_matches(tables: dict[str, Any], cli: Cli, tmp_path: Path) -> None:
    plain = without_times(gridmerge.evaluate(**tables).to_json())
    folder = tmp_path / "matches"
    assert without_times(gridmerge.evaluate(**tables, cache=folder).to_json()) == plain
    kept = matches_in(folder)
    counting = Counting()
    told = gridmerge.evaluate(**tables, cache=folder, executor=counting)
    assert without_times(told.to_json()) == plain
    assert counting.matches == 0
    arguments = ("--negatives", tables["negatives"], "--sets", tables["sets"], "--cache")
    assert cli("evaluate", tables["pairs"], *arguments, folder).returncode == 0
    assert matches_in(folder) == kept
    gridmerge.evaluate(**tables, cache=tmp_path / "by_workers", executor=counting)
    assert {path.name for path in matches_in(tmp_path / "by_workers")} == {path.name for path in kept}


def test_a_tree_of_an_evaluation_keeps_its_matches(tables: dict[str, Any], tmp_path: Path) -> None:
    plain = gridmerge.evaluate(**tables, strategy="tree")
    for _ in range(2):
        kept = gridmerge.evaluate(**tables, strategy="tree", cache=tmp_path)
        assert without_times(kept.to_json()) == without_times(plain.to_json())
    assert matches_in(tmp_path)


def test_damaged_files_are_told_and_made_again(four: list[str], tmp_path: Path) -> None:
    gridmerge.merge(four, cache=tmp_path)
    damaged = sorted(matches_in(tmp_path))[:2]
    for path in damaged:
        path.write_bytes(path.read_bytes()[:-1])
    counting = Counting()
    with pytest.warns(gridmerge.CacheWarning, match="its maps are matched again") as told:
        gridmerge.merge(four, cache=tmp_path, executor=counting)
    assert len(told) == 1 and told[0].filename == __file__
    assert counting.matches == 2
    damaged[0].write_bytes(b"")
    with pytest.warns(gridmerge.CacheWarning):
        gridmerge.merge(four, cache=tmp_path)
    assert damaged[0].stat().st_size > 0


@pytest.mark.parametrize("executor", [None, Counting()])
def test_what_cannot_be_kept_is_told_once(executor: Executor | None, four: list[str], tmp_path: Path) -> None:
    for folder in (f"{number:02x}" for number in range(256)):
        (tmp_path / folder).write_text("in the way")
    with pytest.warns(gridmerge.CacheWarning, match="cannot be kept") as told:
        assert gridmerge.merge(four, cache=tmp_path, executor=executor).components
    assert len(told) == 1


def test_bad_directories_are_named(four: list[str], tables: dict[str, Any], tmp_path: Path) -> None:
    file = tmp_path / "a_file"
    file.touch()
    for call in (
        lambda: gridmerge.merge(four, cache=file),
        lambda: gridmerge.merge(four, cache=file / "below", executor=Counting()),
        lambda: gridmerge.Merger().solve(cache=str(file)),
        lambda: gridmerge.evaluate(**tables, cache=file),
    ):
        with pytest.raises(gridmerge.FileError, match=re.escape(str(file))):
            call()
    wrong: Any = 3
    with pytest.raises(TypeError, match="^cache: must be a path, is of type int$"):
        gridmerge.merge(four, cache=wrong)
    with pytest.raises(ValueError, match="^cache: is an empty path$"):
        gridmerge.Merger().solve(cache="")
    with pytest.raises(ValueError, match="^cache: needs the strategy 'joint'$"):
        gridmerge.merge(four, cache=tmp_path, strategy="tree")
    with pytest.raises(ValueError, match="^cache: does not go with the search 'random-walk'$"):
        gridmerge.evaluate(**tables, cache=tmp_path, strategy="tree", search="random-walk")


def test_a_relative_directory_stays_where_it_was(
    robots: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "there").mkdir()
    monkeypatch.chdir(tmp_path)

    class Moving(Counting):
        def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            os.chdir(tmp_path / "there")
            return super().submit(task, *args, **kwargs)

    gridmerge.merge(robots, cache="matches", executor=Moving())
    assert len(matches_in(tmp_path / "matches")) == 3


@pytest.mark.parametrize("how", ["here", "executor", "merger"])
def test_the_share_rises_also_with_what_is_there(how: str, four: list[str], tmp_path: Path) -> None:
    for _ in range(2):
        shares: list[float] = []
        merged_with(how, four, tmp_path, shares.append)
        assert shares == sorted(shares) and shares[-1] == 1.0
