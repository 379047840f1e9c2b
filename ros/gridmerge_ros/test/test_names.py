# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import pytest
from gridmerge_ros.names import Selection, check_name, check_topic, numbered


def selection(
    namespace: str = "",
    robots: dict[str, str] | None = None,
    merged: str = "/merged_map",
    map_topic: str = "map",
) -> Selection:
    return Selection(map_topic, f"{map_topic}_updates", namespace, robots or {}, merged)


def test_robots_are_named_after_their_namespace() -> None:
    one = selection()
    assert one.robot_of("/tb1/map") == "tb1"
    assert one.robot_of("/fleet/tb1/map") == "fleet/tb1"
    assert one.updates_of("/tb1/map") == "/tb1/map_updates"
    for topic in ("/map", "/tb1/maps", "/tb1/the_map", "/tb1/map/other", "/tb1/local_costmap/costmap"):
        assert one.robot_of(topic) is None, topic


def test_topics_of_several_levels() -> None:
    one = selection(map_topic="slam/map")
    assert one.robot_of("/tb1/slam/map") == "tb1"
    assert one.robot_of("/slam/map") is None
    assert one.robot_of("/tb1/map") is None
    assert one.updates_of("/tb1/slam/map") == "/tb1/slam/map_updates"


def test_the_namespace_has_the_text_in_it() -> None:
    one = selection("tb")
    assert one.robot_of("/tb1/map") == "tb1"
    assert one.robot_of("/fleet/tb1/map") == "fleet/tb1"
    assert one.robot_of("/husky/map") is None
    # Not elsewhere in the topic.
    assert selection("map").robot_of("/tb1/map") is None


def test_own_maps_are_nobodys() -> None:
    one = selection(merged="/all/map")
    assert one.robot_of("/all/map") is None
    assert one.robot_of("/all/more/map") == "all/more"
    one = selection(merged="/all/map", map_topic="map_2")
    assert one.robot_of("/all/map_2") is None
    assert one.robot_of("/tb1/map_2") == "tb1"
    one = selection(robots={"all": "/merged_map_17"})
    assert one.robot_of("/merged_map_17") is None
    for other in ("/merged_map_0", "/merged_map_1", "/merged_map_02", "/merged_map_", "/merged_map_x"):
        assert selection(robots={"all": other}).robot_of(other) == "all"


def test_numbers_are_those_that_are_published() -> None:
    for number in (1, 2, 9, 10, 99, 100, 1001):
        topic = numbered("/merged_map", number)
        assert selection(robots={"all": topic}).robot_of(topic) is None


def test_robots_by_name_are_all() -> None:
    one = selection("nothing", {"tb1": "/tb1/map", "big": "/somewhere/grid"})
    assert one.robot_of("/tb1/map") == "tb1"
    assert one.robot_of("/somewhere/grid") == "big"
    assert one.robot_of("/tb2/map") is None
    assert one.updates_of("/somewhere/grid") == "/somewhere/grid_updates"


def test_a_topic_is_the_map_of_one_robot() -> None:
    with pytest.raises(ValueError, match=r"^robots: /x/map is the map of two robots, 'a' and 'b'$"):
        selection("nothing", {"a": "/x/map", "b": "/x/map"})


@pytest.mark.parametrize(
    "topic", ["", "map", "/", "//map", "/tb1//map", "/1/map", "/tb1/map/", "/a b", "/é", "/" + "x" * 300]
)
def test_what_is_no_topic(topic: str) -> None:
    with pytest.raises(ValueError, match="topic"):
        check_topic(topic)


@pytest.mark.parametrize("name", ["", "/tb1", "tb1/", "a//b", "1", "a b", "tb1\n"])
def test_what_is_no_robot(name: str) -> None:
    with pytest.raises(ValueError, match="no robot"):
        check_name(name)


def test_names() -> None:
    check_topic("/tb1/map")
    check_name("fleet/tb_1")
    assert [numbered("world", number) for number in (1, 2, 3)] == ["world", "world_2", "world_3"]
