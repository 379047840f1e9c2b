// SPDX-License-Identifier: Apache-2.0
// What each search finds for a pair that overlaps and for one that does not, and where a random walk goes.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/search/random_walk.hpp"
#include "search/exhaustive.hpp"
#include "search/thorough.hpp"
#include "similarity/likelihood_field.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;
using test::FigureLine;
using test::map_part;

/// A line for each of the first candidates, and one for them all.
void add(const std::string& name, const std::vector<PoseCandidate>& found, std::vector<FigureLine>& lines) {
  double scores = 0.0, poses = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const SE2& T = found[i].T_fixed_moving;
    scores += found[i].score;
    poses += static_cast<double>(i + 1) * (T.x + 2.0 * T.y + 3.0 * T.theta);
    if (i < 5)
      lines.push_back({name + " " + std::to_string(i),
                       test::with_pose(T, {{"score", static_cast<double>(found[i].score)}})});
  }
  lines.push_back({name,
                   {{"candidates", static_cast<double>(found.size())},
                    {"scores", scores},
                    {"poses", poses / std::max<double>(1.0, static_cast<double>(found.size()))}}});
}

void add(const std::string& name, const RandomWalkResult& walk, std::vector<FigureLine>& lines) {
#ifdef __GLIBCXX__  // other libraries draw other numbers
  lines.push_back(
      {name, test::with_pose(walk.T_fixed_moving, {{"delta", walk.delta},
                                                   {"psi", walk.similarity.psi()},
                                                   {"proposals", static_cast<double>(walk.proposals)},
                                                   {"accepted", static_cast<double>(walk.accepted)}})});
#endif
}

TEST(Figures, OfTwoPairs) {
  const OccupancyGrid one = draw_building(41), other = draw_building(42);
  const OccupancyGrid left = map_part(one, {0, 0, 11, 13}, {1.0, 2.0, 0.4}),
                      right = map_part(one, {6, 0, 18, 13}, {-3.0, 1.0, 2.4}),
                      strange = map_part(other, {3, 0, 15, 13}, {0.0, 4.0, 1.2});
  const LikelihoodField fixed = make_likelihood_field(left, 0.1);
  std::vector<FigureLine> lines;
  for (const auto& [name, map] : {std::pair{"same", &right}, std::pair{"strange", &strange}}) {
    const LikelihoodField moving = make_likelihood_field(*map, 0.1);
    const std::string of = std::string(" ") + name;
    add("quick" + of, search_all_poses(fixed, moving), lines);
    ExhaustiveSearchOptions coarse;
    coarse.coarse_factor = 8;
    coarse.rotations = 90;
    coarse.samples = 60;
    coarse.max_candidates = 50;
    add("coarse" + of, search_all_poses(fixed, moving, coarse), lines);
    add("thorough" + of, search_thoroughly(fixed, moving), lines);
    RandomWalkOptions options;
    options.max_proposals = 400;
    add("walk" + of, random_walk(left, *map, {1.0, 1.0, 0.5}, options), lines);
    options.c_lock = 0.5;
    options.temperature = 2.0;
    options.cooling = 0.99;
    options.wide_share = 0.3;
    add("warm walk" + of, random_walk(left, *map, {1.0, 1.0, 0.5}, options), lines);
    StartPoseOptions starts;
    starts.rotations = 4;
    int number = 0;
    for (const MeasuredPose& pose : measure_start_poses(left, *map, starts))
      lines.push_back({"start" + of + " " + std::to_string(number++),
                       test::with_pose(pose.T_fixed_moving, {{"psi", pose.similarity.psi()}})});
  }
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge::internal
