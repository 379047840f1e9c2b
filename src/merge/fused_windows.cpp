// SPDX-License-Identifier: Apache-2.0
#include "merge/fused_windows.hpp"

#include <stdexcept>
#include <utility>

namespace gridmerge::internal {

FusedWindows::FusedWindows(std::vector<PlacedMap> maps, double resolution,
                           std::vector<Deformation> deformations)
    : inputs_(std::move(maps)), deformations_(std::move(deformations)) {
  if (inputs_.maps().empty()) throw std::invalid_argument("there is no map to fuse");
  deformations_.resize(inputs_.maps().size());
  for (std::size_t i = 0; i < deformations_.size(); ++i)
    reach_.push_back(covered_box({inputs_.maps()[i]}, {deformations_[i]}));
  lattice_ = cover(inputs_.maps(), resolution, deformations_, kLimits);
}

OccupancyGrid FusedWindows::fused(const CellBox& window) const {
  const double resolution = lattice_.resolution;
  OccupancyGrid grid = make_grid(
      window.width(), window.height(), resolution,
      {lattice_.corner.x + window.left * resolution, lattice_.corner.y + window.bottom * resolution, 0.0});
  grid.probability.resize(grid.cells.size());
  // A cell more on every side: an input may reach into a cell by a rounding error.
  const Box within{grid.origin.x - resolution, grid.origin.y - resolution,
                   grid.origin.x + (window.width() + 1) * resolution,
                   grid.origin.y + (window.height() + 1) * resolution};
  std::vector<PlacedMap> inputs;
  std::vector<Deformation> deformations;
  for (std::size_t i = 0; i < reach_.size(); ++i) {
    if (!overlap(reach_[i], within)) continue;
    inputs.push_back(inputs_.maps()[i]);
    deformations.push_back(deformations_[i]);
  }
  fuse_box(inputs, deformations, lattice_, window, grid, {window.left, window.bottom});
  return grid;
}

}  // namespace gridmerge::internal
