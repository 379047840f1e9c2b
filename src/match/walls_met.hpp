// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// How many of two maps' walls meet: the share of those that lie where the other map has seen, of both maps.
/// Shares in [0, 1]; 0 when no wall lies where the other map has seen.
struct WallsMet {
  double rigidly = 0.0;  ///< with one pose for all of them
  double locally = 0.0;  ///< when every patch of the maps may also shift and turn a little by itself
  /// Of the walls of small things that stand alone (WallPoint::stands_alone): how many lie where the other
  /// map has seen, and the share of them that meets, locally.
  double seen_things = 0.0;
  double things_met = 0.0;
};

/// A map's walls by squares of 6 m, or of 60 cells where those are longer: the patches of
/// measure_walls_met().
class WallPatches {
 public:
  /// The map must outlive this. O(walls).
  explicit WallPatches(const LikelihoodField& map);

  const LikelihoodField& map() const { return map_; }
  double side() const { return side_; }  ///< [cells]
  std::size_t size() const { return walls_.size(); }
  const std::vector<WallPoint>& walls(std::size_t patch) const { return walls_[patch]; }
  Point2 centre(std::size_t patch) const;  ///< [cells, grid frame]

  /// Whether a point lies in a patch [cells, grid frame], and in which one. Patches may reach beyond the map.
  bool cover(const Point2& point) const;
  std::size_t index(const Point2& point) const;

 private:
  const LikelihoodField& map_;
  double side_;
  std::size_t columns_;
  std::size_t rows_;
  std::vector<std::vector<WallPoint>> walls_;  // row-major
};

/// Tells maps that are bent from maps that do not belong together. Neither meet well under one rigid pose;
/// but of two maps of one place, every patch meets once it is shifted by what the maps are bent there, and of
/// two places the patches stay as they are, because rooms differ in more than where they lie.
///
/// A wall meets another one within two cells, unless the two face opposite ways. Each patch climbs to its
/// best pose within 1.2 m of the given one, which is between grid frames, in cells. O(walls + patches).
WallsMet measure_walls_met(const LikelihoodField& fixed, const WallPatches& moving,
                           const SE2& T_fixed_moving_cells);

}  // namespace gridmerge::internal
