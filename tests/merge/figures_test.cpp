// SPDX-License-Identifier: Apache-2.0
// What merge() makes of small teams in each way that it can: poses, probabilities, deviations, joins, and the
// merged map's cells.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "merge/team.hpp"

namespace gridmerge {
namespace {

using test::FigureLine;
using test::with_pose;

void add(const std::string& name, const MergeResult& result, std::vector<FigureLine>& lines) {
  for (const Component& component : result.components) {
    test::Figures merged = test::figures_of(component.fused.grid);
    merged.push_back({"agreeing", static_cast<double>(component.fused.agreeing)});
    merged.push_back({"conflicting", static_cast<double>(component.fused.conflicting)});
    lines.push_back({name + ", merged map", merged});
    for (const Member& member : component.members) {
      const Point2 bent = member.deformation.bend({2.0, 3.0});
      const PoseDeviation sd = member.sd.value_or(PoseDeviation{-1.0, -1.0});
      lines.push_back({name + ", map " + std::to_string(member.map),
                       with_pose(member.T_component_map, {{"probability", member.probability.value_or(-1.0)},
                                                          {"sd", sd.position},
                                                          {"sd_theta", sd.theta},
                                                          {"bent_x", bent.x},
                                                          {"bent_y", bent.y}})});
    }
  }
  for (const LeftOut& one : result.left_out)
    lines.push_back({name + ", map " + std::to_string(one.map) + " left out: " + name_of(one.reason), {}});
  for (const Join& join : result.joins)
    lines.push_back({name + ", join " + std::to_string(join.fixed) + " " + std::to_string(join.moving) +
                         ": " + name_of(join.outcome) + " " + name_of(join.reason()),
                     with_pose(join.T_fixed_moving, {{"probability", join.probability}})});
  lines.push_back({name,
                   {{"expected_false_joins", result.expected_false_joins.value_or(-1.0)},
                    {"open_ways", static_cast<double>(result.open_ways.size())}}});
}

/// A team of three that share most of a building. One map is larger than it should be, one is sheared, and
/// one is bent by some decimetres.
std::vector<OccupancyGrid> warped_team() {
  std::vector<OccupancyGrid> maps = test::Team().maps;
  maps.resize(3);
  maps[0].resolution *= 1.02;
  constexpr double kSpacing = 8.0;
  for (std::size_t map = 1; map < maps.size(); ++map) {
    std::vector<Point2> shifts;
    for (int row = 0; row < 9; ++row) {
      for (int column = 0; column < 9; ++column) {
        const double x = (column - 4) * kSpacing, y = (row - 4) * kSpacing;
        shifts.push_back(map == 1 ? Point2{0.02 * y, 0.0}
                                  : Point2{0.5 * std::sin(0.4 * y), 0.5 * std::cos(0.4 * x)});
      }
    }
    maps[map] = bent_map(maps[map], {{-4.0 * kSpacing, -4.0 * kSpacing, 0.0}, kSpacing, 9, 9, shifts});
  }
  return maps;
}

TEST(Figures, OfATeam) {
  const test::Team team;
  std::vector<FigureLine> lines;
  add("rigid", merge(team.maps), lines);
  std::vector<std::optional<KnownPose>> known(team.maps.size());
  known[1] = KnownPose{{1.0, -1.0, 0.5}, 0.2, 0.05, true};
  known[4] = KnownPose{{12.0, 4.0, 0.0}, 1.0, 0.1, false};
  add("known poses", merge(team.maps, {}, known), lines);
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
}

TEST(Figures, OfAWarpedTeamInEachWay) {
  const std::vector<OccupancyGrid> maps = warped_team();
  std::vector<FigureLine> lines;
  for (const MapTransform transform :
       {MapTransform::rigid, MapTransform::similarity, MapTransform::affine, MapTransform::elastic}) {
    MergeOptions options;
    options.transform = transform;
    const MergeResult result = merge(maps, options);
    ASSERT_EQ(result.components.size(), 1u);
    // Or the table would pin the same four times.
    EXPECT_EQ(result.components[0].members[1].deformation.is_identity(), transform == MapTransform::rigid);
    add(name_of(transform), result, lines);
  }
  test::expect_figures(GRIDMERGE_TEST_DATA "/warped_figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge
