// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "simulate/draughtsman.hpp"

namespace gridmerge::internal {

/// Where a beam meets an edge.
struct Hit {
  double range = std::numeric_limits<double>::infinity();  ///< [m]; infinity when it meets none
  double echo = 1.0;                                       ///< of the edge
};

/// Finds what beams meet. The edges are sorted into square buckets, and a beam looks into those that it
/// crosses.
class RayCaster {
 public:
  /// Copies the edges. O(edges * buckets that each touches).
  explicit RayCaster(std::vector<Edge> edges);

  /// The nearest edge at a distance in (`beyond`, `max_range`] from `from` along the unit vector `direction`
  /// [m]. O(buckets crossed, and the edges in them).
  Hit cast(Point2 from, Point2 direction, double max_range, double beyond = 0.0) const;

  const std::vector<Edge>& edges() const { return edges_; }

 private:
  std::vector<Edge> edges_;
  Point2 corner_;  // of the first bucket
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::size_t> first_;  // of each bucket's edges in members_, and one more
  std::vector<std::size_t> members_;
};

/// Distance along the unit vector `direction` to the edge; infinity when the ray misses it.
double distance_to(const Edge& edge, Point2 from, Point2 direction);

}  // namespace gridmerge::internal
