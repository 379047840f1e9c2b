# SPDX-License-Identifier: Apache-2.0
"""Maps out of bags. rosbags and mcap write them; what they are read as is held against the messages themselves."""

from __future__ import annotations

import importlib.util
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import ModuleType
from typing import Any

import gridmerge
import numpy as np
import pytest
from conftest import ROOT, Cli

TOPICS = [
    gridmerge.BagTopic("/chatter", "std_msgs/msg/String", 3),
    gridmerge.BagTopic("/tb1/map", "nav_msgs/msg/OccupancyGrid", 3),
    gridmerge.BagTopic("/tb1/map_updates", "map_msgs/msg/OccupancyGridUpdate", 1),
    gridmerge.BagTopic("/tb2/map", "nav_msgs/msg/OccupancyGrid", 3),
]


@pytest.fixture(scope="session")
def maker() -> ModuleType:
    """The program that makes the bags of the C++ tests."""
    spec = importlib.util.spec_from_file_location("make_bags", ROOT / "tests" / "bag" / "make_bags.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def bags(maker: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bags")
    maker.main(folder)
    maker.write_ros1(folder / "ros1.bag")
    return folder


ROS2 = [
    "db3",
    "db3_messages",
    "db3_file",
    "mcap_plain",
    "mcap_storage",
    "mcap_file",
    *("none.mcap", "lz4.mcap", "zstd.mcap", "no_chunks.mcap", "no_index.mcap", "no_summary.mcap"),
]


def expected(maker: ModuleType, robot: int, time: int, updated: bool = False) -> np.ndarray[Any, Any]:
    values: np.ndarray[Any, Any] = maker.values(robot, time).reshape(maker.HEIGHT, maker.WIDTH)
    if updated:
        values[1:3, 2:5] = [[100, 0, 100], [0, -1, 0]]
    return values


@pytest.mark.parametrize("name", [*ROS2, "ros1.bag"])
def test_the_last_map_with_its_updates_is_loaded(name: str, bags: Path, maker: ModuleType) -> None:
    path = bags / name
    assert gridmerge.bag_topics(path) == TOPICS
    first = gridmerge.load(path, topic="/tb1/map")
    np.testing.assert_array_equal(first.to_numpy(), expected(maker, 1, 3, updated=True))
    assert first.resolution == 0.05
    assert first.origin.x == -1.25 and first.origin.y == 3.5
    assert first.origin.theta == pytest.approx(0.5, abs=1e-12)
    assert first.frame_id == "tb1/map"
    assert first.source == f"{path}#/tb1/map"
    second = gridmerge.load(f"{path}#tb2/map")
    np.testing.assert_array_equal(second.to_numpy(), expected(maker, 2, 3))
    assert second.warnings == ()
    with pytest.raises(gridmerge.FileError, match="2 topics of maps: add #TOPIC .*/tb1/map, /tb2/map"):
        gridmerge.load(path)
    with pytest.raises(gridmerge.FileError, match="'/map'; its topics of maps are /tb1/map, /tb2/map"):
        gridmerge.load(path, topic="/map")


@pytest.mark.parametrize("name", ROS2)
def test_each_recorded_map_comes_in_turn(name: str, bags: Path, maker: ModuleType) -> None:
    recorded = list(gridmerge.recorded_maps(bags / name, "/tb1/map"))
    assert [(one.time, one.is_update) for one in recorded] == [
        (10**9, False),
        (2 * 10**9, False),
        (3 * 10**9, False),
        (4 * 10**9, True),
    ]
    for time, one in zip((1, 2, 3), recorded, strict=False):
        np.testing.assert_array_equal(one.grid.to_numpy(), expected(maker, 1, time))
        assert one.grid.frame_id == "tb1/map"
    np.testing.assert_array_equal(recorded[3].grid.to_numpy(), expected(maker, 1, 3, updated=True))
    assert len(list(gridmerge.recorded_maps(f"{bags / name}#/tb2/map"))) == 3


def test_both_kinds_of_bags_give_the_same_maps(bags: Path) -> None:
    for topic in ("/tb1/map", "/tb2/map"):
        assert gridmerge.load(bags / "ros1.bag", topic=topic) == gridmerge.load(bags / "db3", topic=topic)


def test_the_command_line_shows_the_same(bags: Path, cli: Cli) -> None:
    shown = cli("info", bags / "lz4.mcap").stdout
    assert "/tb1/map, 3 maps, 1 updates" in shown and "/tb2/map, 3 maps, 0 updates" in shown
    refused = cli("info", bags / "ros1.bag")
    assert refused.returncode == 1 and "pip install 'gridmerge[rosbags]'" in refused.stderr


def test_maps_of_bags_are_maps_everywhere(robots: list[str], tmp_path: Path, maker: ModuleType) -> None:
    path = tmp_path / "team.mcap"
    write_maps(maker, path, {f"/tb{i}/map": gridmerge.load(one) for i, one in enumerate(robots, 1)})
    names = [f"{path}#/tb{i}/map" for i in (1, 2, 3)]
    pair = gridmerge.match(names[0], names[1])
    files = gridmerge.match(robots[0], robots[1])
    assert pair.accepted and pair.transform.x == pytest.approx(files.transform.x, abs=1e-6)
    merged = gridmerge.merge(names, init={f"{path}#tb2/map": (1.0, 2.0, 0.0)}, fix=names[1])
    assert merged.complete
    assert [member.name for member in merged.components[0].members] == names
    assert merged.components[0].members[1].transform == gridmerge.Transform(1.0, 2.0, 0.0)
    merged.save(tmp_path / "merged")
    with pytest.raises(ValueError, match="is none of the maps"):
        gridmerge.merge(names, init={f"{path}#/tb4/map": (0.0, 0.0, 0.0)})


def test_workers_read_bags(robots: list[str], bags: Path, tmp_path: Path, maker: ModuleType) -> None:
    path = tmp_path / "team.mcap"
    write_maps(maker, path, {f"/tb{i}/map": gridmerge.load(one) for i, one in enumerate(robots, 1)})
    maps = [f"{path}#/tb{i}/map" for i in (1, 2, 3)]
    with ThreadPoolExecutor(2) as executor:
        told = gridmerge.merge([*maps, f"{bags / 'ros1.bag'}#/tb1/map"], executor=executor)
    assert told.components[0].members == gridmerge.merge(maps).components[0].members


def write_maps(maker: ModuleType, path: Path, maps: dict[str, gridmerge.OccupancyGrid]) -> None:
    types, _ = maker.stores()
    kind = "nav_msgs/msg/OccupancyGrid"
    writer = maker.McapWriter(str(path))
    writer.start(profile="ros2", library="mcap")
    schema = writer.register_schema(kind, "ros2msg", b"")
    template = next(message for topic, _, _, message in maker.messages(types, False) if topic == "/tb1/map")
    for topic, grid in maps.items():
        message = grid.to_msg(lambda: template)
        message.data = np.asarray(message.data, np.int8)
        channel = writer.register_channel(topic, "cdr", schema)
        writer.add_message(channel, 1, bytes(types.serialize_cdr(message, kind)), 1)
    writer.finish()


def test_arguments_that_do_not_fit(bags: Path, robots: list[str], tmp_path: Path) -> None:
    with pytest.raises(gridmerge.FileError, match="is no bag, and so has no topic '/map'"):
        gridmerge.load(robots[0], topic="/map")
    with pytest.raises(ValueError, match="topic: is '/tb2/map', but the path names '/tb1/map'"):
        gridmerge.load(f"{bags / 'db3'}#/tb1/map", topic="/tb2/map")
    assert gridmerge.load(f"{bags / 'db3'}#tb1/map", topic="/tb1/map") == gridmerge.load(
        f"{bags / 'db3'}#/tb1/map"
    )
    with pytest.raises(ValueError, match="topic: is empty"):
        gridmerge.load(bags / "db3", topic="")
    with pytest.raises(TypeError, match="topic: must be a string"):
        gridmerge.load(bags / "db3", topic=3)  # type: ignore[arg-type]
    with pytest.raises(gridmerge.FileError, match="is no bag of ROS 2"):
        gridmerge.bag_topics(robots[0])
    with pytest.raises(gridmerge.FileError, match=r"load\(\) takes the last map; rosbags-convert"):
        gridmerge.recorded_maps(bags / "ros1.bag", "/tb1/map")
    damaged = tmp_path / "damaged.bag"
    damaged.write_bytes((bags / "ros1.bag").read_bytes()[:3000])
    with pytest.raises(gridmerge.FileError, match="damaged.bag: rosbags cannot read it"):
        gridmerge.load(damaged, topic="/tb1/map")


def test_a_bag_of_ros_1_needs_rosbags(bags: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rosbags.rosbag1", None)
    with pytest.raises(ImportError, match=r"pip install 'gridmerge\[rosbags\]'"):
        gridmerge.load(bags / "ros1.bag", topic="/tb1/map")
