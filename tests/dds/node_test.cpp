// SPDX-License-Identifier: Apache-2.0
// The node beside peers of its own process: nothing goes over a network.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "node_fixture.hpp"

namespace gridmerge::test {
namespace {

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

TEST_F(NodeTest, PublishesTransformsOnTfTenTimesPerSecondHoweverOftenItHears) {
  options.transforms = TransformTopic::tf;
  start();
  merge_two();
  ASSERT_TRUE(comes_true([&] { return peer->transforms("/tf").size() == 2; }));
  const std::uint64_t before = peer->transform_messages();
  RawUpdate update;
  update.frame = "b/map";
  const auto began = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - began < std::chrono::seconds(2)) {
    update.data[0] = update.data[0] == 0 ? 100 : 0;
    peer->publish_update("/b/map_updates", update);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    peer->transforms("/tf");
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  EXPECT_LE(static_cast<double>(peer->transform_messages() - before), 10 * took.count() + 2);
  EXPECT_GT(peer->transform_messages(), before);
}

TEST_F(NodeTest, GivesAMergedMapTheTimeOfTheMapsInIt) {
  start();
  merge_two();
  const MapTopic other = peer->maps("/other/map");
  RawMap far = map_of(3, "other/map");  // another building, and another clock
  far.seconds = 1'000'000;
  other.publish(far);
  ASSERT_TRUE(diagnosed("other", "state", "left_out")) << node->lines();
  RawMap map = map_of(1, "b/map");
  map.seconds = 8;
  map.data[map.height / 2 * map.width + map.width / 2] = 100;
  b->publish(map);
  ASSERT_TRUE(comes_true([&] {
    const std::optional<RawMap> merged = peer->take_map("/merged_map");
    return merged && merged->seconds != 1;
  })) << node->lines();
  EXPECT_EQ(peer->take_map("/merged_map")->seconds, 8);
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
  EXPECT_TRUE(late.transforms().empty());  // nor where they lay
}

TEST_F(NodeTest, TakesAnotherFrameForARobotThatStartedAnew) {
  start();
  merge_two();
  b->publish(map_of(1, "b/map_2"));
  EXPECT_TRUE(comes_true([&] { return node->said("b: started anew"); })) << node->lines();
  EXPECT_TRUE(diagnosed("b", "frame", "b/map_2"));
}

TEST_F(NodeTest, AsksWhetherTwoRobotsHaveOneTopic) {
  start();
  const MapTopic topic = peer->maps("/a/map");
  constexpr int kMessages = 20;
  int restarts = 0;
  for (const bool in_one_frame : {false, true}) {
    for (int i = 0; i < kMessages; ++i) {
      const bool is_first = i % 2 == 0;
      topic.publish(map_of(is_first ? 0 : 3, in_one_frame || is_first ? "one" : "another"));
      ASSERT_TRUE(diagnosed("a", "maps", std::to_string((in_one_frame ? kMessages : 0) + i + 1)));
    }
    ASSERT_TRUE(comes_true([&] {
      return node->said("a: it starts anew again and again: do two robots publish on /a/map?");
    })) << node->lines();
    EXPECT_LE(node->times_said("started anew"), 6) << node->lines();
    EXPECT_TRUE(comes_true([&] {
      return std::stoi(diagnosis("a").values.at("started anew")) >= restarts + 4;
    })) << node->lines();
    restarts = std::stoi(diagnosis("a").values.at("started anew"));
    EXPECT_NE(diagnosis("a").message.find("do two robots publish on /a/map?"), std::string::npos);
    EXPECT_EQ(diagnosis("a").level, 1);
  }
  EXPECT_LE(node->times_said("again and again"), 2);
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

TEST_F(NodeTest, KeepsTheNumbersOfMergedMaps) {
  start();
  merge_two();
  // A larger team in another building.
  const OccupancyGrid building = draw_building(2);
  const Window windows[] = {{0, 0, 12, 13}, {5, 0, 18, 13}, {0, 3, 18, 13}};
  std::vector<MapTopic> others;
  for (int i = 0; i < 3; ++i) {
    const std::string robot(1, static_cast<char>('c' + i));
    others.push_back(peer->maps("/" + robot + "/map"));
    others.back().publish(raw_map(robot + "/map", map_part(building, windows[i], {2.0 * i, 1.0, 0.4 * i})));
  }
  ASSERT_TRUE(diagnosed("c", "component", "2")) << node->lines();
  ASSERT_TRUE(diagnosed("e", "component", "2")) << node->lines();
  EXPECT_EQ(diagnosis("a").values["component"], "1");
  EXPECT_TRUE(comes_true([&] { return peer->transforms().size() == 5; }));
  EXPECT_EQ(peer->transforms().at("a/map").parent, "world");
  EXPECT_EQ(peer->transforms().at("c/map").parent, "world_2");
  // With the first two apart, the second merged map stays where it is.
  b->publish(raw_map("b/map", make_grid(50, 50, 0.05)));
  ASSERT_TRUE(diagnosed("a", "state", "left_out")) << node->lines();
  Peer late(domain);
  ASSERT_TRUE(comes_true([&] { return late.take_map("/merged_map_2").has_value(); }));
  EXPECT_EQ(late.take_map("/merged_map_2")->frame, "world_2");
  EXPECT_FALSE(late.take_map("/merged_map").has_value());
  EXPECT_EQ(peer->transforms().at("c/map").parent, "world_2");
}

TEST_F(NodeTest, DiagnosesNotAsFastAsAnswersCome) {
  start();
  merge_two();
  const auto received = [&] { return peer->diagnoses().at("gridmerge").received; };
  RawMap map = map_of(1, "b/map");
  const std::uint64_t before = received();
  const auto began = std::chrono::steady_clock::now();
  std::chrono::duration<double> passed{};
  for (int i = 0; passed.count() < 2.0; ++i) {
    map.data[static_cast<std::size_t>(i) % map.data.size()] = i % 2 == 0 ? 100 : 0;
    b->publish(map);
    received();  // the newest alone is kept
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    passed = std::chrono::steady_clock::now() - began;
  }
  EXPECT_LE(static_cast<double>(received() - before), 4.0 * passed.count() + 2.0);
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

}  // namespace
}  // namespace gridmerge::test
