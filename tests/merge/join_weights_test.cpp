// SPDX-License-Identifier: Apache-2.0
#include "merge/join_weights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "merge/coverage.hpp"

namespace gridmerge::internal {
namespace {

/// Two maps side by side know half of a third one each.
TEST(JoinWeights, APairThatSpeaksLessForAJoinMakesItWorthLess) {
  OccupancyGrid grid = make_grid(40, 40, 0.5);
  std::fill(grid.cells.begin(), grid.cells.end(), Cell::free);
  const Coverage large(grid);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 20; x < 40; ++x) grid.cells[static_cast<std::size_t>(y * 40 + x)] = Cell::unknown;
  }
  const Coverage half(grid);
  double last = -1e9, least = 1e9;
  for (double log_odds = -6.8; log_odds < 7.0; log_odds += 0.1) {
    JoinProblem problem;
    problem.maps = {{half.extent(), &half}, {half.extent(), &half}, {large.extent(), &large}};
    problem.pairs = {{0, 2, {{SE2{}, 5.0, 0.2}}}, {1, 2, {{SE2{-10.0, 0.0, 0.0}, log_odds, 0.2}}}};
    const JoinWeights weights(problem);
    const JoinWorth worth = weights.worth_of({{0, {}}, {1, {10.0, 0.0, 0.0}}}, {{2, {}}}, {});
    EXPECT_GE(worth.against_apart, last) << log_odds;
    last = worth.against_apart;
    least = std::min(least, last);
  }
  EXPECT_LT(least, 4.0);  // a pair that doubts is heard
  EXPECT_GT(last, 7.0);   // and one that is sure, too
}

/// A group is cut where the joins are weakest: a ring of four maps whose last join is doubtful is a chain.
TEST(JoinWeights, AGroupIsCutAlongItsSurestJoins) {
  for (const std::size_t doubtful : {0u, 1u, 2u, 3u}) {  // the join of this map and the one after it
    JoinProblem problem;
    problem.maps.resize(4);
    for (ProblemMap& map : problem.maps) map.extent.radius = 5.0;
    NodeGroup group;
    for (std::size_t map = 0; map < 4; ++map) {
      const std::size_t after = (map + 1) % 4;
      problem.pairs.push_back(
          {std::min(map, after), std::max(map, after), {{SE2{}, map == doubtful ? 1.0 : 6.0, 0.2}}});
      group.push_back({map, SE2{}});
    }
    // The chain begins after the doubtful join.
    const auto of_chain = [&](std::vector<std::size_t> places) {
      std::set<std::size_t> maps;
      for (const std::size_t place : places) maps.insert((doubtful + 1 + place) % 4);
      return maps;
    };
    std::set<std::set<std::size_t>> parts;
    for (const auto& [first, second] : JoinWeights(problem).halves(group)) {
      EXPECT_EQ(first.size() + second.size(), 4u);
      for (const NodeGroup& half : {first, second}) {
        std::set<std::size_t> part;
        for (const PlacedNode& node : half) part.insert(node.map);
        parts.insert(part);
      }
    }
    const std::set<std::set<std::size_t>> expected{of_chain({0}),      of_chain({1, 2, 3}), of_chain({0, 1}),
                                                   of_chain({2, 3}),   of_chain({0, 1, 2}), of_chain({3}),
                                                   of_chain({1}),      of_chain({0, 2, 3}), of_chain({2}),
                                                   of_chain({0, 1, 3})};  // and either inner map by itself
    EXPECT_EQ(parts, expected) << doubtful;
  }
}

}  // namespace
}  // namespace gridmerge::internal
