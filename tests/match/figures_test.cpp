// SPDX-License-Identifier: Apache-2.0
// What match() says of a few pairs, with every figure of its best hypotheses: the verdict was fitted to such
// figures.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
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

/// A line for the result, and one for each of its first three hypotheses.
void add(const std::string& name, const MatchResult& result, std::vector<FigureLine>& lines) {
  const auto with_pose = [](const SE2& T, std::vector<double> others) {
    others.insert(others.begin(), {T.x, T.y, T.theta});
    return others;
  };
  lines.push_back(
      {name, with_pose(result.T_fixed_moving,
                       {result.verdict == Verdict::accepted ? 1.0 : 0.0, static_cast<double>(result.reason),
                        result.probability, result.scale, result.acceptance_index,
                        static_cast<double>(result.agreement), static_cast<double>(result.disagreement),
                        result.overlap, static_cast<double>(result.hypotheses.size())})});
  for (std::size_t i = 0; i < result.hypotheses.size() && i < 3; ++i) {
    const Hypothesis& one = result.hypotheses[i];
    FigureLine line{name + ", hypothesis " + std::to_string(i),
                    with_pose(one.T_fixed_moving, {one.score, one.probability, one.scale})};
    for (const PoseFigure& figure : pose_figures()) line.figures.push_back(one.figures.*figure.value);
    lines.push_back(line);
  }
}

/// Maps of robots in one building: bent, noisy, with clutter.
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
    if (search.method == SearchMethod::random_walk) continue;  // it has an own verdict, and tests of it
    MatchOptions options;
    options.search = search.method;
    const std::string with = std::string(" ") + search.name;
    add("much in common" + with, match(left, right, options), lines);
    add("little in common" + with, match(left, small, options), lines);
    add("nothing in common" + with, match(left, strange, options), lines);
  }
  const std::vector<OccupancyGrid> office = mapped(BuildingKind::office, 5),
                                   loop = mapped(BuildingKind::loop, 6);
  add("office", match(office[0], office[1]), lines);
  add("loop", match(loop[0], loop[1]), lines);
  add("office and loop", match(office[0], loop[1]), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
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
  OccupancyGrid strange = test::on_white_paper(draw_building(32));
  add("another building's plan", match(part, strange, options), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/scaled_figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge
