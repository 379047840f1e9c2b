// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grid/box.hpp"
#include "grid/cell_box.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"
#include "merge/fuse_box.hpp"

namespace gridmerge::internal {

/// What fuse() gives, a window at a time: a merged map that is too large to be held is never whole in memory.
class GRIDMERGE_INTERNAL_EXPORT FusedWindows {
 public:
  /// What the whole map may have: 2^36 cells, and 2^19 per side, so that some hundred rows can be held.
  static constexpr LatticeLimits kLimits{68719476736.0, 524288.0};

  /// Arguments as of fuse(), and throws as fuse(), but for the limits. The maps outlive it. O(cells of
  /// the inputs).
  FusedWindows(std::vector<PlacedMap> maps, double resolution, std::vector<Deformation> deformations);

  /// Where the cells of the whole map lie.
  const Lattice& lattice() const { return lattice_; }

  /// The cells of the whole map in a window that lies within it, with probabilities: those of fuse(). Runs in
  /// the calling TBB arena. O(cells of the window + cells of the inputs that reach into it).
  OccupancyGrid fused(const CellBox& window) const;

 private:
  FusedInputs inputs_;
  std::vector<Deformation> deformations_;
  std::vector<Box> reach_;  ///< of each input in the output frame [m]
  Lattice lattice_;
};

}  // namespace gridmerge::internal
