# SPDX-License-Identifier: Apache-2.0
"""Matches that an executor makes: any executor, and the same bits."""

from __future__ import annotations

import multiprocessing
import os
import pickle
import random
import re
import signal
import struct
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

import gridmerge
import pytest
from gridmerge import _core, _executor, _tasks


def but_for_the_time(answer: _tasks.Answer) -> list[bytes]:
    """Of each match, which has its time behind 8 numbers and 2 bytes."""
    kind, _, made = answer
    assert kind == "matches"
    assert not isinstance(made, str)
    return [match[:66] + match[74:] for match, _ in made]


def answer(result: gridmerge.MergeResult, folder: Path) -> tuple[str, bytes]:
    """What a merge writes, but for its times."""
    result.save(folder)
    text = (folder / "transforms.json").read_text()
    return re.sub(r'"seconds": *[0-9.e+-]+', "", text), (folder / "merged.pgm").read_bytes()


@pytest.fixture(scope="module")
def four(robots: list[str], elsewhere: str) -> list[str]:
    return [*robots, elsewhere]


@pytest.fixture(scope="module")
def expected(four: list[str], tmp_path_factory: pytest.TempPathFactory) -> tuple[str, bytes]:
    return answer(gridmerge.merge(four), tmp_path_factory.mktemp("plain"))


@pytest.fixture(autouse=True)
def small_tasks(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that there are several."""
    monkeypatch.setattr(_executor, "TASK_SECONDS", 1e-9)


class Untidy(Executor):
    """Runs tasks in any order, some of them twice and in vain: what an engine may do to them."""

    def __init__(self, seed: int, failures: float = 0.3) -> None:
        self._random = random.Random(seed)
        self._failures = failures
        self._waiting: list[tuple[Future[Any], Callable[[], Any]]] = []
        self._wake = threading.Condition()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._is_over = False
        self.tasks = 0
        self.failed = 0
        self._thread.start()

    def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        sent = pickle.dumps((task, args, kwargs))

        def run() -> Any:
            work, arguments, named = pickle.loads(sent)
            return pickle.loads(pickle.dumps(work(*arguments, **named)))

        with self._wake:
            self.tasks += 1
            self._waiting.append((future, run))
            self._wake.notify()
        return future

    def _run(self) -> None:
        in_a_row = 0
        while True:
            with self._wake:
                self._wake.wait_for(lambda: self._waiting or self._is_over)
                if self._is_over:
                    return
                future, run = self._waiting.pop(self._random.randrange(len(self._waiting)))
            if not future.set_running_or_notify_cancel():
                continue
            if self._random.random() < self._failures and in_a_row < _executor.MOST_ATTEMPTS - 1:
                in_a_row += 1
                self.failed += 1
                future.set_exception(OSError("a worker is gone"))
                continue
            in_a_row = 0
            run()
            future.set_result(run())  # done twice, as by an engine that thought the first worker dead

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        with self._wake:
            self._is_over = True
            self._wake.notify()


class Inline(Executor):
    """Runs each task at once, or fails as it is told to."""

    def __init__(self, fail: Callable[[int], BaseException | None] = lambda number: None) -> None:
        self.fail = fail
        self.sent: list[tuple[Any, ...]] = []

    def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.sent.append(args)
        future: Future[Any] = Future()
        error = self.fail(len(self.sent))
        if error is not None:
            future.set_exception(error)
        else:
            future.set_result(task(*args, **kwargs))
        return future


@pytest.mark.parametrize("start", ["fork", "spawn"])
def test_processes_give_the_same_bits(
    start: str, four: list[str], expected: tuple[str, bytes], tmp_path: Path
) -> None:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context(start)) as executor:
        assert answer(gridmerge.merge(four, executor=executor), tmp_path / "by_path") == expected
        grids = [gridmerge.load(path) for path in four]
        assert answer(gridmerge.merge(grids, executor=executor), tmp_path / "by_map") == expected


def test_threads_give_the_same_bits(four: list[str], expected: tuple[str, bytes], tmp_path: Path) -> None:
    shares: list[float] = []
    with ThreadPoolExecutor(3) as executor:
        result = gridmerge.merge(four, executor=executor, progress=shares.append)
    assert answer(result, tmp_path) == expected
    assert shares == sorted(set(shares)) and shares[-1] == 1.0
    assert len(shares) == 10  # six pairs, three of the map that is elsewhere again, and the end


@pytest.mark.parametrize("seed", range(2))
def test_order_failures_and_repetition_change_nothing(
    seed: int, four: list[str], expected: tuple[str, bytes], tmp_path: Path
) -> None:
    with Untidy(seed) as executor:
        assert answer(gridmerge.merge(four, executor=executor), tmp_path) == expected
        assert executor.tasks == 9 + executor.failed


def test_known_poses_and_options_are_those_of_merge(four: list[str], tmp_path: Path) -> None:
    options: dict[str, Any] = {"fix": 0, "accept": 0.9, "search": "quick", "max_false_joins": 0.2}
    with ThreadPoolExecutor(2) as executor:
        told = gridmerge.merge(four, executor=executor, names=list("abcd"), **options)
    plain = gridmerge.merge(four, names=list("abcd"), **options)
    assert answer(told, tmp_path / "told") == answer(plain, tmp_path / "plain")


def test_tasks_are_batched_by_what_they_cost(robots: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    grids = [gridmerge.load(path) for path in robots]
    maps = [_executor.of_grid(grid) for grid in grids]
    wanted = [_executor.Wanted(maps[0], maps[1], "quick", lambda match: None)] * 40
    monkeypatch.setattr(_executor, "TASK_SECONDS", 1.0)
    monkeypatch.setattr(_executor, "_TASKS_OF_A_ROUND", 1)
    inline = Inline()
    _executor.MatchingExecutor(inline, 0.95, 12).make(wanted)
    assert 2 <= len(inline.sent) <= 20
    for _, _, sent, pairs, _, _ in inline.sent:
        assert len(sent) == 2  # each map once
        assert len(pairs) >= 1


def test_a_round_of_little_work_has_small_tasks(robots: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(_executor, "TASK_SECONDS", 0.4)
    grids = [gridmerge.load(path) for path in robots]
    maps = [_executor.of_grid(grid) for grid in grids]
    matching = _executor.MatchingExecutor(Inline(), 0.95, 12)
    one = _executor.Wanted(maps[0], maps[1], "quick", lambda match: None)
    matching._rates["quick"] = 0.01 / one.cells  # seconds of a pair: 0.01
    assert matching._task_seconds([one] * 10) == pytest.approx(0.2)
    assert matching._task_seconds([one] * 1920) == pytest.approx(0.3)
    assert matching._task_seconds([one] * 10_000) == pytest.approx(0.4)


def test_a_search_that_is_not_known_takes_its_time_too(robots: list[str]) -> None:
    maps = [_executor.of_grid(gridmerge.load(path)) for path in robots[:2]]
    wanted = [_executor.Wanted(maps[0], maps[1], "by-hand", lambda match: None)]
    with pytest.raises(gridmerge.ExecutorError, match="failed 3 times"):
        _executor.MatchingExecutor(Inline(lambda number: OSError()), 0.95, 12).make(wanted)


def test_tasks_are_pure_and_picklable(robots: list[str]) -> None:
    inline = Inline()
    gridmerge.merge(robots, executor=inline)
    for args in inline.sent:
        once, twice = _tasks.match_pairs(*args), _tasks.match_pairs(*pickle.loads(pickle.dumps(args)))
        assert once[:2] == twice[:2]
        assert but_for_the_time(once) == but_for_the_time(twice)
    assert all(spec[0] == "file" for args in inline.sent for spec in args[2])


def test_a_second_look_goes_on_from_what_the_first_one_found(four: list[str]) -> None:
    inline = Inline()
    gridmerge.merge(four, executor=inline)
    first = [args for args in inline.sent if args[3][0][2] == "quick"]
    second = [args for args in inline.sent if args[3][0][2] == "exhaustive"]
    assert first
    assert second
    assert all(found == b"" for args in first for *_, found in args[3])
    assert all(found for args in second for *_, found in args[3])
    for args in second:
        whole = but_for_the_time(_tasks.match_pairs(*args))
        for other in (b"", b"what another version found"):
            anew = list(args)
            anew[3] = tuple((*pair[:3], other) for pair in args[3])
            assert but_for_the_time(_tasks.match_pairs(*anew)) == whole


def test_a_second_look_takes_the_first_ones_word(robots: list[str], elsewhere: str) -> None:
    """So what was found is not only sent, but used."""
    specs = tuple(_executor.of_grid(gridmerge.load(path)).spec for path in (robots[0], elsewhere))

    def probability(pair: tuple[int, int], search: str, found: bytes) -> tuple[float, bytes]:
        pairs = ((*pair, search, found),)
        kind, _, made = _tasks.match_pairs(_core.engine_id(), 0, specs, pairs, 0.95, 12)
        assert kind == "matches"
        assert not isinstance(made, str)
        ((match, quickly),) = made
        return struct.unpack_from("<d", match, 24)[0], quickly  # behind the pose

    sure, of_copies = probability((0, 0), "quick", b"")
    assert sure > 0.95
    assert probability((0, 1), "exhaustive", b"")[0] < 0.95
    assert probability((0, 1), "exhaustive", of_copies)[0] == sure


def test_what_was_found_is_kept_no_longer_than_it_is_of_use(
    four: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_executor, "_MOST_FOUND", 1)
    maps = [_executor.of_grid(gridmerge.load(path)) for path in four]
    taken: list[bytes] = []
    matching = _executor.MatchingExecutor(Inline(), 0.95, 12)
    pairs = [(a, b) for a in range(4) for b in range(a)]
    matching.make([_executor.Wanted(maps[a], maps[b], "quick", taken.append) for a, b in pairs])
    assert len(matching._found) == 1
    (kept,) = matching._found
    a, b = next(pair for pair in pairs if kept == {maps[pair[0]].content, maps[pair[1]].content})
    matching.make([_executor.Wanted(maps[b], maps[a], "exhaustive", taken.append)])
    assert matching._found == {}
    assert len(taken) == len(pairs) + 1


def test_paths_hold_wherever_the_program_goes(
    four: list[str], expected: tuple[str, bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = Path(four[0]).parent
    monkeypatch.chdir(folder)
    inline = Inline()
    inline.fail = lambda number: os.chdir(tmp_path)
    result = gridmerge.merge([Path(path).name for path in four], executor=inline)
    assert [component.members[0].map for component in result.components] == [0]


def test_a_task_that_fails_again_and_again_is_an_error_that_names_the_executor(robots: list[str]) -> None:
    inline = Inline(lambda number: OSError("no route to host") if number > 1 else None)
    with pytest.raises(
        gridmerge.ExecutorError,
        match=r"^executor: Inline failed 3 times with the same task: OSError: no route to host "
        r"\(1 of 3 matches were made\)$",
    ):
        gridmerge.merge(robots, executor=inline)
    assert len(inline.sent) <= 1 + 2 * _executor.MOST_ATTEMPTS


@pytest.mark.parametrize(
    "answer",
    [None, 7, ("matches", 0, "x"), ("matches", 99, []), ("matches", 0, [b"no match"]), ("matches", 0, [])]
    + [("matches", 0, [made]) for made in ((b"no match", b""), (b"", b"", b""), None)],
)
def test_an_answer_that_is_none_is_a_failure(answer: Any, robots: list[str]) -> None:
    class Wrong(Executor):
        def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            future: Future[Any] = Future()
            future.set_result(answer)
            return future

    with pytest.raises(gridmerge.ExecutorError, match="Wrong failed 3 times"):
        gridmerge.merge(robots, executor=Wrong())


def _die_once(marker: str, *args: Any) -> Any:
    if not os.path.exists(marker):
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return _tasks.match_pairs(*args)


def test_a_pool_whose_process_is_killed_is_named(robots: list[str], tmp_path: Path) -> None:
    class Deadly(ProcessPoolExecutor):
        def submit(self, task: Any, /, *args: Any, **kwargs: Any) -> Any:
            return super().submit(_die_once, str(tmp_path / "died"), *args, **kwargs)

    merger = gridmerge.Merger()
    for robot in robots:
        merger.add(robot)
    with Deadly(1) as executor, pytest.raises(gridmerge.ExecutorError, match="Deadly") as told:
        merger.solve(executor=executor)
    assert isinstance(told.value.__cause__, BrokenProcessPool)
    with Deadly(1) as executor:  # another pool goes on
        assert merger.solve(executor=executor).complete


def test_a_worker_of_another_version_is_refused(robots: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    class Older(Inline):
        def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            with monkeypatch.context() as other:
                other.setattr(_core, "engine_id", lambda: "0.0.9+0123456789abcdef")
                return super().submit(task, *args, **kwargs)

    with pytest.raises(
        gridmerge.ExecutorError,
        match=re.escape(
            f"has the engine 0.0.9+0123456789abcdef of gridmerge, and this is {_core.engine_id()}"
        ),
    ):
        gridmerge.merge(robots, executor=Older())


@pytest.fixture
def own(robots: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Maps that no worker has seen before, as it keeps what it has read."""
    monkeypatch.setattr(_tasks, "_shelf", _tasks._Shelf())
    paths = []
    for i, robot in enumerate(robots):
        grid = gridmerge.load(robot)
        gridmerge.save(grid, tmp_path / f"own_{i}.yaml")
        paths.append(str(tmp_path / f"own_{i}.yaml"))
    return paths


def test_a_file_that_vanishes_is_named(own: list[str]) -> None:
    inline = Inline()
    inline.fail = lambda number: os.remove(own[0]) if number == 1 else None
    with pytest.raises(gridmerge.FileError, match=re.escape(own[0])):
        gridmerge.merge(own, executor=inline)


def test_a_file_that_changes_is_named(own: list[str], elsewhere: str) -> None:
    inline = Inline()

    def change(number: int) -> None:
        if number == 1:
            gridmerge.save(gridmerge.load(elsewhere), own[1])

    inline.fail = change
    with pytest.raises(
        gridmerge.FileError, match=re.escape(own[1]) + ": is not the map that it was when the work began"
    ):
        gridmerge.merge(own, executor=inline)


def test_ctrl_c_cancels_what_has_not_begun(four: list[str]) -> None:
    class Slow(Executor):
        futures: list[Future[Any]]

        def submit(self, task: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            self.futures.append(Future())
            return self.futures[-1]

    slow = Slow()
    slow.futures = []
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    previous = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            gridmerge.merge(four, executor=slow)
    finally:
        signal.signal(signal.SIGINT, previous)
        timer.join()
    assert len(slow.futures) == 6
    assert all(future.cancelled() for future in slow.futures)


def test_an_exception_of_progress_ends_the_work(four: list[str]) -> None:
    def tell(share: float) -> None:
        raise ArithmeticError

    with ThreadPoolExecutor(1) as executor, pytest.raises(ArithmeticError):
        gridmerge.merge(four, executor=executor, progress=tell)


def test_what_is_no_executor_is_refused(four: list[str], team_folder: Path) -> None:
    wrong: Any = "dask"
    with pytest.raises(TypeError, match="^executor: must be a concurrent.futures.Executor, is of type str$"):
        gridmerge.merge(four, executor=wrong)
    with pytest.raises(TypeError, match="^executor"):
        gridmerge.Merger().solve(executor=wrong)
    with pytest.raises(TypeError, match="^executor"):
        gridmerge.evaluate(team_folder / "pairs.tsv", executor=wrong)
    with pytest.raises(ValueError, match="^executor: needs the strategy 'joint'"):
        gridmerge.merge(four, strategy="tree", executor=Inline())
    with pytest.raises(ValueError, match="^executor: needs the strategy 'joint'"):
        gridmerge.evaluate(team_folder / "pairs.tsv", strategy="tree", executor=Inline())


def test_no_maps_and_one_map_need_no_task(robots: list[str]) -> None:
    inline = Inline()
    shares: list[float] = []
    gridmerge.merge([], executor=inline, progress=shares.append)
    assert shares == [1.0]
    assert gridmerge.merge([], executor=inline).components == ()
    assert len(gridmerge.merge(robots[:1], executor=inline).left_out) == 1
    assert inline.sent == []


def without_times(json: str) -> str:
    return re.sub(r'"(seconds|median|p90|max)": *[0-9.e+-]+', "", json)


def test_an_evaluation_is_the_same(team_folder: Path) -> None:
    tables: dict[str, Any] = {"pairs": team_folder / "pairs.tsv", "sets": team_folder / "sets.tsv"}
    shares: list[float] = []
    with ProcessPoolExecutor(2) as executor:
        told = gridmerge.evaluate(**tables, executor=executor, progress=shares.append)
    assert without_times(told.to_json()) == without_times(gridmerge.evaluate(**tables).to_json())
    assert shares == sorted(shares) and shares[-1] == 1.0
    with Untidy(5) as untidy:
        again = gridmerge.evaluate(**tables, executor=untidy)
    assert without_times(again.to_json()) == without_times(told.to_json())


def test_an_evaluation_names_the_line_of_a_map_that_is_missing(tmp_path: Path, robots: list[str]) -> None:
    table = tmp_path / "negatives.tsv"
    table.write_text(f"fixed\tmoving\n{robots[0]}\tmissing.yaml\n")
    with pytest.raises(gridmerge.FileError, match=r"missing\.yaml.*\(.*negatives\.tsv:2 names it\)"):
        gridmerge.evaluate(negatives=table, executor=Inline())
