// SPDX-License-Identifier: Apache-2.0
// The walls of a plan in the preview.
#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "io/png.hpp"
#include "merge/drawing.hpp"
#include "report/map_panel.hpp"
#include "report/picture.hpp"
#include "report/preview_colours.hpp"
#include "report/results.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;
using test::Picture;
using Colours = internal::PreviewColours;

Picture preview_on_a_plan(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                          const OccupancyGrid* plan) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < maps.size(); ++i) names.push_back("map" + std::to_string(i) + ".yaml");
  return {decode_png(preview_png({names, maps, result, plan}))};
}

TEST(PreviewPlan, DrawsTheWallsOfThePlanWhereMapsHaveNone) {
  // At its scale of 2, the plan has cells as large as those of the maps.
  const std::vector<OccupancyGrid> maps{map_from({"#..#"}, 0.5), map_from({"#..#"}, 0.5)};
  const OccupancyGrid plan = map_from({"######", "#....#", "#....#", "######"}, 0.25);
  MergeResult result = test::merged(maps, {{{0, {0.5, 0.5, 0.0}}, {1, {0.5, 0.5, 0.0}}}});
  const PlanPart part{{0, 1}, {0.5, 0.5, 0.0}, 2.0, 0.99, Reason::none};
  result.plan = PlanPlacement{"folder/floor.png", 2.0, {part}, 0.25};
  const Picture drawn = preview_on_a_plan(maps, result, &plan);
  EXPECT_EQ(drawn.cells(Colours::kPlan), 16u);  // all that the plan has: the maps' walls lie beside them
  EXPECT_EQ(drawn.cells(Colours::kSharedWall), 2u);
  EXPECT_EQ(drawn.cells(Colours::kSharedFree), 2u);
  EXPECT_TRUE(preview_on_a_plan(maps, result, nullptr).pixels(Colours::kPlan).empty());

  MergeResult over = result;  // a cell to the left: the left walls of the maps lie on one of the plan's
  for (Member& member : over.components[0].members) member.T_component_map.x = 0.0;
  const Picture covered = preview_on_a_plan(maps, over, &plan);
  EXPECT_EQ(covered.cells(Colours::kPlan), 15u);
  EXPECT_EQ(covered.cells(Colours::kSharedWall), 2u);

  MergeResult off = result;
  off.plan = PlanPlacement{"floor.png", 1.0, {{{0, 1}, {}, 2.0, 0.5, Reason::ambiguous}}, 0.25};
  EXPECT_TRUE(preview_on_a_plan(maps, off, &plan).pixels(Colours::kPlan).empty());
}

TEST(PreviewPlan, ThePlanOfAWholeSiteLeavesMapsLarge) {
  const std::vector<OccupancyGrid> maps{map_from({"#..#"}, 0.5), map_from({"#..#"}, 0.5)};
  OccupancyGrid site = make_grid(900, 700, 0.25, {}, Cell::free);
  site.at(2, 2) = site.at(899, 699) = site.at(0, 699) = Cell::occupied;
  MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  result.plan = PlanPlacement{"site.png", 2.0, {{{0, 1}, {}, 2.0, 0.99, Reason::none}}, 0.25};
  const Picture drawn = preview_on_a_plan(maps, result, &site);
  EXPECT_EQ(drawn.cells(Colours::kPlan), 1u);
  EXPECT_EQ(drawn.cells(Colours::kSharedWall), 2u);
}

TEST(PreviewPlan, LeavesOutAPlanThatNoMapMayBeAsLargeAs) {
  const std::vector<OccupancyGrid> maps{map_from({"#..#"}, 0.5), map_from({"#..#"}, 0.5)};
  const OccupancyGrid plan = map_from({"######", "#....#", "#....#", "######"}, kMaxResolution);
  MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  result.plan = PlanPlacement{"floor.png", 2.0, {{{0, 1}, {}, 2.0, 0.99, Reason::none}}, kMaxResolution};
  const Picture drawn = preview_on_a_plan(maps, result, &plan);
  EXPECT_EQ(drawn.cells(Colours::kSharedWall), 2u);
}

TEST(PreviewPlan, DrawsThePlanUnderBentMaps) {
  const std::vector<OccupancyGrid> maps{map_from({"#..#"}, 0.5), map_from({"#..#"}, 0.5)};
  const OccupancyGrid plan = map_from({"######", "#....#", "#....#", "######"}, 0.25);
  MergeResult result = test::merged(maps, {{{0, {0.5, 0.5, 0.0}}, {1, {0.5, 0.5, 0.0}}}});
  const std::vector<Point2> down(25, Point2{0.0, -0.5});  // by a cell: onto a wall of the plan
  for (Member& member : result.components[0].members)
    member.deformation = Deformation({-1.0, -1.0, 0.0}, 1.0, 5, 5, down);
  result.plan = PlanPlacement{"floor.png", 2.0, {{{0, 1}, {0.5, 0.5, 0.0}, 2.0, 0.99, Reason::none}}, 0.25};
  const Picture drawn = preview_on_a_plan(maps, result, &plan);
  EXPECT_EQ(drawn.cells(Colours::kSharedWall), 2u);
  EXPECT_EQ(drawn.cells(Colours::kPlan), 14u);
}

TEST(PreviewPlan, DrawsAPlanOfFinerAndOfCoarserCells) {
  const std::vector<OccupancyGrid> maps{map_from({"#..#"}, 0.5), map_from({"#..#"}, 0.5)};
  MergeResult result = test::merged(maps, {{{0, {2.0, 2.0, 0.0}}, {1, {2.0, 2.0, 0.0}}}});
  const PlanPart part{{0, 1}, {2.0, 2.0, 0.0}, 2.0, 0.99, Reason::none};
  const OccupancyGrid finer = map_from({"####", "####"}, 0.125), coarser = map_from({"#"}, 0.5);
  result.plan = PlanPlacement{"floor.png", 2.0, {part}, 0.125};  // a wall of 1 m x 0.5 m
  EXPECT_EQ(preview_on_a_plan(maps, result, &finer).cells(Colours::kPlan), 2u);
  result.plan = PlanPlacement{"floor.png", 2.0, {part}, 0.5};  // of 1 m x 1 m
  EXPECT_EQ(preview_on_a_plan(maps, result, &coarser).cells(Colours::kPlan), 4u);
}

/// Many components are not all shown: then neither is what lies under them.
TEST(PreviewPlan, ThePlanIsInTheLegendIfItIsDrawn) {
  std::vector<OccupancyGrid> maps;
  std::vector<std::vector<Member>> components;
  for (std::size_t i = 0; i < 14; ++i) {
    maps.push_back(map_from({"#..#"}, 0.5));
    maps.push_back(map_from({"#..#"}, 0.5));
    components.push_back({{2 * i, {}}, {2 * i + 1, {}}});
  }
  const OccupancyGrid plan = map_from({"######", "#....#", "#....#", "######"}, 0.25);
  MergeResult result = test::merged(maps, components);
  for (const auto& [first, is_drawn] : {std::pair<std::size_t, bool>{0, true}, {26, false}}) {
    result.plan = PlanPlacement{"floor.png", 2.0, {{{first, first + 1}, {}, 2.0, 0.99, Reason::none}}, 0.25};
    EXPECT_EQ(preview_on_a_plan(maps, result, &plan).pixels(Colours::kPlan).empty(), !is_drawn);
  }
}

TEST(PreviewPlan, ShowsALoneMapOnThePlan) {
  const std::vector<OccupancyGrid> maps{map_from({"#..."}, 0.5), map_from({"#"}, 0.5)};
  const OccupancyGrid plan = map_from({"######", "#....#", "#....#", "######"}, 0.25);
  MergeResult result;
  result.left_out = {{0, Reason::ambiguous}, {1, Reason::ambiguous}};
  result.plan = PlanPlacement{"floor.png", 2.0, {{{0}, {0.5, 0.5, 0.0}, 2.0, 0.99, Reason::none}}, 0.25};
  const Picture drawn = preview_on_a_plan(maps, result, &plan);
  EXPECT_EQ(drawn.cells(Colours::kPlan), 16u);
  EXPECT_EQ(drawn.cells(free_tint(map_colour(0))), 3u);
  EXPECT_GE(drawn.pixels(map_colour(1)).size(), 1u) << "the other one is shown as left out";
}

}  // namespace
}  // namespace gridmerge
