// SPDX-License-Identifier: Apache-2.0
// How a node ends, and what it refuses to begin with.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "node_fixture.hpp"

namespace gridmerge::test {
namespace {

/// In a partition, as programs without ROS may have it.
internal::DdsEntity make_publisher_in(const char* partition, dds_entity_t participant) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_partition1(qos, partition);
  internal::DdsEntity made(dds_create_publisher(participant, qos, nullptr), "a publisher");
  dds_delete_qos(qos);
  return made;
}

TEST_F(NodeTest, TellsWhatComesNearWhereThereIsNoMap) {
  options.wait = 5.0;
  start();
  const internal::DdsEntity of_other_type =
      internal::make_writer(peer->participant(), internal::kDiagnosticType, "rt/tb1/map", {true, true, 1});
  const MapTopic elsewhere = peer->maps("/tb2/slam/map");
  const MapTopic silent = peer->maps("/tb3/map");
  const MapTopic wrong = peer->maps("/tb4/map");
  wrong.publish(RawMap{.frame = "", .data = {0}});
  const internal::DdsEntity topic(
      dds_create_topic(peer->participant(), internal::kMapType.descriptor, "rt/tb5/map", nullptr, nullptr),
      "a topic");
  const internal::DdsEntity fleet = make_publisher_in("fleet", peer->participant());
  const internal::DdsEntity in_fleet(dds_create_writer(fleet.get(), topic.get(), nullptr, nullptr),
                                     "a writer");
  try {
    node->end();
    FAIL() << "it ended without an error";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    for (const char* part : {"no map within 5 s", "on /*/map in domain",
                             "/tb1/map: is of the type diagnostic_msgs/msg/DiagnosticArray",
                             "/tb2/slam/map: is a map, but its name is not one of those",
                             "/tb3/map: is there, but nothing was received", "/tb4/map: refused: no frame_id",
                             "/tb5/map: is in a partition of DDS, which ROS 2 does not use"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
  }
}

TEST_F(NodeTest, EndsOnceAllAreMerged) {
  options.once = true;
  options.wait = 60.0;
  options.robots = {{"left", "/tb1/map"}, {"right", "/x/y"}};
  options.patterns = {};
  const auto began = std::chrono::steady_clock::now();
  start();
  const MapTopic left = peer->maps("/tb1/map");
  const MapTopic right = peer->maps("/x/y");
  left.publish(map_of(0, "l"));
  right.publish(map_of(1, "r"));
  EXPECT_EQ(node->end(), RosNode::End::merged) << node->lines();
  // One map of each is all it waits for: it does not use up the time that it may wait.
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(60));
  EXPECT_NE(node->describe().find("left: placed at"), std::string::npos);
  EXPECT_TRUE(comes_true([&] { return peer->take_map("/merged_map").has_value(); }));
}

TEST_F(NodeTest, WaitsForARobotThatIsNamed) {
  options.once = true;
  options.wait = 60.0;
  options.robots = {{"left", "/tb1/map"}, {"right", "/tb2/map"}, {"late", "/tb3/map"}};
  options.patterns = {};
  start();
  const MapTopic left = peer->maps("/tb1/map");
  const MapTopic right = peer->maps("/tb2/map");
  left.publish(map_of(0, "l"));
  right.publish(map_of(1, "r"));
  ASSERT_TRUE(diagnosed("left", "state", "placed")) << node->lines();
  ASSERT_TRUE(diagnosed("right", "state", "placed")) << node->lines();
  std::this_thread::sleep_for(std::chrono::seconds(4));  // longer than after the last of those that are named
  const MapTopic late = peer->maps("/tb3/map");
  late.publish(map_of(2, "t"));
  node->end();
  EXPECT_NE(node->describe().find("late: "), std::string::npos) << node->describe();
}

TEST_F(NodeTest, EndsOnceNotAllCanBeMerged) {
  options.once = true;
  options.wait = 30.0;
  start();
  const MapTopic left = peer->maps("/a/map");
  const MapTopic other = peer->maps("/b/map");
  left.publish(map_of(0, "a"));
  other.publish(map_of(3, "b"));
  EXPECT_EQ(node->end(), RosNode::End::refused) << node->lines();
  EXPECT_NE(node->describe().find("b: left out: "), std::string::npos) << node->describe();
}

TEST_F(NodeTest, EndsOnceThoughMapsCannotBeMerged) {
  options.once = true;
  options.wait = 30.0;
  options.robots = {{"left", "/tb1/map"}, {"right", "/x/y"}};
  options.patterns = {};
  // Fixed robots lie together, however large the merged map would be.
  options.known_poses["left"] = KnownPose{{0.0, 0.0, 0.0}, 0.0, 0.0, true};
  options.known_poses["right"] = KnownPose{{9e6, 9e6, 0.0}, 0.0, 0.0, true};
  start();
  const MapTopic left = peer->maps("/tb1/map");
  const MapTopic right = peer->maps("/x/y");
  left.publish(map_of(0, "l"));
  right.publish(map_of(1, "r"));
  try {
    node->end();
    FAIL() << node->describe();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the maps cannot be merged: the merged map would exceed 2^28 cells");
  }
}

TEST_F(NodeTest, TellsHowItIsWhenItEnds) {
  options.once = true;
  options.team.quiet = std::chrono::milliseconds(0);
  options.wait = 2.2;  // most of a second after the last of the regular diagnoses
  start();
  const MapTopic topic = peer->maps("/a/map");
  topic.publish(map_of(0, "a"));
  ASSERT_TRUE(diagnosed("a", "maps", "1"));
  node->end();
  const double ended =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  EXPECT_LT(ended - diagnosis("a").stamp, 0.5);
}

TEST_F(NodeTest, EndsOnceThoughRobotsMapOn) {
  options.once = true;
  options.wait = 30.0;
  start();
  const MapTopic left = peer->maps("/a/map");
  const MapTopic right = peer->maps("/b/map");
  std::atomic<bool> ended{false};
  std::thread mapping([&] {
    for (std::int32_t second = 1; !ended; ++second) {
      for (const auto& [topic, robot] : {std::pair(&left, 0), std::pair(&right, 1)}) {
        RawMap map = map_of(robot, robot == 0 ? "a" : "b");
        map.seconds = second;
        map.data[static_cast<std::size_t>(second) % map.data.size()] = 100;  // never quite the same
        topic->publish(map);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
  EXPECT_EQ(node->end(), RosNode::End::merged) << node->lines();
  ended = true;
  mapping.join();
}

TEST(RosNode, RefusesOptionsThatCannotBe) {
  own_domain();
  const auto refuses = [](const std::function<void(RosNodeOptions&)>& spoil) {
    RosNodeOptions options;
    options.patterns = {"/*/map"};
    spoil(options);
    EXPECT_THROW(RosNode{options}, std::invalid_argument);
  };
  refuses([](RosNodeOptions& options) { options.patterns = {}; });
  refuses([](RosNodeOptions& options) { options.patterns = {"map"}; });
  refuses([](RosNodeOptions& options) { options.name = "a/b"; });
  refuses([](RosNodeOptions& options) { options.name = ""; });
  refuses([](RosNodeOptions& options) { options.output = "merged_map"; });
  refuses([](RosNodeOptions& options) { options.world_frame = "the world"; });
  refuses([](RosNodeOptions& options) { options.wait = -1.0; });
  refuses([](RosNodeOptions& options) { options.wait = std::nan(""); });
  refuses([](RosNodeOptions& options) { options.known_poses["a"] = KnownPose{{}, -1.0, 0.1, false}; });
  refuses([](RosNodeOptions& options) {
    options.patterns = {};
    options.robots = {{"a", "/a/map"}};
    options.known_poses["b"] = KnownPose{{}, 1.0, 0.1, false};
  });
}

TEST(RosNode, NamesVariablesAndSettingsThatCannotBe) {
  own_domain();
  RosNodeOptions options;
  options.patterns = {"/*/map"};
  const auto refusal = [&] {
    try {
      const RosNode node(options);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  ::setenv("CYCLONEDDS_URI", "<CycloneDDS><Domain><NoSuchThing/></Domain></CycloneDDS>", 1);
  EXPECT_NE(refusal().find("NoSuchThing"), std::string::npos) << refusal();
  ::setenv("CYCLONEDDS_URI", "", 1);
  ::setenv("ROS_DOMAIN_ID", "many", 1);
  EXPECT_NE(refusal().find("ROS_DOMAIN_ID='many'"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace gridmerge::test
