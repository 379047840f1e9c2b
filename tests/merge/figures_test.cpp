// SPDX-License-Identifier: Apache-2.0
// What merge() makes of a small team in each way that it can: poses, probabilities, deviations, joins, and
// the merged map's cells.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/tree.hpp"
#include "merge/team.hpp"

namespace gridmerge {
namespace {

using test::FigureLine;

/// Sums that a cell's value and its place are in.
std::vector<double> sums_of(const FusedMap& fused) {
  double occupied = 0.0, free = 0.0, places = 0.0, probability = 0.0;
  const OccupancyGrid& grid = fused.grid;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const Cell cell = grid.at(column, row);
      if (cell == Cell::unknown) continue;
      (cell == Cell::occupied ? occupied : free) += 1.0;
      if (cell == Cell::occupied) places += 3.0 * row + column;
      probability += grid.probability[grid.index(column, row)];
    }
  }
  return {static_cast<double>(grid.width),
          static_cast<double>(grid.height),
          grid.resolution,
          grid.origin.x,
          grid.origin.y,
          occupied,
          free,
          places,
          probability,
          static_cast<double>(fused.agreeing),
          static_cast<double>(fused.conflicting)};
}

void add(const std::string& name, const MergeResult& result, std::vector<FigureLine>& lines) {
  for (const Component& component : result.components) {
    lines.push_back({name + ", merged map", sums_of(component.fused)});
    for (const Member& member : component.members) {
      const SE2& T = member.T_component_map;
      const Point2 bent = member.to_component({2.0, 3.0});
      lines.push_back(
          {name + ", map " + std::to_string(member.map),
           {T.x, T.y, T.theta, member.probability.value_or(-1.0), member.sd ? member.sd->position : -1.0,
            member.sd ? member.sd->theta : -1.0, bent.x, bent.y}});
    }
  }
  for (const LeftOut& one : result.left_out)
    lines.push_back({name + ", map " + std::to_string(one.map), {static_cast<double>(one.reason)}});
  for (const Join& join : result.joins) {
    const SE2& T = join.T_fixed_moving;
    lines.push_back({name + ", join " + std::to_string(join.fixed) + " " + std::to_string(join.moving),
                     {T.x, T.y, T.theta, static_cast<double>(join.outcome),
                      static_cast<double>(join.reason()), join.probability}});
  }
  lines.push_back(
      {name, {result.expected_false_joins.value_or(-1.0), static_cast<double>(result.open_ways.size())}});
}

TEST(Figures, OfATeamInEachWay) {
  const test::Team team;
  std::vector<FigureLine> lines;
  for (const MapTransform transform :
       {MapTransform::rigid, MapTransform::similarity, MapTransform::affine, MapTransform::elastic}) {
    MergeOptions options;
    options.transform = transform;
    add(name_of(transform), merge(team.maps, options), lines);
  }
  std::vector<std::optional<KnownPose>> known(team.maps.size());
  known[1] = KnownPose{{1.0, -1.0, 0.5}, 0.2, 0.05, true};
  known[4] = KnownPose{{12.0, 4.0, 0.0}, 1.0, 0.1, false};
  add("known poses", merge(team.maps, {}, known), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge
