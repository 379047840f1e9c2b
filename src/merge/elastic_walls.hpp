// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// A wall where it is straight enough to say which way it runs.
struct ElasticWall {
  Point2 position;             ///< [m, map frame]
  Point2 normal;               ///< of length 1 [map frame]: to the side from which it was seen
  bool has_two_sides = false;  ///< it was seen from both, so that the normal may as well be turned round
};

/// Whether two walls face the same way, within some 37 degrees; normals in one frame.
bool faces_alike(const ElasticWall& a, const ElasticWall& b);

/// A map's walls, to be found by where they are.
class ElasticWalls {
 public:
  /// O(walls).
  explicit ElasticWalls(const LikelihoodField& map);

  const std::vector<ElasticWall>& walls() const { return walls_; }

  /// The wall that is nearest to `wall` (in this map's frame) of those within `reach` metres that face alike.
  /// Normals count too: that they differ by a right angle is as much as 1.4 times the reach, and half a metre
  /// at least. None if there is none. O(walls within reach).
  const ElasticWall* nearest(const ElasticWall& wall, double reach) const;

 private:
  /// Calls `visit` with the walls in all buckets that come within `reach` of a point [m], row by row.
  template <typename Visit>
  void for_each_about(const Point2& at, double reach, Visit visit) const;
  std::size_t bucket_of(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void sort_into_buckets();

  std::vector<ElasticWall> walls_;   // bucket by bucket
  std::vector<std::size_t> begins_;  // of each bucket, and the end of the last
  Point2 corner_;
  double side_ = 1.0;  // of a bucket [m]
  int columns_ = 0, rows_ = 0;
};

}  // namespace gridmerge::internal
