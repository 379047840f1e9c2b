// SPDX-License-Identifier: Apache-2.0
#include "dds/listener.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "dds/discovery.hpp"
#include "dds/environment.hpp"
#include "dds/participant.hpp"
#include "peer.hpp"
#include "running_node.hpp"

namespace gridmerge::internal {
namespace {

using test::comes_true;
using test::MapTopic;
using test::RawMap;

/// A participant as a node has one, and a peer beside it.
class Listening : public testing::Test {
 protected:
  const std::uint32_t domain = test::own_domain();
  const Participant participant{read_ros_environment(process_environment), 1 << 20};
  test::Peer peer{domain};
};

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
                        [](const std::string& text) { ADD_FAILURE() << text; }});
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

}  // namespace
}  // namespace gridmerge::internal
