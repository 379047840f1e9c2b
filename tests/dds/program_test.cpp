// SPDX-License-Identifier: Apache-2.0
// `gridmerge node` as users run it, beside a peer of this process over the loopback interface.
#include "../cli/program.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "dds/environment.hpp"
#include "dds/participant.hpp"
#include "online/explorers.hpp"
#include "peer.hpp"
#include "running_node.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class NodeProgram : public testing::Test {
 protected:
  RawMap map_of(int robot, const std::string& frame) const {
    return raw_map(frame, explorers.map(robot, Explorers::kSteps));
  }

  const std::uint32_t domain = own_domain();
  const Explorers explorers{};
  // Sets the domain up as the program does; both are alike in this process's environment.
  const internal::Participant network{internal::read_ros_environment(internal::process_environment), 1 << 20};
  Peer peer{domain};
};

TEST_F(NodeProgram, EndsWithASignal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    RunningProgram program({"node"});
    Peer listener(domain);
    ASSERT_TRUE(comes_true([&] { return listener.diagnoses().contains("gridmerge"); }));
    const Outcome outcome = program.end_with(signal);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.signal;
    EXPECT_EQ(outcome.out, "hears a map (nav_msgs/msg/OccupancyGrid) on /*/map in domain " +
                               std::to_string(domain) + ", and publishes /merged_map\n");
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(NodeProgram, SaysWhatItWaitsFor) {
  const MapTopic elsewhere = peer.maps("/robot/mapping");
  const Outcome outcome = run({"node", "--wait", "4"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
  EXPECT_TRUE(has(outcome.err,
                  "gridmerge: no map within 4 s: waiting for a map (nav_msgs/msg/OccupancyGrid) on "
                  "/*/map in domain " +
                      std::to_string(domain)))
      << outcome.err;
  EXPECT_TRUE(has(outcome.err, "/robot/mapping: is a map, but its name is not one of those")) << outcome.err;
}

TEST_F(NodeProgram, EndsOnceWithTheExitCodeOfMerge) {
  const MapTopic a = peer.maps("/a/map");
  const MapTopic b = peer.maps("/b/map");
  const MapTopic other = peer.maps("/other/map");
  a.publish(map_of(0, "a/map"));
  b.publish(map_of(1, "b/map"));
  other.publish(map_of(3, "other/map"));
  const Outcome merged =
      run({"node", "--once", "--wait", "30", "--robot", "a=/a/map", "--robot", "b=/b/map", "--verbose"});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_TRUE(has(merged.out, "a: first map: ")) << merged.out;
  EXPECT_TRUE(has(merged.out, "b: placed at x ")) << merged.out;
  EXPECT_TRUE(has(merged.err, "1 merged maps of 2 robots")) << merged.err;
  const Outcome refused = run({"node", "--once", "--wait", "30", "--quiet"});
  EXPECT_EQ(refused.exit_code, 3) << refused.err;
  EXPECT_EQ(count_lines(refused.out), 3u) << refused.out;
  EXPECT_TRUE(has(refused.out, "other: left out: ")) << refused.out;
}

TEST_F(NodeProgram, TakesPosesAsMergeDoes) {
  const TemporaryDirectory directory;
  const std::string init = directory.write("poses.tsv", "map\tx\ty\ttheta\na\t10\t20\t0\n");
  const MapTopic a = peer.maps("/a/map");
  const MapTopic b = peer.maps("/b/map");
  a.publish(map_of(0, "a/map"));
  b.publish(map_of(1, "b/map"));
  const Outcome outcome =
      run({"node", "--once", "--wait", "30", "--quiet", "--init", init, "--fix", "a", "--world", "site"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "a: placed at x 10.000 m, y 20.000 m, theta 0.0000 rad")) << outcome.out;
}

TEST_F(NodeProgram, AgreesWithOthersOnWhoseFrameIsTheWorlds) {
  // `a` is there for who comes later; `b` is heard when it publishes again.
  const MapTopic a = peer.maps("/a/map");
  const MapTopic b = peer.maps("/b/map", false);
  Peer listener(domain);
  const auto hears = [&](const std::string& node, const std::string& robot) {
    const auto& all = listener.diagnoses();
    const auto found = all.find(node + ": " + robot);
    return found != all.end() && found->second.values.contains("heard first");
  };
  const auto takes_frame_of_b = [&](const std::string& world) {
    b.publish(map_of(1, "b/map"));
    const auto& transforms = listener.transforms("/tf");
    const auto found = transforms.find("b/map");
    return found != transforms.end() && found->second.parent == world &&
           found->second.T_parent_child == SE2{};
  };
  const auto node = [](const std::string& name) {
    return RunningProgram({"node", "--tf", "dynamic", "--name", name, "--output", "/" + name + "_map",
                           "--world", name + "_world"});
  };

  RunningProgram first = node("first");
  ASSERT_TRUE(comes_true([&] {
    b.publish(map_of(1, "b/map"));
    return hears("first", "b");
  }));
  a.publish(map_of(0, "a/map"));
  EXPECT_TRUE(comes_true([&] { return takes_frame_of_b("first_world"); }));
  RunningProgram second = node("second");
  ASSERT_TRUE(comes_true([&] { return hears("second", "a") && !hears("second", "b"); }));
  EXPECT_TRUE(comes_true([&] { return takes_frame_of_b("second_world"); }));
  // What was agreed on outlives who said it first.
  EXPECT_EQ(first.end_with(SIGTERM).exit_code, 0);
  RunningProgram third = node("third");
  ASSERT_TRUE(comes_true([&] { return hears("third", "a") && !hears("third", "b"); }));
  EXPECT_TRUE(comes_true([&] { return takes_frame_of_b("third_world"); }));
  EXPECT_EQ(second.end_with(SIGTERM).exit_code, 0);
  EXPECT_EQ(third.end_with(SIGTERM).exit_code, 0);
}

/// A map with everything in it that a peer may get wrong, by chance.
RawMap hostile_map(std::mt19937_64& dice) {
  const auto pick = [&](auto... choices) {
    const std::array all{static_cast<double>(choices)...};
    return all[dice() % all.size()];
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                   kHuge = std::numeric_limits<double>::max();
  RawMap map;
  const char* frames[] = {"", "/", "a map", "x\n\x1b[2J", "tb1/map", "\xff\xfe"};
  map.frame = dice() % 8 == 0 ? std::string(3000, 'f') : frames[dice() % std::size(frames)];
  map.resolution = static_cast<float>(pick(0.05, 0.0, -1.0, kNan, kHuge, 1e-30));
  map.width = static_cast<std::uint32_t>(pick(0, 1, 3, 65536, 4294967295.0, 1 << 30));
  map.height = static_cast<std::uint32_t>(pick(0, 1, 3, 65536, 4294967295.0, 1 << 30));
  map.x = pick(0.0, kNan, kHuge, -kHuge, 1e8);
  map.y = pick(0.0, kNan, kHuge, -kHuge, 1e8);
  map.yaw = pick(0.0, kNan, kHuge, 1.0);
  map.data.assign(dice() % 4 == 0 ? 9 : dice() % 70000, static_cast<std::int8_t>(dice()));
  return map;
}

TEST_F(NodeProgram, SurvivesTenThousandHostileMessages) {
  const MapTopic a = peer.maps("/a/map"), b = peer.maps("/b/map");
  a.publish(map_of(0, "a/map"));
  b.publish(map_of(1, "b/map"));
  RunningProgram program({"node", "--quiet"});
  const auto value = [&](const std::string& status, const std::string& key) -> std::string {
    const auto& all = peer.diagnoses();
    const auto found = all.find(status);
    if (found == all.end() || !found->second.values.contains(key)) return {};
    return found->second.values.at(key);
  };
  ASSERT_TRUE(comes_true([&] { return value("gridmerge", "placed") == "2"; }));

  // More topics than are heard, and more messages than anybody could read.
  constexpr int kTopics = 1000, kMessages = 10000;
  std::vector<MapTopic> topics;
  topics.reserve(kTopics);
  for (int i = 0; i < kTopics; ++i)
    topics.push_back(peer.maps("/rogue" + std::to_string(i) + "/map", i % 2 == 0, i % 3 == 0));
  ASSERT_TRUE(comes_true([&] { return value("gridmerge", "robots") == "256"; }));
  EXPECT_EQ(value("gridmerge", "publishers beyond the limit"), "746");  // of 1000, with 254 beside a and b

  std::mt19937_64 dice(1);
  for (int i = 0; i < kMessages; ++i) {
    topics[dice() % topics.size()].publish(hostile_map(dice));
    RawUpdate update;
    update.x = static_cast<std::int32_t>(dice());
    update.width = static_cast<std::uint32_t>(dice());
    update.data.assign(dice() % 100, static_cast<std::int8_t>(dice()));
    peer.publish_update(i % 2 == 0 ? "/a/map_updates" : "/rogue1/map_updates", update);
  }
  const auto refused = [&] {
    int count = 0;
    for (const auto& [name, diagnosis] : peer.diagnoses())
      if (diagnosis.values.contains("refused")) count += std::stoi(diagnosis.values.at("refused"));
    return count;
  };
  EXPECT_TRUE(comes_true([&] { return refused() > kMessages / 10; })) << refused();
  EXPECT_EQ(value("gridmerge", "placed"), "2");
  EXPECT_LT(program.peak_memory(), 500.0);  // Cyclone DDS keeps a record of each of 1000 writers
  // When they are gone, it hears what is right.
  topics.clear();
  const MapTopic c = peer.maps("/c/map");
  c.publish(map_of(2, "c/map"));
  EXPECT_TRUE(comes_true([&] { return value("gridmerge", "placed") == "3"; }));
  const Outcome outcome = program.end_with(SIGTERM);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.signal;
  EXPECT_EQ(outcome.err.find('\x1b'), std::string::npos);
}

TEST_F(NodeProgram, RefusesPosesThatCannotBeUsed) {
  const TemporaryDirectory directory;
  const std::string init = directory.write("poses.tsv", "map\tx\ty\ttheta\nb\t1\t2\t0\n");
  const Outcome stranger = run({"node", "--robot", "a=/a/map", "--init", init});
  EXPECT_EQ(stranger.exit_code, 1);
  EXPECT_TRUE(has(stranger.err, init)) << stranger.err;
  EXPECT_TRUE(has(stranger.err, "the robot b, which is none of those heard")) << stranger.err;
  const Outcome without_pose = run({"node", "--init", init, "--fix", "a"});
  EXPECT_EQ(without_pose.exit_code, 1);
  EXPECT_TRUE(has(without_pose.err, "--fix a: needs a pose in a table that --init names"))
      << without_pose.err;
  EXPECT_EQ(run({"node", "--init", directory.file("absent.tsv")}).exit_code, 1);
  const Outcome twice = run({"node", "--fix", "a", "--fix", "a"});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_TRUE(has(twice.err, "--fix a: is named twice")) << twice.err;
}

TEST_F(NodeProgram, NamesAVariableThatRosWouldNotTake) {
  RunOptions options;
  options.environment = {"ROS_DOMAIN_ID=233"};
  const Outcome outcome = run({"node"}, options);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_TRUE(has(outcome.err, "gridmerge: ROS_DOMAIN_ID='233'")) << outcome.err;
}

}  // namespace
}  // namespace gridmerge::test
