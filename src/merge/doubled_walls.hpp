// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// How well the maps of a component lie on each other.
struct DoubledWalls {
  /// Walls of one map that another map has within a metre, facing the same side: so many of the walls that
  /// were looked at, some hundred for each two maps.
  double compared = 0.0;
  /// So many of these lie more than 0.2 m (and two cells) apart, across the wall: the merged map has them
  /// twice.
  double doubled = 0.0;

  /// Of the walls that were compared, in [0, 1]; 0 when there are none.
  double share() const { return compared > 0.0 ? doubled / compared : 0.0; }
};

/// From this share on, MapTransform::elastic is likely to make the merged map sharper.
inline constexpr double kManyDoubled = 0.15;

/// Of the maps of a component, bent as its members say. `maps` as given to merge(). O(cells + members^2).
GRIDMERGE_INTERNAL_EXPORT DoubledWalls measure_doubled_walls(const std::vector<OccupancyGrid>& maps,
                                                             const Component& component);

}  // namespace gridmerge::internal
