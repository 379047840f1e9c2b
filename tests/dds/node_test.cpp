// SPDX-License-Identifier: Apache-2.0
// The node beside peers of its own process: nothing goes over a network.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "online/explorers.hpp"
#include "peer.hpp"
#include "running_node.hpp"

namespace gridmerge::test {
namespace {

class NodeTest : public testing::Test {
 protected:
  NodeTest() {
    options.patterns = {"/*/map"};
    options.team.quiet = std::chrono::milliseconds(500);
  }

  /// Starts the node, and a peer in its domain.
  void start() {
    node = std::make_unique<RunningNode>(options);
    peer = std::make_unique<Peer>(domain);
  }

  RawMap map_of(int robot, const std::string& frame) const {
    return raw_map(frame, explorers.map(robot, Explorers::kSteps));
  }

  RawDiagnosis diagnosis(const std::string& robot) { return peer->diagnoses().at("gridmerge: " + robot); }

  bool diagnosed(const std::string& robot, const std::string& key, const std::string& value) {
    return comes_true([&] {
      const auto& all = peer->diagnoses();
      const auto found = all.find("gridmerge: " + robot);
      if (found == all.end()) return false;
      const auto entry = found->second.values.find(key);
      return entry != found->second.values.end() && entry->second == value;
    });
  }

  /// Publishes the first two robots' maps, and waits until they are merged.
  void merge_two() {
    a.emplace(peer->maps("/a/map"));
    a->publish(map_of(0, "a/map"));
    ASSERT_TRUE(diagnosed("a", "state", "waiting")) << node->lines();
    b.emplace(peer->maps("/b/map"));
    b->publish(map_of(1, "b/map"));
    ASSERT_TRUE(diagnosed("a", "state", "placed")) << node->lines();
    ASSERT_TRUE(diagnosed("b", "state", "placed")) << node->lines();
  }

  const std::uint32_t domain = own_domain();
  const Explorers explorers;
  RosNodeOptions options;
  std::unique_ptr<RunningNode> node;
  std::unique_ptr<Peer> peer;  // goes before the node, whose domain it is in
  std::optional<MapTopic> a;
  std::optional<MapTopic> b;
};

TEST_F(NodeTest, MergesWhatItHears) {
  start();
  merge_two();
  ASSERT_TRUE(comes_true([&] { return peer->take_map("/merged_map").has_value(); }));
  const RawMap merged = *peer->take_map("/merged_map");
  EXPECT_EQ(merged.frame, "world");
  EXPECT_EQ(merged.seconds, 1);  // the time of the newest map, which may be a simulated one
  EXPECT_EQ(merged.data.size(), std::size_t{merged.width} * merged.height);
  ASSERT_TRUE(comes_true([&] { return peer->transforms().size() == 2; }));
  const SE2 expected = explorers.between(0, 1);
  EXPECT_EQ(peer->transforms().at("a/map").parent, "world");
  const SE2 T_world_b = peer->transforms().at("b/map").T_parent_child;
  EXPECT_NEAR(T_world_b.x, expected.x, 0.1);
  EXPECT_NEAR(T_world_b.y, expected.y, 0.1);
  EXPECT_NEAR(normalize_angle(T_world_b.theta - expected.theta), 0.0, 0.02);
  EXPECT_EQ(diagnosis("b").level, 0);
  EXPECT_EQ(diagnosis("b").values.at("topic"), "/b/map");
  EXPECT_EQ(peer->diagnoses().at("gridmerge").message, "2 of 2 robots placed");
  EXPECT_EQ(node->stop(), RosNode::End::stopped);
}

TEST_F(NodeTest, IsHeardByWhoComesLate) {
  start();
  merge_two();
  Peer late(domain);
  EXPECT_TRUE(comes_true([&] { return late.take_map("/merged_map").has_value(); }));
  EXPECT_TRUE(comes_true([&] { return late.transforms().size() == 2; }));
}

TEST_F(NodeTest, HearsVolatileAndUnreliablePublishers) {
  start();
  const MapTopic unreliable = peer->maps("/a/map", false, false);
  const MapTopic reliable = peer->maps("/b/map", false, true);
  EXPECT_TRUE(comes_true([&] {
    unreliable.publish(map_of(0, "a/map"));
    reliable.publish(map_of(1, "b/map"));
    const auto& all = peer->diagnoses();
    return all.contains("gridmerge: a") && all.contains("gridmerge: b") &&
           diagnosis("a").values["state"] == "placed" && diagnosis("b").values["state"] == "placed";
  })) << node->lines();
}

TEST_F(NodeTest, PublishesTransformsOnTf) {
  options.transforms = TransformTopic::tf;
  options.world_frame = "site";
  start();
  merge_two();
  EXPECT_TRUE(comes_true([&] { return peer->transforms("/tf").size() == 2; }));
  EXPECT_EQ(peer->transforms("/tf").at("a/map").parent, "site");
}

TEST_F(NodeTest, KeepsTheMapOfARobotThatIsGone) {
  start();
  merge_two();
  b.reset();
  EXPECT_TRUE(diagnosed("b", "publishers", "0"));
  EXPECT_TRUE(comes_true([&] { return node->said("b: its publisher is gone; its map is kept"); }))
      << node->lines();
  EXPECT_TRUE(diagnosed("b", "state", "placed"));
}

TEST_F(NodeTest, TakesAnotherPublisherForARobotThatStartedAnew) {
  options.known_poses["b"] = KnownPose{explorers.between(0, 1), 0.5, 0.05, false};
  start();
  merge_two();
  b.reset();
  ASSERT_TRUE(diagnosed("b", "publishers", "0"));
  b.emplace(peer->maps("/b/map"));
  b->publish(map_of(3, "b/map"));  // another building
  EXPECT_TRUE(comes_true([&] { return node->said("b: started anew"); })) << node->lines();
  EXPECT_TRUE(node->said("the pose given for it holds no longer")) << node->lines();
  EXPECT_TRUE(comes_true([&] { return diagnosis("b").values["state"] != "placed"; }));
  // The map of both is true no longer: nobody who comes late gets it.
  Peer late(domain);
  EXPECT_TRUE(comes_true([&] { return diagnosis("b").values["state"] == "left_out"; }));
  late.take_map("/merged_map");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(late.take_map("/merged_map").has_value());
}

TEST_F(NodeTest, TakesAnotherFrameForARobotThatStartedAnew) {
  start();
  merge_two();
  b->publish(map_of(1, "b/map_2"));
  EXPECT_TRUE(comes_true([&] { return node->said("b: started anew"); })) << node->lines();
  EXPECT_TRUE(diagnosed("b", "frame", "b/map_2"));
}

TEST_F(NodeTest, PublishesNoTransformOfANewFrameFromAnOldPose) {
  start();
  merge_two();
  ASSERT_TRUE(comes_true([&] { return peer->transforms().contains("b/map"); }));
  b->publish(map_of(3, "b/map_2"));  // another building
  ASSERT_TRUE(diagnosed("b", "frame", "b/map_2"));
  // Told with the new frame or later, and the pose of the old one never with it.
  EXPECT_NE(diagnosis("b").values["state"], "placed");
  ASSERT_TRUE(diagnosed("b", "state", "left_out")) << node->lines();
  EXPECT_FALSE(peer->transforms().contains("b/map_2"));
}

TEST_F(NodeTest, StaysWithItsAnswerThoughARobotRepeatsOldMaps) {
  start();
  merge_two();
  const std::string x = diagnosis("b").values.at("x");
  const RawMap newest = map_of(1, "b/map"), old = raw_map("b/map", explorers.map(1, Explorers::kSteps - 1));
  for (int i = 0; i < 5; ++i) {
    for (const RawMap* map : {&old, &newest}) {
      const std::uint64_t maps = std::stoull(diagnosis("b").values.at("maps"));
      b->publish(*map);
      ASSERT_TRUE(diagnosed("b", "maps", std::to_string(maps + 1))) << node->lines();
      EXPECT_EQ(diagnosis("b").values["state"], "placed");
    }
  }
  EXPECT_TRUE(diagnosed("b", "x", x));
  EXPECT_FALSE(node->said("b started anew") || node->said("b: started anew") || node->said("no longer"))
      << node->lines();
}

TEST_F(NodeTest, HearsARobotWhoseClockGoesBack) {
  start();
  merge_two();
  RawMap map = map_of(1, "b/map");
  // Something that stands in the middle comes and goes, so that the merged map changes each time.
  RawUpdate update;
  update.frame = "b/map";
  update.width = update.height = 6;
  update.x = static_cast<std::int32_t>(map.width / 2);
  update.y = static_cast<std::int32_t>(map.height / 2);
  const auto draw = [&](std::int8_t value) {
    update.data.assign(36, value);
    for (std::uint32_t i = 0; i < 36; ++i)
      map.data[(map.height / 2 + i / 6) * map.width + map.width / 2 + i % 6] = value;
  };
  map.seconds = 100;
  draw(100);
  b->publish(map);
  const auto merged_at = [&](int seconds) {
    return comes_true([&] {
      const std::optional<RawMap> merged = peer->take_map("/merged_map");
      return merged && merged->seconds == seconds;
    });
  };
  EXPECT_TRUE(merged_at(100)) << node->lines();
  map.seconds = 50;
  draw(0);
  b->publish(map);
  EXPECT_TRUE(merged_at(50)) << node->lines();
  // What it says after that counts too.
  draw(100);
  update.seconds = 51;
  peer->publish_update("/b/map_updates", update);
  EXPECT_TRUE(merged_at(51)) << node->lines();
  EXPECT_EQ(diagnosis("b").values["state"], "placed");
}

TEST_F(NodeTest, HearsOnePublisherOfATopic) {
  start();
  merge_two();
  const MapTopic second = peer->maps("/b/map");
  second.publish(map_of(3, "b/map"));
  EXPECT_TRUE(diagnosed("b", "messages of other publishers", "1")) << node->lines();
  EXPECT_TRUE(diagnosed("b", "state", "placed"));
  EXPECT_TRUE(node->said("/b/map: has several publishers"));
}

TEST_F(NodeTest, RefusesMessagesThatAreWrong) {
  start();
  merge_two();
  std::uint64_t refused = 0;
  const auto expect_refusal = [&](const RawMap& map, const std::string& why) {
    b->publish(map);
    ASSERT_TRUE(diagnosed("b", "refused", std::to_string(++refused))) << why;
    EXPECT_NE(diagnosis("b").values["last refusal"].find(why), std::string::npos)
        << diagnosis("b").values["last refusal"];
  };
  RawMap wrong = map_of(1, "b/map");
  wrong.data.pop_back();
  expect_refusal(wrong, "values for");
  wrong = map_of(1, "b/map");
  wrong.width = wrong.height = 1U << 31;
  expect_refusal(wrong, "above 2^28");
  wrong = map_of(1, "b/map");
  wrong.resolution = std::numeric_limits<float>::quiet_NaN();
  expect_refusal(wrong, "a resolution of nan");
  wrong = map_of(1, "b/map");
  wrong.x = std::numeric_limits<double>::infinity();
  expect_refusal(wrong, "an origin at");
  wrong = map_of(1, "b/map");
  wrong.yaw = std::numeric_limits<double>::quiet_NaN();
  expect_refusal(wrong, "quaternion");
  wrong = map_of(1, "");
  expect_refusal(wrong, "no frame_id");
  wrong = map_of(1, "b/map");
  wrong.data[0] = 101;
  expect_refusal(wrong, "the cell value 101");
  EXPECT_TRUE(node->said("/b/map: a message is refused: ")) << node->lines();
  EXPECT_EQ(diagnosis("b").values["state"], "placed");
  b->publish(map_of(1, "b/map"));
  EXPECT_TRUE(diagnosed("b", "maps", "2"));
}

TEST_F(NodeTest, TakesUpdatesOfItsPublisher) {
  start();
  merge_two();
  RawUpdate update;
  update.frame = "b/map";
  update.x = update.y = 80;  // within the building
  update.width = update.height = 6;
  update.seconds = 7;
  update.data.assign(36, 100);
  peer->publish_update("/b/map_updates", update);
  EXPECT_TRUE(diagnosed("b", "updates", "1")) << node->lines();
  // It is in the merged map, whose time it is now.
  EXPECT_TRUE(comes_true([&] {
    const std::optional<RawMap> merged = peer->take_map("/merged_map");
    return merged && merged->seconds == 7;
  }));
  update.frame = "a/map";
  peer->publish_update("/b/map_updates", update);
  EXPECT_TRUE(diagnosed("b", "last refusal", "an update in the frame a/map, of a map in b/map"));
  update.frame = "b/map";
  update.x = 1 << 20;
  peer->publish_update("/b/map_updates", update);
  EXPECT_TRUE(diagnosed("b", "last refusal", "an update that reaches beyond its map"));
  update.x = 0;
  Peer stranger(domain);
  stranger.publish_update("/b/map_updates", update);
  EXPECT_TRUE(
      diagnosed("b", "last refusal", "an update by another program than the one that publishes the map"));
  EXPECT_TRUE(diagnosed("b", "updates", "1"));
}

TEST_F(NodeTest, BelievesNoAgeOfAnotherFrame) {
  start();
  merge_two();
  const std::map<std::string, std::string> told = diagnosis("b").values;
  for (const std::string key : {"topic", "frame", "publisher", "heard first"}) {
    ASSERT_TRUE(told.contains(key)) << key;
    std::map<std::string, std::string> wrong = told;
    wrong["heard first"] = "1.000000000";
    wrong[key] = key == "heard first" ? "1e9" : wrong[key] + "0";
    for (int i = 0; i < 3; ++i) peer->publish_diagnosis(wrong);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_TRUE(diagnosed("b", "heard first", told.at("heard first")));
  std::map<std::string, std::string> right = told;
  right["heard first"] = "1.000000000";
  EXPECT_TRUE(comes_true([&] {
    peer->publish_diagnosis(right);
    const auto& all = peer->diagnoses();
    const auto found = all.find("gridmerge: b");
    return found != all.end() && found->second.values.at("heard first") == "1.000000000";
  }));
  // Its frame is the world's now.
  EXPECT_TRUE(comes_true([&] {
    const auto& transforms = peer->transforms();
    return transforms.contains("b/map") && transforms.at("b/map").T_parent_child == SE2{};
  }));
}

TEST_F(NodeTest, NeverHearsMergedMaps) {
  options.patterns = {"/**"};
  options.once = true;
  options.wait = 30.0;
  start();
  const MapTopic left = peer->maps("/a");
  const MapTopic right = peer->maps("/b");
  left.publish(map_of(0, "a"));
  right.publish(map_of(1, "b"));
  // What another gridmerge node publishes has its mark.
  const internal::DdsEntity other = internal::make_writer(
      peer->participant(), internal::kMapType, "rt/other/merged_map", {true, true, 1}, internal::kMergedMark);
  EXPECT_EQ(node->end(), RosNode::End::merged) << node->lines();
  EXPECT_EQ(node->describe().find("merged_map"), std::string::npos) << node->describe();
}

TEST_F(NodeTest, HearsSoManyRobotsAndNoMore) {
  options.team.quiet = std::chrono::milliseconds(0);
  start();
  std::vector<MapTopic> topics;
  for (int i = 0; i < 300; ++i) topics.push_back(peer->maps("/r" + std::to_string(i) + "/map"));
  EXPECT_TRUE(comes_true([&] {
    const auto& all = peer->diagnoses();
    return all.size() == 257 && all.at("gridmerge").values.at("publishers beyond the limit") == "44";
  })) << peer->diagnoses().size();
  EXPECT_TRUE(node->said("are not heard: there are 256 robots"));
  // Who never sent a map makes room for others when it goes.
  topics.erase(topics.begin(), topics.begin() + 100);
  EXPECT_TRUE(comes_true([&] { return peer->diagnoses().size() == 201; })) << peer->diagnoses().size();
}

TEST_F(NodeTest, TellsWhatComesNearWhereThereIsNoMap) {
  options.wait = 2.0;
  start();
  const internal::DdsEntity of_other_type =
      internal::make_writer(peer->participant(), internal::kDiagnosticType, "rt/tb1/map", {true, true, 1});
  const MapTopic elsewhere = peer->maps("/tb2/slam/map");
  const MapTopic silent = peer->maps("/tb3/map");
  const MapTopic wrong = peer->maps("/tb4/map");
  wrong.publish(RawMap{.frame = "", .data = {0}});
  try {
    node->end();
    FAIL() << "it ended without an error";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    for (const char* part :
         {"no map within 2 s", "on /*/map in domain",
          "/tb1/map: is of the type diagnostic_msgs/msg/DiagnosticArray",
          "/tb2/slam/map: is a map, but its name is not one of those",
          "/tb3/map: is there, but nothing was received", "/tb4/map: refused: no frame_id"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " is not in: " << text;
  }
}

TEST_F(NodeTest, EndsOnceAllAreMerged) {
  options.once = true;
  options.wait = 30.0;
  options.robots = {{"left", "/tb1/map"}, {"right", "/x/y"}};
  options.patterns = {};
  start();
  const MapTopic left = peer->maps("/tb1/map");
  const MapTopic right = peer->maps("/x/y");
  left.publish(map_of(0, "l"));
  right.publish(map_of(1, "r"));
  EXPECT_EQ(node->end(), RosNode::End::merged) << node->lines();
  EXPECT_NE(node->describe().find("left: placed at"), std::string::npos);
  EXPECT_TRUE(comes_true([&] { return peer->take_map("/merged_map").has_value(); }));
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
