// SPDX-License-Identifier: Apache-2.0
#include "merge/unused_poses.hpp"

#include <gtest/gtest.h>

#include "gridmerge/merge/merge.hpp"

namespace gridmerge::internal {
namespace {

using Why = UnusedPose::Why;

// Three square rooms in a row, 10 m a side, as one component; a fourth is left out.
struct Rooms {
  Rooms() {
    maps.assign(4, make_grid(100, 100, 0.1, {}, Cell::free));
    Component component;
    for (std::size_t i = 0; i < 3; ++i) component.members.push_back({i, at(i)});
    result.components.push_back(std::move(component));
    result.left_out = {{3}};
    for (std::size_t i = 0; i < 4; ++i) known.push_back(KnownPose{T_world * at(i), 0.1, 0.01});
  }

  static SE2 at(std::size_t i) { return {8.0 * static_cast<double>(i), 0.0, 0.0}; }

  std::vector<UnusedPose> unused() const { return find_unused_poses(maps, known, result); }

  const SE2 T_world{5.0, -3.0, 0.7};
  std::vector<OccupancyGrid> maps;
  std::vector<std::optional<KnownPose>> known;
  MergeResult result;
};

/// Two maps whose own match surely puts them so.
Join accepted_join(std::size_t fixed, std::size_t moving, const SE2& T_fixed_moving) {
  Join join;
  join.fixed = fixed;
  join.moving = moving;
  join.match.verdict = Verdict::accepted;
  join.match.T_fixed_moving = T_fixed_moving;
  return join;
}

TEST(UnusedPoses, AreNoneWhereAllAreFollowed) {
  Rooms rooms;
  rooms.known[3].reset();
  EXPECT_TRUE(rooms.unused().empty());
  EXPECT_TRUE(find_unused_poses(rooms.maps, {}, rooms.result).empty());
}

TEST(UnusedPoses, NameTheOneThatLiesElsewhereAndHowFar) {
  Rooms rooms;
  rooms.known[3].reset();
  for (std::size_t wrong = 0; wrong < 3; ++wrong) {
    Rooms one = rooms;
    one.known[wrong]->T_world_map = rooms.T_world * Rooms::at(wrong) * SE2{0.0, 24.0, 0.0};
    const std::vector<UnusedPose> unused = one.unused();
    ASSERT_EQ(unused.size(), 1u) << wrong;
    EXPECT_EQ(unused[0].map, wrong);
    EXPECT_EQ(unused[0].why, Why::overruled);
    EXPECT_NEAR(unused[0].distance, 24.0, 1e-6);
  }
}

TEST(ContradictedFixes, AreTheFixedPairsThatMatchElsewhere) {
  Rooms rooms;
  rooms.result.joins = {accepted_join(0, 1, Rooms::at(1))};
  const auto contradicted = [&] { return find_contradicted_fixes(rooms.maps, rooms.known, rooms.result); };

  rooms.known[0]->fixed = rooms.known[1]->fixed = true;
  EXPECT_TRUE(contradicted().empty());
  rooms.known[1]->T_world_map = rooms.T_world * Rooms::at(1) * SE2{0.0, 24.0, 0.0};
  ASSERT_EQ(contradicted().size(), 1u);
  EXPECT_EQ(contradicted()[0].fixed, 0u);
  EXPECT_EQ(contradicted()[0].moving, 1u);
  EXPECT_NEAR(contradicted()[0].distance, 24.0, 1e-6);

  rooms.known[1]->fixed = false;  // an unused pose then
  EXPECT_TRUE(contradicted().empty());
  rooms.known[1]->fixed = true;
  rooms.result.joins[0].match.verdict = Verdict::refused;  // the maps are not sure of it
  EXPECT_TRUE(contradicted().empty());
}

TEST(ContradictedFixes, DoNotDependOnWhichMapComesFirst) {
  // Turned about the middle of the second map, which so moves less than the first one does.
  for (const double turn : {0.02, 0.05, 0.1, 0.2, 0.4}) {
    std::vector<std::size_t> found;
    for (const bool swapped : {false, true}) {
      Rooms rooms;
      const SE2 about_middle = SE2{5.0, 5.0, 0.0} * SE2{0.0, 0.0, turn} * SE2{-5.0, -5.0, 0.0};
      const SE2 T_fixed_moving{40.0, 0.0, 0.0};
      rooms.result.joins = {accepted_join(0, 1, swapped ? inverse(T_fixed_moving) : T_fixed_moving)};
      rooms.known[0]->fixed = rooms.known[1]->fixed = true;
      rooms.known[swapped ? 1 : 0]->T_world_map = rooms.T_world;
      rooms.known[swapped ? 0 : 1]->T_world_map = rooms.T_world * T_fixed_moving * about_middle;
      found.push_back(find_contradicted_fixes(rooms.maps, rooms.known, rooms.result).size());
    }
    EXPECT_EQ(found[0], found[1]) << turn;
  }
}

TEST(UnusedPoses, ATurnCountsAsADistanceToo) {
  Rooms rooms;
  rooms.known[3].reset();
  rooms.known[1]->T_world_map.theta += 1.5;
  const std::vector<UnusedPose> unused = rooms.unused();
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_EQ(unused[0].map, 1u);
  EXPECT_GT(unused[0].distance, 3.0);
}

TEST(UnusedPoses, AFixedPoseIsBelievedAgainstMany) {
  Rooms rooms;
  rooms.known[3].reset();
  rooms.known[0]->fixed = true;
  rooms.result.components[0].in_world_frame = true;
  for (Member& member : rooms.result.components[0].members)
    member.T_component_map = rooms.T_world * member.T_component_map;
  EXPECT_TRUE(rooms.unused().empty());
  for (const std::size_t map : {1U, 2U})
    rooms.known[map]->T_world_map = SE2{0.0, 30.0, 0.0} * rooms.known[map]->T_world_map;
  const std::vector<UnusedPose> unused = rooms.unused();
  ASSERT_EQ(unused.size(), 2u);
  EXPECT_EQ(unused[0].map, 1u);
  EXPECT_EQ(unused[1].map, 2u);
}

TEST(UnusedPoses, OfAMapThatWasLeftOutSayWhatIsMissing) {
  Rooms rooms;
  ASSERT_EQ(rooms.unused().size(), 1u);
  EXPECT_EQ(rooms.unused()[0].map, 3u);
  EXPECT_EQ(rooms.unused()[0].why, Why::contradicted) << "10 cm is sure enough to join";

  for (auto& one : rooms.known) one->sd_position = 1.0;
  const UnusedPose unused = rooms.unused().at(0);
  EXPECT_EQ(unused.why, Why::not_sure_enough);
  EXPECT_EQ(unused.other, 2u) << "the nearest: directions err less over a short way";
  EXPECT_GT(unused.sd, 1.4);
  EXPECT_EQ(unused.sd_allowed, 0.5);

  for (std::size_t i = 0; i < 3; ++i) rooms.known[i].reset();
  EXPECT_TRUE(rooms.unused().empty()) << "the only pose says nothing";
}

TEST(UnusedPoses, OfAMapThatAloneFitsElsewhereNameTheMapThatItFits) {
  Rooms rooms;
  rooms.result.joins = {accepted_join(1, 3, inverse(Rooms::at(1)) * Rooms::at(3) * SE2{0.0, 24.0, 0.0})};
  ASSERT_EQ(rooms.unused().size(), 1u);
  const UnusedPose unused = rooms.unused()[0];
  EXPECT_EQ(unused.map, 3u);
  EXPECT_EQ(unused.why, Why::against_match);
  EXPECT_EQ(unused.other, 1u);
  EXPECT_NEAR(unused.distance, 24.0, 1e-6);

  rooms.result.joins[0].match.verdict = Verdict::refused;
  EXPECT_EQ(rooms.unused().at(0).why, Why::contradicted) << "the maps alone are not sure";
  rooms.result.joins[0].match.verdict = Verdict::accepted;
  for (auto& one : rooms.known) one->sd_position = 20.0;
  EXPECT_NE(rooms.unused().at(0).why, Why::against_match) << "24 m are within what is known";
}

}  // namespace
}  // namespace gridmerge::internal
