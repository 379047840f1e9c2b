// SPDX-License-Identifier: Apache-2.0
#include "dds/listener.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dds/discovery.hpp"
#include "dds/environment.hpp"
#include "dds/participant.hpp"
#include "dds/player.hpp"
#include "peer.hpp"
#include "running_node.hpp"

namespace gridmerge::internal {
namespace {

using test::comes_true;
using test::MapTopic;
using test::RawMap;
using test::RawUpdate;

/// A participant as a node has one, and a peer beside it.
class Listening : public testing::Test {
 protected:
  const std::uint32_t domain = test::own_domain();
  const Participant participant{read_ros_environment(process_environment), 1 << 20};
  test::Peer peer{domain};
};

/// What a listener heard of the robot `a`, and hears on.
class HeardByListener : public Listening {
 protected:
  /// Hears until something holds of the robot.
  bool hears(const std::function<bool(const HeardRobot&)>& holds) {
    return comes_true([&] {
      listener.hear();
      const std::vector<HeardRobot> robots = listener.robots();
      return robots.size() == 1 && holds(robots.front());
    });
  }
  bool hears_maps(std::uint64_t count) {
    return hears([&](const HeardRobot& robot) { return robot.maps == count; });
  }

  std::vector<std::string> told;  // "map tb1/map", "new map tb1/map", "update of 3 cells"
  std::vector<std::string> warnings;
  const DdsEntity waitset{dds_create_waitset(participant.get()), "a wait set"};
  MapListener listener{participant,
                       waitset.get(),
                       RobotSelection({"/*/map"}, {}),
                       {[&](const std::string&, const HeardMap& map, bool is_new) {
                          told.push_back((is_new ? "new map " : "map ") + map.frame);
                        },
                        [&](const std::string&, const HeardPart& part) {
                          if (part.x > 0) return false;  // the maps of these tests have one cell
                          told.push_back("update of " + std::to_string(part.grid.cells.size()) + " cells");
                          return true;
                        },
                        [&](const std::string&, const std::string& text) { warnings.push_back(text); }}};
};

using Told = std::vector<std::string>;

/// The topics of which discovery tells until it tells of this one: one for each writer.
std::multiset<std::string> told_until(Discovery& discovery, const std::string& last) {
  std::multiset<std::string> told;
  EXPECT_TRUE(comes_true([&] {
    for (const WriterEvent& event : discovery.take()) told.insert(event.writer.topic);
    return told.contains(last);
  }));
  return told;
}

TEST_F(Listening, TellsOfItsOwnWritersOnlyWhatIsPlayed) {
  const TopicQos qos{true, true, 1};
  const DdsEntity own = make_writer(participant.get(), kMapType, "rt/own/map", qos);
  const DdsEntity played = make_writer(participant.get(), kMapType, "rt/played/map", qos, kPlayedMark);
  const MapTopic last = peer.maps("/tb1/map");
  Discovery discovery(participant.get(), participant.guid());
  EXPECT_EQ(told_until(discovery, "/tb1/map"), (std::multiset<std::string>{"/played/map", "/tb1/map"}));
}

TEST_F(Listening, TellsOfNoTopicThatIsNotOfRos) {
  const TopicQos qos{true, true, 1};
  const DdsEntity plain = make_writer(peer.participant(), kMapType, "tb0/map", qos);
  const MapTopic last = peer.maps("/tb1/map");
  Discovery discovery(participant.get(), participant.guid());
  EXPECT_EQ(told_until(discovery, "/tb1/map"), (std::multiset<std::string>{"/tb1/map"}));
}

/// A map may be here before it is known that somebody publishes it, and is sent once.
TEST_F(Listening, HearsAMapOfAPublisherThatCameInBetween) {
  const DdsEntity waitset(dds_create_waitset(participant.get()), "a wait set");
  const MapTopic a = peer.maps("/a/map"), silent = peer.maps("/b/map");
  std::optional<MapTopic> late;  // comes after it was asked who is there, and before /b/map is listened to
  const auto take = [&](const std::string& robot, const HeardMap&, bool) {
    if (robot != "a") return;
    late.emplace(peer.maps("/b/map"));
    late->publish(RawMap{.frame = "b"});
  };
  MapListener listener(participant, waitset.get(), RobotSelection({"/*/map"}, {}),
                       {take, [](const std::string&, const HeardPart&) { return true; },
                        [](const std::string&, const std::string& text) { ADD_FAILURE() << text; }});
  ASSERT_TRUE(comes_true([&] {
    listener.hear();
    return listener.robots().size() == 2;
  }));
  a.publish(RawMap{.frame = "a"});
  const auto maps_of = [&](std::size_t robot) { return listener.robots().at(robot).maps; };
  ASSERT_TRUE(comes_true([&] {
    listener.hear();
    return maps_of(0) == 1;
  }));
  EXPECT_EQ(maps_of(1), 1u);
  EXPECT_EQ(listener.robots().at(1).publishers, 2u);
}

TEST_F(HeardByListener, APublisherThatTakesOverIsHeardWithWhatItSentBefore) {
  test::Peer second(domain), third(domain);
  std::optional<MapTopic> first = peer.maps("/a/map");
  first->publish(RawMap{.frame = "first"});
  ASSERT_TRUE(hears_maps(1));
  // Once each, while the first one is heard.
  std::optional<MapTopic> other = second.maps("/a/map");
  other->publish(RawMap{.frame = "second"});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 1; }));
  std::optional<MapTopic> last = third.maps("/a/map");
  last->publish(RawMap{.frame = "third"});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 2; }));
  third.publish_update("/a/map_updates", {.frame = "third"});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 3; }));
  EXPECT_EQ(told, (Told{"map first"}));
  first.reset();
  ASSERT_TRUE(hears_maps(2));
  EXPECT_EQ(told, (Told{"map first", "new map third", "update of 1 cells"}));
  last.reset();
  ASSERT_TRUE(hears_maps(3));
  EXPECT_EQ(told.back(), "new map second");
  // Who is gone takes over nothing.
  last = third.maps("/a/map");
  last->publish(RawMap{.frame = "third"});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 4; }));
  last.reset();
  other.reset();
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.publishers == 0; }));
  EXPECT_EQ(told.back(), "new map second");
  EXPECT_EQ(warnings.size(), 1u);  // of several publishers
}

TEST_F(HeardByListener, UpdatesCountInTheOrderInWhichTheyWereWritten) {
  const MapTopic a = peer.maps("/a/map");
  a.publish(RawMap{.frame = "a", .seconds = 100});
  ASSERT_TRUE(hears_maps(1));
  // Whatever time they bear: none, as of some costmaps, or one of before the simulated time began anew.
  for (const std::int32_t seconds : {0, 3, 101}) peer.publish_update("/a/map_updates", {"a", seconds});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.parts == 3; }));
  // One that was written before the map is in it.
  RawUpdate old{"a", 102};
  old.written = dds_time() - DDS_SECS(60);
  peer.publish_update("/a/map_updates", old);
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.outdated == 1; }));
  EXPECT_EQ(listener.robots().front().parts, 3u);
  // A clock that was set back mutes no publisher for good.
  EXPECT_TRUE(hears([&](const HeardRobot& robot) {
    peer.publish_update("/a/map_updates", old);
    return robot.parts > 3;
  }));
  EXPECT_EQ(warnings, Told{});
}

/// As publishers of some middlewares are: DDS lets a message go without the time at which it was written.
TEST_F(HeardByListener, APublisherThatDoesNotSayWhenItWrote) {
  const MapTopic a = peer.maps("/a/map");
  for (const std::uint64_t count : {1u, 2u, 3u}) {
    a.publish(RawMap{.frame = "a", .written = 0});
    ASSERT_TRUE(hears_maps(count));
  }
  a.publish(RawMap{.frame = "a"});
  ASSERT_TRUE(hears_maps(4));
  peer.publish_update("/a/map_updates", {.frame = "a", .written = 0});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.parts == 1; }));
  EXPECT_EQ(listener.robots().front().outdated, 0u);
}

TEST_F(HeardByListener, AWrongUpdateOfAPublisherThatTakesOverHoldsNoOtherBack) {
  test::Peer second(domain);
  std::optional<MapTopic> first = peer.maps("/a/map");
  first->publish(RawMap{.frame = "first"});
  ASSERT_TRUE(hears_maps(1));
  const MapTopic other = second.maps("/a/map");
  other.publish(RawMap{.frame = "second"});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 1; }));
  for (const std::int32_t x : {0, 1, 0}) second.publish_update("/a/map_updates", {.frame = "second", .x = x});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 4; }));
  first.reset();
  ASSERT_TRUE(hears_maps(2));
  EXPECT_EQ(told, (Told{"map first", "new map second", "update of 1 cells", "update of 1 cells"}));
  EXPECT_EQ(listener.robots().front().refused, 1u);
}

TEST_F(HeardByListener, AfterTheNetworkWasJoinedAnewThePublisherIsWaitedFor) {
  test::Peer second(domain);
  std::optional<MapTopic> first = peer.maps("/a/map");
  first->publish(RawMap{.frame = "first"});
  ASSERT_TRUE(hears_maps(1));
  const MapTopic other = second.maps("/a/map");
  other.publish(RawMap{.frame = "second"});
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.unheard == 1; }));
  // Whichever is discovered first.
  for (int times = 0; times < 5; ++times) {
    listener.leave();
    listener.join(participant);
    EXPECT_TRUE(listener.robots().front().awaited);
    ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.publishers == 2; }));
    EXPECT_FALSE(listener.robots().front().awaited);
  }
  EXPECT_EQ(told, Told{"map first"});
  // One that went meanwhile is not waited for in vain.
  listener.leave();
  first.reset();
  listener.join(participant);
  const auto joined = std::chrono::steady_clock::now();
  ASSERT_TRUE(hears([](const HeardRobot& robot) { return robot.publishers == 1; }));
  second.publish_update("/a/map_updates", {.frame = "second"});
  ASSERT_TRUE(hears_maps(2));
  EXPECT_GE(std::chrono::steady_clock::now() - joined, MapListener::kAwaited - std::chrono::milliseconds(50));
  EXPECT_EQ(told, (Told{"map first", "new map second", "update of 1 cells"}));
  EXPECT_EQ(warnings.size(), 1u);  // of several publishers
}

TEST(AnotherParticipant, TakesOverWhatIsHeardAndPlayed) {
  test::own_domain();
  const RosEnvironment environment = read_ros_environment(process_environment);
  std::optional<Participant> participant(std::in_place, environment, 1 << 20);
  const DdsEntity waitset(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "a wait set");
  const auto next = [is_first = true]() mutable -> std::optional<PlayedMap> {
    if (!std::exchange(is_first, false)) return std::nullopt;
    PlayedMap map{0.0, "a", {}};
    map.grid.width = map.grid.height = 1;
    map.grid.cells = {Cell::free};
    return map;
  };
  const auto fail = [](const std::string& text) { ADD_FAILURE() << text; };
  Player player(*participant, {{"/a/map", "a recording", next}}, 1.0, fail);
  Told told;
  const auto take = [&](const std::string&, const HeardMap& map, bool is_new) {
    told.push_back((is_new ? "new map " : "map ") + map.frame);
  };
  MapListener listener(*participant, waitset.get(), RobotSelection({"/*/map"}, {}),
                       {take, [](const std::string&, const HeardPart&) { return true; },
                        [&](const std::string&, const std::string& text) { fail(text); }});
  const auto hears = [&](std::size_t count) {
    return comes_true([&] {
      player.play(0.0);
      listener.hear();
      return told.size() == count;
    });
  };
  ASSERT_TRUE(hears(1));
  listener.leave();
  player.leave();
  participant.reset();
  EXPECT_EQ(listener.robots().front().publishers, 0u);
  participant.emplace(environment, 1 << 20);
  player.join(*participant);
  listener.join(*participant);
  ASSERT_TRUE(hears(2));
  EXPECT_EQ(told, (Told{"map a", "map a"}));  // the robot did not start anew
  EXPECT_EQ(listener.robots().front().maps, 2u);
}

}  // namespace
}  // namespace gridmerge::internal
