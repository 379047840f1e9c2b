// SPDX-License-Identifier: Apache-2.0
#include "report/plan_layer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "merge/drawing.hpp"
#include "report/cells.hpp"
#include "report/page_data.hpp"
#include "report/results.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;

const std::vector<OccupancyGrid> kMaps{map_from({"#..", ".##"}, 0.05), map_from({"#", "."}, 0.05),
                                       map_from({".#.", "...", " .#"}, 0.05), map_from({"##"}, 0.05),
                                       map_from({".#"}, 0.05)};
const std::vector<std::string> kNames{"a.yaml", "b.yaml", "c.yaml", "d.yaml", "e.yaml"};

/// The first two maps are one part on the plan, the third is another part there; of the others one hangs
/// there by nothing but a guess, and of one nothing is said.
MergeResult on_a_plan() {
  MergeResult result =
      test::merged(kMaps, {{{0, {4.0, 0.1, 1.0}}, {1, {5.0, 0.0, 0.5}}, {2, {7.0, 8.0, 3.0}}}});
  result.components[0].in_world_frame = true;
  result.plan = PlanPlacement{"floor.png",
                              1.25,
                              {{{0, 1}, {4.0, 0.1, 1.0}, 1.25, 0.975, Reason::none},
                               {{2}, {7.0, 8.0, 3.0}, 1.26, 0.96, Reason::none},
                               {{3}, {1.0, 2.0, 0.5}, 0.75, 0.25, Reason::ambiguous},
                               {{4}, {}, 1.0, 0.0, Reason::nothing_to_compare}},
                              0.1};
  return result;
}

Json plan_of(const MergeResult& result, const OccupancyGrid* plan) {
  return plan_page_json({kNames, kMaps, result, plan});
}

TEST(PlanLayer, HoldsTheWallsAlone) {
  const OccupancyGrid plan = map_from({"......", ".####.", ".#..#.", ".####.", "......"}, 0.1);
  const Json json = plan_of(on_a_plan(), &plan);
  EXPECT_EQ(json.at("name"), "floor.png");
  EXPECT_EQ(json.at("scale"), 1.25);
  EXPECT_EQ(json.at("probability"), 0.975);
  EXPECT_EQ(json.at("maps"), (Json{0, 1, 2}));
  const Json& grid = json.at("grid");
  EXPECT_EQ(grid.at("width"), 4);
  EXPECT_EQ(grid.at("height"), 3);
  EXPECT_EQ(grid.at("resolution"), 0.1);
  EXPECT_EQ(grid.at("origin"), (Json{{"x", 0.1}, {"y", 0.1}, {"theta", 0.0}}));
  constexpr Cell kWall = Cell::occupied, kNone = Cell::unknown;
  EXPECT_EQ(test::cells_of(grid), (std::vector{kWall, kWall, kWall, kWall, kWall, kNone, kNone, kWall, kWall,
                                               kWall, kWall, kWall}));
}

TEST(PlanLayer, LiesUnderEachMergedMapAndEachMapThatWasLeftOut) {
  const Json places = plan_of(on_a_plan(), nullptr).at("places");
  ASSERT_EQ(places.size(), 2u) << "one for all parts of a merged map, and none where there is no guess";
  EXPECT_EQ(places[0], (Json{{"component", 0},
                             {"map", nullptr},
                             {"transform", {{"x", 0.0}, {"y", 0.0}, {"theta", 0.0}}},
                             {"scale", 1.25},
                             {"probability", 0.975},
                             {"on_plan", true}}));
  EXPECT_TRUE(places[1].at("component").is_null());
  EXPECT_EQ(places[1].at("map"), 3);
  EXPECT_EQ(places[1].at("transform"), transform_json(inverse(SE2{1.0, 2.0, 0.5})));
  EXPECT_EQ(places[1].at("scale"), 0.75);
  EXPECT_EQ(places[1].at("on_plan"), false);
}

TEST(PlanLayer, LiesUnderAMergedMapOffThePlanAsTheBestWaySays) {
  MergeResult result = test::merged(kMaps, {{{1, {}}, {3, {2.0, 1.0, 0.25}}}});
  result.plan = PlanPlacement{"floor.png", 1.0, {{{1, 3}, {3.0, 4.0, 0.5}, 2.0, 0.5, Reason::several}}, 0.1};
  const Json places = plan_of(result, nullptr).at("places");
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].at("component"), 0);
  EXPECT_EQ(places[0].at("transform"), transform_json(inverse(SE2{3.0, 4.0, 0.5})));
  EXPECT_EQ(places[0].at("scale"), 2.0);
  EXPECT_EQ(places[0].at("on_plan"), false);
}

TEST(PlanLayer, IsPartOfThePageWhetherItsFileIsThereOrNot) {
  const MergeResult result = on_a_plan();
  EXPECT_TRUE(page_data({kNames, kMaps, result}).at("plan").at("grid").is_null());
  const OccupancyGrid plan = map_from({"###", "#.#", "###"}, 0.1);
  EXPECT_EQ(page_data({kNames, kMaps, result, &plan}).at("plan").at("grid").at("width"), 3);
  MergeResult nowhere = test::merged(kMaps, {});
  nowhere.plan = PlanPlacement{"floor.png", 1.0, {{{0}, {}, 1.0, 0.0, Reason::several}}, 0.1};
  EXPECT_TRUE(plan_of(nowhere, &plan).at("grid").is_null()) << "what has no place is not drawn";
  EXPECT_FALSE(page_data({kNames, kMaps, test::merged(kMaps, {})}).contains("plan"));
}

TEST(PlanLayer, APlanOfMoreThanFourMillionCellsIsThinned) {
  for (const int width : {2048, 2049}) {
    OccupancyGrid plan = make_grid(width, 2048, 0.25);
    for (int column = 0; column < width; ++column)
      plan.at(column, 0) = plan.at(column, 2047) = Cell::occupied;
    for (int row = 0; row < 2048; ++row) plan.at(0, row) = plan.at(width - 1, row) = Cell::occupied;
    const Json grid = plan_of(on_a_plan(), &plan).at("grid");
    EXPECT_EQ(grid.at("width"), width == 2048 ? 2048 : 1025);
    EXPECT_EQ(grid.at("height"), width == 2048 ? 2048 : 1024);
    EXPECT_EQ(grid.at("resolution"), width == 2048 ? 0.25 : 0.5);
    EXPECT_LT(grid.at("cells").get<std::string>().size(), 100'000u);
  }
}

TEST(PlanLayer, DotsThatCannotBePackedAreThinnedUntilTheyAreSmall) {
  // In cells of its own it would take 0.55 MB.
  std::mt19937 random(3);
  OccupancyGrid plan = make_grid(2048, 1300, 0.25);
  for (Cell& cell : plan.cells) cell = random() % 2 == 0 ? Cell::occupied : Cell::unknown;
  plan.cells.front() = plan.cells.back() = Cell::occupied;
  const Json grid = plan_of(on_a_plan(), &plan).at("grid");
  EXPECT_EQ(grid.at("width"), 1024);
  EXPECT_EQ(grid.at("resolution"), 0.5);
  EXPECT_LE(grid.at("cells").get<std::string>().size(), 500'000U);
}

}  // namespace
}  // namespace gridmerge
