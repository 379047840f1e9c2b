// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "merge/elastic_sheet.hpp"
#include "merge/elastic_walls.hpp"

namespace gridmerge::internal {

/// A map that is being bent, with its walls.
struct ElasticMember {
  ElasticSheet sheet;
  ElasticWalls walls;
  bool held = false;  ///< it stays as it is
};

/// Two walls that are thought to be one, of two maps.
struct WallTie {
  SplineWeights at_first;   ///< of the first map, at the place half-way between the two walls
  SplineWeights at_second;  ///< of the second map, at the same place
  Point2 gap;               ///< from the second map's wall to the first one's [m, group frame]
  Point2 normal;            ///< of both, of length 1 [group frame]
  double across = 0.0;      ///< weight of the gap across the wall [1/m^2]
  double along = 0.0;       ///< weight of the gap along it
};

/// The ties of two maps.
struct TiedPair {
  std::size_t first = 0;  ///< less than `second`
  std::size_t second = 0;
  std::vector<WallTie> ties;
};

/// The pairs of maps with walls within `reach` metres of each other, of each map the few that have most;
/// ascending. O(maps^2) looks at a few walls.
std::vector<std::pair<std::size_t, std::size_t>> pairs_that_meet(const std::vector<ElasticMember>& members,
                                                                 double reach);

/// The walls of each pair that lie within `reach` metres of each other and face alike: each to the nearest.
/// The farther apart two are, the less they weigh (Geman and McClure 1985): half of a reach is usual. Walls
/// of a pair weigh the less, the more pairs its maps are in. O(pairs).
std::vector<TiedPair> tie_walls(const std::vector<ElasticMember>& members,
                                const std::vector<std::pair<std::size_t, std::size_t>>& pairs, double reach,
                                double cell);

}  // namespace gridmerge::internal
