// SPDX-License-Identifier: Apache-2.0
// What the node makes of what peers send.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "node_fixture.hpp"

namespace gridmerge::test {
namespace {

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

TEST_F(NodeTest, WarnsOnceOfWhoComesWithAWrongMapAgainAndAgain) {
  start();
  for (int times = 0; times < 4; ++times) {
    a.emplace(peer->maps("/a/map"));
    a->publish(map_of(0, ""));
    ASSERT_TRUE(diagnosed("a", "refused", "1"));
    a.reset();
    ASSERT_TRUE(comes_true([&] { return !peer->diagnoses().contains("gridmerge: a"); }));
  }
  EXPECT_EQ(node->times_said("/a/map: a message is refused: "), 1) << node->lines();
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
  topics.reserve(300);
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

}  // namespace
}  // namespace gridmerge::test
