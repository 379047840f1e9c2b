// SPDX-License-Identifier: Apache-2.0
// Recorded maps that a node publishes again, beside a peer over the loopback interface.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../cli/program.hpp"
#include "bag/bag_builder.hpp"
#include "dds/environment.hpp"
#include "dds/participant.hpp"
#include "online/explorers.hpp"
#include "peer.hpp"
#include "running_node.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

/// The maps of a robot of Explorers, one per second.
class Recording {
 public:
  Recording(std::string topic, int robot, std::string frame = "map")
      : topic_(std::move(topic)), robot_(robot), frame_(std::move(frame)) {}

  /// As a bag: the clock may show anything.
  std::string bag(std::int64_t begin) const {
    std::vector<Recorded> messages;
    for (int step = 1; step <= Explorers::kSteps; ++step)
      messages.push_back(record(topic_, begin + step * kSecond, explorers_.map(robot_, step)));
    return mcap_file(messages);
  }

  PlayedTopic played() const { return played_on(topic_); }

  PlayedTopic played_on(const std::string& topic) const {
    return {topic, "recording of " + topic_, [*this, step = 0]() mutable -> std::optional<PlayedMap> {
              if (step == Explorers::kSteps) return std::nullopt;
              ++step;
              return PlayedMap{static_cast<double>(step), frame_, explorers_.map(robot_, step)};
            }};
  }

 private:
  std::string topic_;
  int robot_;
  std::string frame_;
  Explorers explorers_;
};

class Play : public testing::Test {
 protected:
  Play() {
    options.patterns = {"/*/map"};
    options.play_rate = 10.0;
    options.once = true;
    options.wait = 1.0;
    options.team.quiet = std::chrono::milliseconds(500);
  }

  std::string complaint() const {
    try {
      validate(options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  }

  const std::uint32_t domain = own_domain();
  const Explorers explorers{};
  const Recording a{"/a/map", 0}, b{"/b/map", 1};
  RosNodeOptions options;
};

TEST_F(Play, RecordedMapsAreMergedAsRobotsMapsAre) {
  options.once = false;
  options.played = {a.played(), b.played()};
  RunningNode node(options);
  Peer peer(domain);
  std::optional<RawMap> of_a;
  EXPECT_TRUE(comes_true([&] {  // the last map, not the first one
    if (auto map = peer.take_map("/a/map")) of_a = map;
    return of_a && of_a->data.size() == explorers.map(0, Explorers::kSteps).cells.size();
  }));
  EXPECT_TRUE(
      comes_true([&] { return peer.take_map("/merged_map").has_value() && peer.transforms().size() == 2; }));
  ASSERT_TRUE(of_a);
  EXPECT_EQ(of_a->frame, "a/map");  // both were recorded in the frame "map"
  ASSERT_TRUE(peer.transforms().contains("b/map"));
  const SE2 expected = explorers.between(0, 1);
  const SE2 T_world_b = peer.transforms().at("b/map").T_parent_child;
  EXPECT_NEAR(T_world_b.x, expected.x, 0.1);
  EXPECT_NEAR(normalize_angle(T_world_b.theta - expected.theta), 0.0, 0.02);
}

TEST_F(Play, OnceDoesNotEndBeforeTheRecordings) {
  options.play_rate = 2.0;  // the last maps come after 2 s, which is longer than it waits
  options.played = {a.played(), b.played()};
  const auto asked = std::make_shared<int>(0);
  options.played.front().next = [next = a.played().next, asked] {
    ++*asked;
    return next();
  };
  RunningNode node(options);
  EXPECT_EQ(node.end(), RosNode::End::merged) << node.lines();
  EXPECT_EQ(*asked, Explorers::kSteps + 1);
}

TEST_F(Play, EndsAmongMapsThatAreDueAtOnce) {
  options.once = false;
  std::atomic<bool> stopped = false;
  std::atomic<int> asked = 0, asked_in_vain = 0;
  options.played = {a.played()};
  options.played.front().next = [&, map = explorers.map(0, 1)]() -> std::optional<PlayedMap> {
    ++asked;
    if (stopped && ++asked_in_vain > 100) return std::nullopt;  // or the test would never end
    return PlayedMap{0.0, "map", map};
  };
  RunningNode node(options);
  ASSERT_TRUE(comes_true([&] { return asked > 1; }));
  std::thread late([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // stop() has come to the node by then
    stopped = true;
  });
  EXPECT_EQ(node.stop(), RosNode::End::stopped);
  late.join();
  EXPECT_EQ(asked_in_vain, 0);
}

TEST_F(Play, FramesThatDifferAreKept) {
  options.once = false;
  options.played = {a.played(), Recording("/b/map", 1, "site").played()};
  RunningNode node(options);
  Peer peer(domain);
  EXPECT_TRUE(comes_true([&] { return peer.transforms().size() == 2; }));
  EXPECT_TRUE(peer.transforms().contains("map") && peer.transforms().contains("site"));
}

/// Two maps of a robot, at these seconds.
PlayedTopic two_maps(const std::string& topic, int robot, double first, double second,
                     const std::string& recording, const std::string& second_frame = "map") {
  const auto next = [=, step = 0]() mutable -> std::optional<PlayedMap> {
    if (step++ == 2) return std::nullopt;
    const OccupancyGrid map = Explorers().map(robot, Explorers::kSteps - 2 + step);
    return step == 1 ? PlayedMap{first, "map", map} : PlayedMap{second, second_frame, map};
  };
  return {topic, recording + topic, next, recording};
}

TEST_F(Play, TopicsOfARecordingKeepTheirDistanceInTime) {
  options.once = false;
  options.play_rate = 1.0;
  options.played = {two_maps("/a/map", 0, 1000.0, 1000.5, "team"),
                    two_maps("/b/map", 1, 1002.0, 1003.0, "team"),
                    two_maps("/c/map", 2, 5.0, 6.0, "another")};
  const auto began = std::chrono::steady_clock::now();
  RunningNode node(options);
  ASSERT_TRUE(comes_true([&] { return node.said("a: first map") && node.said("c: first map"); }));
  EXPECT_FALSE(node.said("b: first map")) << node.lines();
  ASSERT_TRUE(comes_true([&] { return node.said("b: first map"); }));
  EXPECT_GE(std::chrono::steady_clock::now() - began, std::chrono::seconds(2));
}

/// As where the recorder's clock was set while it recorded.
TEST_F(Play, AGapOfDecadesIsPassedOver) {
  options.play_rate = 1.0;
  options.played = {two_maps("/a/map", 0, 1000.0, 1.7e9, "first"), two_maps("/b/map", 1, 0.0, 1.0, "second")};
  RunningNode node(options);
  EXPECT_EQ(node.end(), RosNode::End::merged) << node.lines();
  EXPECT_TRUE(node.said("first/a/map: there is no map for 1699999000 s, which are passed over"))
      << node.lines();
}

TEST_F(Play, EachMapHasItsOwnFrame) {
  options.once = false;
  options.played = {two_maps("/a/map", 0, 0.0, 1.0, "first", "odom"),
                    two_maps("/b/map", 1, 0.0, 1.0, "second")};
  RunningNode node(options);
  Peer peer(domain);
  EXPECT_TRUE(comes_true([&] { return peer.transforms().contains("a/odom"); })) << node.lines();
  EXPECT_TRUE(node.said("a: started anew"));
}

TEST_F(Play, WhatCannotBePlayedIsSaid) {
  options.played = {a.played(), a.played()};
  EXPECT_EQ(complaint(), "recording of /a/map and recording of /a/map would both be played on /a/map");
  options.played = {a.played_on("/deep/a/map")};
  EXPECT_EQ(complaint().rfind("recording of /a/map: its topic /deep/a/map is not a map", 0), 0u)
      << complaint();
  options.played = {a.played_on("map")};
  EXPECT_EQ(complaint(), "recording of /a/map: 'map' is no whole name of a topic, as /tb1/map is");
  options.played = {a.played()};
  for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    options.play_rate = rate;
    EXPECT_EQ(complaint(), "maps are played at a rate above 0") << rate;
  }
  options.play_rate = 1.0;
  EXPECT_EQ(complaint(), "");
  options.played.front().next = [] { return std::optional<PlayedMap>(); };
  EXPECT_THROW(RosNode{options}, std::runtime_error);
}

TEST_F(Play, TheProgramPlaysBags) {
  const internal::Participant network(internal::read_ros_environment(internal::process_environment), 1 << 20);
  const TemporaryDirectory directory;
  // Recorded on different days, one on /map.
  const std::string first = directory.write("tb-1.mcap", Recording("/map", 0).bag(1'000'000 * kSecond));
  const std::string second = directory.write("two.mcap", Recording("/tb2/map", 1).bag(7 * kSecond));
  const Outcome outcome =
      run({"node", "--bag", first, "--bag", second, "--rate", "10", "--once", "--wait", "1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("tb_1: placed at "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("tb2: placed at "), std::string::npos) << outcome.out;
}

TEST_F(Play, TheProgramPlaysTheTopicsOfABagAsTheyWereRecorded) {
  const internal::Participant network(internal::read_ros_environment(internal::process_environment), 1 << 20);
  const TemporaryDirectory directory;
  const OccupancyGrid map = explorers.map(0, 1);
  const std::string bag = directory.write(
      "team.mcap", mcap_file({record("/tb1/map", 1'700'000'000 * kSecond, map),
                              record("/tb2/map", 1'700'000'060 * kSecond, explorers.map(1, 1))}));
  RunningProgram program({"node", "--bag", bag});
  program.read_line();
  EXPECT_EQ(program.read_line().rfind("tb1: first map", 0), 0u);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(program.end_with(SIGTERM).out.find("tb2"), std::string::npos);
}

TEST_F(Play, TheProgramEndsAtASignalWhileItReads) {
  const internal::Participant network(internal::read_ros_environment(internal::process_environment), 1 << 20);
  const TemporaryDirectory directory;
  std::vector<Recorded> messages;
  const OccupancyGrid map = explorers.map(0, Explorers::kSteps);
  for (int i = 0; i < 3000; ++i) messages.push_back(record("/tb1/map", i, map));  // due at once
  const std::string bag = directory.write("many.mcap", mcap_file(messages, {.compression = "zstd"}));
  RunningProgram program({"node", "--bag", bag});
  EXPECT_NE(program.read_line(), "");
  EXPECT_EQ(program.end_with(SIGTERM).exit_code, 0);
}

TEST_F(Play, BagsThatCannotBePlayedAreErrors) {
  const TemporaryDirectory directory;
  const std::string costmap = directory.write("costmap.mcap", Recording("/tb1/local/costmap", 0).bag(0));
  const std::string good = directory.write("good.mcap", Recording("/tb1/map", 0).bag(0));
  const auto fails = [](const std::vector<std::string>& arguments, const std::string& message) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 1) << message;
    EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
  };
  fails({"node", "--bag", directory.file("absent.mcap")}, "absent.mcap: No such file or directory");
  fails({"node", "--bag", costmap}, "has maps on /tb1/local/costmap only; --pattern says");
  fails({"node", "--bag", good, "--bag", good}, "would both be played on /tb1/map");
  for (const char* rate : {"0", "-1", "x", "nan", "inf"})
    EXPECT_EQ(run({"node", "--bag", good, "--rate", rate}).exit_code, 2) << rate;
  EXPECT_EQ(run({"node", "--rate", "2"}).exit_code, 2);
}

TEST_F(Play, DamagedMessagesArePassedOver) {
  const internal::Participant network(internal::read_ros_environment(internal::process_environment), 1 << 20);
  const TemporaryDirectory directory;
  const std::vector<Recorded> messages{record("/tb1/map", kSecond, explorers.map(0, Explorers::kSteps)),
                                       {"/tb1/map", 2 * kSecond, "no such message"},
                                       record("/tb2/map", 2 * kSecond, explorers.map(1, Explorers::kSteps))};
  const std::string bag = directory.write("both.mcap", mcap_file(messages));
  const Outcome outcome = run({"node", "--bag", bag, "--rate", "10", "--once", "--wait", "1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("both.mcap"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace gridmerge::test
