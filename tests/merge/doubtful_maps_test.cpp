// SPDX-License-Identifier: Apache-2.0
// Maps that a consistent set is not sure of: they move, or are cut off.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

#include "merge/consistent_set.hpp"

namespace gridmerge::internal {
namespace {

/// Where a map lies in its group, along a line [m].
double place_of(const ConsistentSet& found, std::size_t map) {
  for (const NodeGroup& group : found.groups) {
    for (const PlacedNode& node : group) {
      if (node.map == map) return node.T_group_map.x;
    }
  }
  return std::nan("");
}

// Map 3 is first joined where a single pair puts it, and moves to where two others do. That another map joins
// one more very surely, with which it has next to nothing to do, changes nothing.
TEST(ConsistentSet, AVerySurePairKeepsNoOtherMapFromMoving) {
  const auto along = [](double x) { return SE2{x, 0.0, 0.0}; };
  JoinProblem problem;
  for (int i = 0; i < 6; ++i) problem.maps.push_back({{{0.0, 0.0}, 5.0, 20.0}});
  problem.pairs = {{0, 1, {{along(10.0), 4.5, 0.2}}},  {0, 2, {{along(20.0), 4.4, 0.2}}},
                   {1, 2, {{along(10.0), 4.4, 0.2}}},  {0, 3, {{along(-40.0), 5.0, 0.2}}},
                   {1, 3, {{along(20.0), 3.0, 0.2}}},  {2, 3, {{along(10.0), 3.0, 0.2}}},
                   {3, 4, {{along(70.0), -6.9, 0.2}}}, {4, 5, {{along(10.0), 11.0, 0.2}}}};
  const ConsistentSet found = find_consistent_set(problem, 0.95);
  ASSERT_EQ(found.groups.size(), 2u);
  EXPECT_NEAR(place_of(found, 3) - place_of(found, 0), 30.0, 0.5);
  EXPECT_NEAR(place_of(found, 5) - place_of(found, 4), 10.0, 0.5);
}

/// Maps along a line, 10 m apart, of which most pairs have a few candidates that contradict each other.
JoinProblem rivals_on_a_line(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const std::size_t maps = 3 + seed % 6;
  JoinProblem problem;
  for (std::size_t i = 0; i < maps; ++i) problem.maps.push_back({{{0.0, 0.0}, 5.0, 20.0}});
  for (std::size_t a = 0; a < maps; ++a) {
    for (std::size_t b = a + 1; b < maps; ++b) {
      if (share(random) < 0.25) continue;
      PairCandidates pair{a, b, {}};
      double left = 1.0;
      for (std::size_t i = 0; i < 1 + random() % 3; ++i) {
        const double probability = left * std::pow(share(random), i == 0 ? 0.3 : 1.0);
        left -= probability;
        const double off = share(random) < 0.45 ? 0.0 : 12.0 * (static_cast<double>(random() % 7) - 3.0);
        const double x = 10.0 * static_cast<double>(b - a) + off;
        const bool is_new =
            std::none_of(pair.candidates.begin(), pair.candidates.end(),
                         [&](const auto& one) { return std::abs(one.T_fixed_moving.x - x) < 6.0; });
        if (is_new && probability > 1e-3)
          pair.candidates.push_back(
              {{x, 0.0, 0.0}, std::log(probability / std::max(1.0 - probability, 1e-5)), 0.2});
      }
      problem.pairs.push_back(std::move(pair));
    }
  }
  return problem;
}

// What is said of a map is said of it alone against all others, so each is sure enough.
TEST(ConsistentSet, EveryMapIsAsSureAsAsked) {
  std::size_t joined = 0;
  for (unsigned seed = 1; seed <= 4000; ++seed) {
    for (const NodeGroup& group : find_consistent_set(rivals_on_a_line(seed), 0.95).groups) {
      if (group.size() < 2) continue;
      ++joined;
      for (const PlacedNode& node : group)
        EXPECT_GE(node.probability, 0.95) << "map " << node.map << " of " << seed;
    }
  }
  EXPECT_GT(joined, 1000u);
}

}  // namespace
}  // namespace gridmerge::internal
