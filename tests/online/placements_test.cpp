// SPDX-License-Identifier: Apache-2.0
#include "online/placements.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "online/status.hpp"

namespace gridmerge::internal {
namespace {

const std::map<std::string, MapExtent> kExtents{
    {"a", {{0, 0}, 5, 15}}, {"b", {{0, 0}, 5, 15}}, {"c", {{0, 0}, 5, 15}}, {"d", {{0, 0}, 5, 15}}};
const std::set<std::string> kAll{"a", "b", "c", "d"};
constexpr auto kPartial = Placements::Weight::partial, kFull = Placements::Weight::full,
               kConclusive = Placements::Weight::conclusive;

/// a at the identity and b so far from it [m].
RobotGroup pair_at(double distance, const std::string& first = "a", const std::string& second = "b") {
  return {{{first, {{}, 0.99}}, {second, {{distance, 0, 0}, 0.99}}}, false};
}

double distance_of(const Placements& placements, const std::string& robot) {
  for (const RobotGroup& group : placements.groups()) {
    if (const auto found = group.robots.find(robot); found != group.robots.end())
      return found->second.T_group_map.x;
  }
  return -1.0;
}

TEST(Placements, FollowWhatContradictsNothing) {
  Placements placements(3);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 10.0);
  placements.propose({pair_at(10.1)}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 10.1);
  EXPECT_FALSE(placements.is_held_back());
}

TEST(Placements, MoveWhenConfirmedOftenEnough) {
  Placements placements(3);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  for (int i = 0; i < 2; ++i) {
    placements.propose({pair_at(15.0 + 0.1 * i)}, kAll, kExtents, kFull);
    EXPECT_EQ(distance_of(placements, "b"), 10.0);
    EXPECT_TRUE(placements.is_held_back());
  }
  placements.propose({pair_at(15.2)}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 15.2);
  EXPECT_FALSE(placements.is_held_back());
}

TEST(Placements, OtherPlacesEachTimeConfirmNothing) {
  Placements placements(3);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  for (int i = 0; i < 6; ++i) placements.propose({pair_at(i % 2 == 0 ? 15.0 : 20.0)}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 10.0);
}

TEST(Placements, AReturnStartsTheCountAnew) {
  Placements placements(3);
  for (const double distance : {10.0, 15.0, 15.0, 10.0, 15.0, 15.0})
    placements.propose({pair_at(distance)}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 10.0);
  placements.propose({pair_at(15.0)}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 15.0);
}

TEST(Placements, WithoutNewerMapsNothingIsConfirmed) {
  Placements placements(3);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  for (int i = 0; i < 5; ++i) placements.propose({pair_at(15.0)}, {"c"}, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 10.0);
  placements.propose({pair_at(15.0)}, {}, kExtents, kConclusive);  // conclusive
  EXPECT_EQ(distance_of(placements, "b"), 15.0);
}

TEST(Placements, APairThatIsNoLongerSureLeavesWhenConfirmed) {
  Placements placements(2);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  placements.propose({}, kAll, kExtents, kFull);
  EXPECT_EQ(placements.groups().size(), 1u);
  placements.propose({}, kAll, kExtents, kFull);
  EXPECT_TRUE(placements.groups().empty());
}

TEST(Placements, OthersGoOnMeanwhile) {
  Placements placements(3);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  placements.propose({pair_at(15.0), pair_at(7.0, "c", "d")}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "b"), 10.0);
  EXPECT_EQ(distance_of(placements, "d"), 7.0);
  // A newcomer to a group that is held back waits with it.
  RobotGroup three = pair_at(15.0);
  three.robots["c"] = {{3.0, 0, 0}, 0.99};
  placements = Placements(3);
  placements.propose({pair_at(10.0)}, kAll, kExtents, kFull);
  placements.propose({three}, kAll, kExtents, kFull);
  EXPECT_EQ(distance_of(placements, "c"), -1.0);
}

TEST(Placements, WhatAPartialProposalDoesNotSayStays) {
  Placements placements(2);
  RobotGroup three = pair_at(10.0);
  three.robots["c"] = {{3.0, 0, 0}, 0.9};
  placements.propose(
      {
          three,
      },
      kAll, kExtents, kFull);
  for (int i = 0; i < 4; ++i) {
    // c is not looked at, and d is new; the frame is another one.
    RobotGroup others{{{"a", {{1.0, 0, 0}, 0.99}}, {"b", {{11.0, 0, 0}, 0.99}}, {"d", {{5.0, 0, 0}, 0.99}}},
                      false};
    placements.propose({others}, kAll, kExtents, kPartial);
    EXPECT_EQ(distance_of(placements, "c"), 4.0);
    EXPECT_EQ(distance_of(placements, "d"), 5.0);
    EXPECT_FALSE(placements.is_held_back());
  }
  placements.propose({}, kAll, kExtents, kPartial);
  EXPECT_EQ(placements.groups().size(), 1u);
  EXPECT_EQ(distance_of(placements, "b"), 11.0);
  // Elsewhere is a contradiction all the same, apart is one when all was looked at.
  placements.propose({pair_at(20.0)}, kAll, kExtents, kPartial);
  EXPECT_TRUE(placements.is_held_back());
  placements.propose({pair_at(20.0)}, kAll, kExtents, kPartial);
  EXPECT_EQ(distance_of(placements, "b"), 20.0);
  placements.propose({}, kAll, kExtents, kFull);
  placements.propose({}, kAll, kExtents, kFull);
  EXPECT_TRUE(placements.groups().empty());
}

TEST(Placements, WhoIsForgottenLiesNowhere) {
  Placements placements(3);
  RobotGroup three = pair_at(10.0);
  three.robots["c"] = {{3.0, 0, 0}, 0.99};
  placements.propose({three}, kAll, kExtents, kFull);
  placements.forget("b");
  EXPECT_EQ(distance_of(placements, "b"), -1.0);
  EXPECT_EQ(distance_of(placements, "c"), 3.0);
  placements.forget("c");
  EXPECT_TRUE(placements.groups().empty());
  placements.propose({pair_at(20.0)}, kAll, kExtents, kFull);  // contradicts nothing
  EXPECT_EQ(distance_of(placements, "b"), 20.0);
}

TEST(Placements, WhoIsForgottenTakesWhatWasSaidAgainstHimAlong) {
  Placements placements(3);
  const auto propose = [&](double distance) {
    placements.propose({pair_at(distance), pair_at(7.0, "c", "d")}, kAll, kExtents, kFull);
    return distance_of(placements, "b");
  };
  for (const std::string robot : {"a", "b"}) {
    for (const double distance : {10.0, 15.0, 15.0}) propose(distance);
    placements.forget(robot);
    EXPECT_EQ(propose(10.0), 10.0) << "contradicts nothing";
    for (int i = 0; i < 2; ++i) EXPECT_EQ(propose(15.0), 10.0) << robot << " is confirmed anew";
    EXPECT_EQ(propose(15.0), 15.0) << robot;
    placements.forget(robot);
  }
  // What others say of each other stands.
  for (const double distance : {10.0, 15.0, 15.0}) propose(distance);
  placements.forget("c");
  EXPECT_EQ(propose(15.0), 15.0);
}

/// Whatever is proposed, each robot lies in one group at most, of two robots or more, and what is conclusive
/// is what there is.
TEST(Placements, AnyProposalsLeaveGroupsApart) {
  rc::check([] {
    Placements placements(*rc::gen::inRange(1, 4));
    const int rounds = *rc::gen::inRange(1, 12);
    for (int i = 0; i < rounds; ++i) {
      std::map<int, RobotGroup> drawn;
      std::set<std::string> fresh;
      for (const std::string& robot : kAll) {
        const int group = *rc::gen::inRange(0, 3);
        drawn[group].robots[robot] = {{4.0 * *rc::gen::inRange(0, 4), 0, 0}, 0.99};
        if (*rc::gen::arbitrary<bool>()) fresh.insert(robot);
      }
      std::vector<RobotGroup> proposed;
      for (const auto& [number, group] : drawn) {
        if (group.robots.size() > 1) proposed.push_back(group);
      }
      const auto weight = *rc::gen::element(Placements::Weight::partial, kFull, kConclusive);
      placements.propose(proposed, fresh, kExtents, weight);
      std::set<std::string> seen;
      for (const RobotGroup& group : placements.groups()) {
        RC_ASSERT(group.robots.size() > 1);
        for (const auto& [robot, placement] : group.robots) RC_ASSERT(seen.insert(robot).second);
      }
      if (weight == kConclusive) {
        RC_ASSERT(!placements.is_held_back());
        RC_ASSERT(placements.groups().size() == proposed.size());
      }
    }
  });
}

TEST(Changes, NameARobotThatStartedAnewToWhoLeavesIt) {
  const std::vector<TeamEvent> events = changes_between({pair_at(10.0)}, {}, kExtents, {"a"});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].robot, "b");
  EXPECT_EQ(events[0].text, "b is no longer sure to lie with a");
}

TEST(Changes, ANewFrameIsNoJump) {
  RobotGroup before = pair_at(10.0), now = pair_at(50.0);
  EXPECT_EQ(changes_between({before}, {now}, kExtents, {}).size(), 2u);  // either may have jumped
  const std::vector<TeamEvent> events = changes_between({before}, {now}, kExtents, {"a"});
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, TeamEvent::Kind::joined);
  EXPECT_EQ(events[0].robot, "a");
}

TEST(Changes, OfThreeTheOneJumpedThatLiesElsewhereToBothOthers) {
  RobotGroup before = pair_at(10.0), now = pair_at(10.0);
  before.robots["c"] = {{3.0, 0, 0}, 0.99};
  now.robots["c"] = {{7.0, 0, 0}, 0.99};
  const std::vector<TeamEvent> events = changes_between({before}, {now}, kExtents, {});
  ASSERT_EQ(events.size(), 1u) << "to half of the others is not to most of them";
  EXPECT_EQ(events[0].kind, TeamEvent::Kind::jumped);
  EXPECT_EQ(events[0].text, "c moved by 4.0 m: its newer place is confirmed");
}

TEST(Changes, AreToldWithFourNamesAndTheNumberOfTheOthers) {
  RobotGroup group;
  for (const char* robot : {"a", "b", "c", "d", "e"}) group.robots[robot] = {{}, 0.99};
  EXPECT_EQ(say_placed("a", group), "it lies together with b, c, d, e");
  group.robots["f"] = group.robots["g"] = {{}, 0.99};
  EXPECT_EQ(say_placed("a", group), "it lies together with b, c, d, e and 2 more");
  group.robots.erase("g");
  EXPECT_EQ(say_placed("a", group), "it lies together with b, c, d, e and 1 more");
}

}  // namespace
}  // namespace gridmerge::internal
