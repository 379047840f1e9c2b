// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "grid/cell_box.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "merge/log_odds.hpp"

namespace gridmerge::internal {

/// Maps to be fused, without what somebody painted black where that is most of a map: it would hide what
/// others have seen.
class FusedInputs {
 public:
  /// Throws std::invalid_argument for an invalid map. The grids must outlive it. O(cells).
  explicit FusedInputs(std::vector<PlacedMap> maps);

  const std::vector<PlacedMap>& maps() const { return maps_; }
  bool is_any_painted() const;

 private:
  std::vector<PlacedMap> maps_;
  std::vector<std::unique_ptr<const OccupancyGrid>> seen_;  // null where that is the map itself
};

/// Cells that several maps know.
struct SharedCells {
  std::int64_t agreeing = 0;     ///< all equal
  std::int64_t conflicting = 0;  ///< free in one and occupied in another

  void add(const SharedCells& others) {
    agreeing += others.agreeing;
    conflicting += others.conflicting;
  }
};

/// A cell of a lattice.
struct LatticeCell {
  int column = 0;
  int row = 0;
};

/// Fuses maps as fuse() does in the cells of `box`, and writes them to `fused`, a grid with probabilities
/// whose cells are those of the lattice from `first` on. O(cells of the inputs + cells of the box).
SharedCells fuse_box(const std::vector<PlacedMap>& inputs, const std::vector<Deformation>& deformations,
                     const Lattice& lattice, const CellBox& box, OccupancyGrid& fused,
                     const LatticeCell& first = {});

}  // namespace gridmerge::internal
