// SPDX-License-Identifier: Apache-2.0
// What match() says of a few pairs, with every figure of its best hypotheses: the verdict was fitted to such
// figures.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/simulate/simulate.hpp"
#include "support/building.hpp"

namespace gridmerge {
namespace {

using test::draw_building;
using test::FigureLine;
using test::map_part;
using test::with_pose;

/// A line for the result, and one for each of its first three hypotheses.
void add(const std::string& name, const MatchResult& result, std::vector<FigureLine>& lines) {
  lines.push_back(
      {name + ": " + name_of(result.verdict) + " " + name_of(result.reason),
       with_pose(result.T_fixed_moving, {{"probability", result.probability},
                                         {"scale", result.scale},
                                         {"acceptance_index", result.acceptance_index},
                                         {"agreement", static_cast<double>(result.agreement)},
                                         {"disagreement", static_cast<double>(result.disagreement)},
                                         {"overlap", result.overlap},
                                         {"hypotheses", static_cast<double>(result.hypotheses.size())}})});
  for (std::size_t i = 0; i < result.hypotheses.size() && i < 3; ++i) {
    const Hypothesis& one = result.hypotheses[i];
    test::Figures figures{{"evidence", one.score}, {"probability", one.probability}, {"scale", one.scale}};
    for (const PoseFigure& figure : pose_figures())
      figures.push_back({figure.name, one.figures.*figure.value});
    lines.push_back({name + ", hypothesis " + std::to_string(i), with_pose(one.T_fixed_moving, figures)});
  }
}

/// Maps of two robots in one building: bent, noisy, with clutter.
std::vector<OccupancyGrid> mapped(BuildingKind kind, std::uint64_t seed) {
  SimulateOptions options;
  options.kind = kind;
  options.width = 24.0;
  options.height = 18.0;
  options.robots = 2;
  options.overlap = 0.4;
  options.drift = 0.4;
  options.resolution = 0.1;
  options.seed = seed;
  std::vector<OccupancyGrid> maps;
  for (SimulatedMap& map : simulate(options).maps) maps.push_back(std::move(map.grid));
  return maps;
}

TEST(Figures, OfPairs) {
  std::vector<FigureLine> lines;
  const OccupancyGrid one = draw_building(31), other = draw_building(32);
  const OccupancyGrid left = map_part(one, {0, 0, 11, 13}, {1.0, 2.0, 0.4}),
                      right = map_part(one, {7, 0, 18, 13}, {-3.0, 1.0, 2.4}),
                      small = map_part(one, {12, 6, 18, 12}, {0.0, 0.0, -1.0}),
                      strange = map_part(other, {3, 0, 15, 13}, {0.0, 4.0, 1.2});
  for (const SearchMethodName& search : search_methods()) {
    if (search.method == SearchMethod::random_walk) continue;  // it has a verdict of its own, and tests of it
    MatchOptions options;
    options.search = search.method;
    const std::string with = std::string(", ") + search.name;
    add("much in common" + with, match(left, right, options), lines);
    add("nothing seen by both" + with, match(left, small, options), lines);
    add("another building" + with, match(left, strange, options), lines);
  }
  const std::vector<OccupancyGrid> office = mapped(BuildingKind::office, 5),
                                   loop = mapped(BuildingKind::loop, 6);
  add("office", match(office[0], office[1]), lines);
  add("loop", match(loop[0], loop[1]), lines);
  add("office and loop", match(office[0], loop[1]), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
}

/// So many cells that not all of them are counted.
TEST(Figures, OfAPairOfManyCells) {
  std::vector<FigureLine> lines;
  OccupancyGrid one = draw_building(33);
  one.resolution *= 3.0;
  const OccupancyGrid left = map_part(one, {0, 0, 39, 39}, {1.0, 2.0, 0.4}),
                      right = map_part(one, {15, 0, 54, 39}, {-3.0, 1.0, 2.4});
  const PreparedMap fixed(transform_grid(left, {}, 0.075)), moving(transform_grid(right, {}, 0.075));
  ASSERT_GT(std::min(fixed.known().cells.size(), moving.known().cells.size()), 4U * 60000U);
  add("a large building", match(fixed, moving), lines);
  MatchOptions thorough;
  thorough.search = SearchMethod::thorough;
  add("a large building, thorough", match(fixed, moving, thorough), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/large_figures.tsv", lines);
}

TEST(Figures, OfRefinedPoses) {
  std::vector<FigureLine> lines;
  const OccupancyGrid one = draw_building(31), other = draw_building(32);
  const SE2 T_left{1.0, 2.0, 0.4}, T_right{-3.0, 1.0, 2.4};
  const PreparedMap left(map_part(one, {0, 0, 11, 13}, T_left)),
      right(map_part(one, {7, 0, 18, 13}, T_right)), strange(map_part(other, {7, 0, 18, 13}, T_right));
  const SE2 truth = T_left * inverse(T_right);
  const auto add_refined = [&](const std::string& name, const PreparedMap& moving, const SE2& start) {
    const RefinedPose refined = refine_pose(left, moving, start);
    lines.push_back(
        {name, with_pose(refined.T_fixed_moving, {{"evidence", refined.score},
                                                  {"start", refined.start_score},
                                                  {"moved", refined.moved},
                                                  {"probability", refined.probability},
                                                  {"agreement", static_cast<double>(refined.agreement)},
                                                  {"disagreement", static_cast<double>(refined.disagreement)},
                                                  {"overlap", refined.overlap}})});
  };
  add_refined("the truth", right, truth);
  add_refined("near the truth", right, SE2{0.4, -0.5, 0.05} * truth);
  add_refined("far from the truth", right, SE2{3.0, -2.0, 0.9} * truth);
  add_refined("another building", strange, truth);
  test::expect_figures(GRIDMERGE_TEST_DATA "/refined_figures.tsv", lines);
}

TEST(Figures, OfPairsOfAnotherScale) {
  std::vector<FigureLine> lines;
  const OccupancyGrid building = draw_building(31);
  const OccupancyGrid part = map_part(building, {0, 0, 11, 13}, {1.0, 2.0, 0.4});
  OccupancyGrid plan = test::on_white_paper(building);
  plan.resolution *= 1.3;
  MatchOptions options;
  options.scales = ScaleRange{0.6, 1.1};
  add("a plan that is too large", match(part, plan, options), lines);
  add("another building's plan", match(part, test::on_white_paper(draw_building(32)), options), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/scaled_figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge
