// SPDX-License-Identifier: Apache-2.0
#include "report/fused_places.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "merge/drawing.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;
using Places = std::vector<std::size_t>;

/// Maps 1, 3, 6 and 7 are copies of one, and 0, 2, 4 and 5 of another.
std::vector<OccupancyGrid> some_maps() {
  const OccupancyGrid copied = map_from({"####", "#..#", "#. #", "##.#"}, 0.5);
  const OccupancyGrid other = map_from({"####", "#..#", "#..#", "#..#"}, 0.5);
  return {other, copied, other, copied, other, other, copied, copied};
}

/// The second component has the maps 1, 3, 4, 6 and 7, of which map 6 lies beside the others.
MergeResult some_result() {
  const SE2 at{3.0, -2.0, 0.5};
  MergeResult result;
  result.expected_false_joins = 0.0;
  result.components.push_back({{{0, {}}, {2, {}}}, {}});
  result.components.push_back({{{1, at}, {3, at}, {4, at}, {6, {4.0, -2.0, 0.5}}, {7, at}}, {}});
  return result;
}

Join join_of(std::size_t fixed, std::size_t moving, JoinOutcome outcome) {
  Join join;
  join.fixed = fixed;
  join.moving = moving;
  join.outcome = outcome;
  return join;
}

TEST(FusedPlaces, OfCopiesThatLieOnEachOtherIsTheFirst) {
  const MergeResult result = some_result();
  EXPECT_EQ(fused_places(result, 1, some_maps()), (Places{0, 2, 3}));
  EXPECT_EQ(fused_places(result, 0, some_maps()), Places{0});
}

TEST(FusedPlaces, UpATreeAreAll) {
  MergeResult result = some_result();
  result.expected_false_joins = std::nullopt;
  EXPECT_EQ(fused_places(result, 1, some_maps()), (Places{0, 1, 2, 3, 4}));
}

TEST(FusedPlaces, CopiesOfWhichBothPosesWereKnownAreThereOnceEach) {
  MergeResult result = some_result();
  result.joins = {join_of(1, 7, JoinOutcome::known)};
  EXPECT_EQ(fused_places(result, 1, some_maps()), (Places{0, 2, 3, 4}));
  // Whichever of the two is called fixed, and however often they are spoken of.
  result.joins = {join_of(7, 1, JoinOutcome::known), join_of(3, 7, JoinOutcome::known),
                  join_of(1, 3, JoinOutcome::known)};
  EXPECT_EQ(fused_places(result, 1, some_maps()), (Places{0, 1, 2, 3, 4}));
}

TEST(FusedPlaces, OtherJoinsChangeNothing) {
  MergeResult result = some_result();
  for (const JoinOutcome outcome :
       {JoinOutcome::refused, JoinOutcome::accepted, JoinOutcome::rescued, JoinOutcome::rejected})
    result.joins.push_back(join_of(1, 7, outcome));
  result.joins.push_back(join_of(4, 7, JoinOutcome::known));  // no copies
  result.joins.push_back(join_of(5, 7, JoinOutcome::known));  // one is in no component,
  result.joins.push_back(join_of(7, 5, JoinOutcome::known));
  result.joins.push_back(join_of(0, 3, JoinOutcome::known));  // or in another
  EXPECT_EQ(fused_places(result, 1, some_maps()), (Places{0, 2, 3}));
  // What stands behind them is heard.
  result.joins.push_back(join_of(1, 3, JoinOutcome::known));
  EXPECT_EQ(fused_places(result, 1, some_maps()), (Places{0, 1, 2, 3}));
}

}  // namespace
}  // namespace gridmerge
