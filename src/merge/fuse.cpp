// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/fuse.hpp"

#include <stdexcept>

#include "grid/seen_from.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "merge/fuse_box.hpp"
#include "merge/log_odds.hpp"

namespace gridmerge {

using namespace internal;

namespace {

std::optional<EqualCells> measure_omega(const OccupancyGrid& lattice, const std::vector<PlacedMap>& inputs) {
  try {
    return EqualCells{count_equal_cells(lattice, inputs), static_cast<std::int64_t>(lattice.cells.size())};
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

}  // namespace

FusedMap fuse(const std::vector<PlacedMap>& maps, double resolution,
              const std::vector<Deformation>& deformations) {
  if (maps.empty()) throw std::invalid_argument("there is no map to fuse");
  if (!is_resolution(resolution))
    throw std::invalid_argument("the output's resolution must be between 1e-6 and 1000 metres per cell");
  const FusedInputs inputs(maps);
  const Lattice lattice = cover(inputs.maps(), resolution, deformations);
  FusedMap fused;
  fused.grid =
      make_grid(lattice.width, lattice.height, lattice.resolution, {lattice.corner.x, lattice.corner.y, 0.0});
  fused.grid.probability.resize(fused.grid.cells.size());
  const SharedCells shared = fuse_box(inputs.maps(), deformations, lattice, lattice.whole(), fused.grid);
  fused.agreeing = static_cast<std::size_t>(shared.agreeing);
  fused.conflicting = static_cast<std::size_t>(shared.conflicting);
  if (!is_any_bent(deformations)) fused.omega = measure_omega(fused.grid, inputs.maps());
  return fused;
}

OccupancyGrid bent_map(const OccupancyGrid& map, const Deformation& deformation) {
  validate(map);
  if (deformation.is_identity()) return map;
  OccupancyGrid upright = map;
  upright.origin = {};
  const Deformation in_grid = seen_from(inverse(map.origin), deformation);
  const Lattice lattice = cover({PlacedMap{&upright, {}}}, map.resolution, {in_grid});
  const LogOddsPatch patch = draw_log_odds({&upright, {}}, lattice, in_grid);
  OccupancyGrid bent = make_grid(lattice.width, lattice.height, lattice.resolution,
                                 map.origin * SE2{lattice.corner.x, lattice.corner.y, 0.0});
  for (int row = 0; row < patch.height; ++row) {
    for (int column = 0; column < patch.width; ++column) {
      const std::int16_t log_odds = patch.at(column, row);
      if (log_odds != 0)
        bent.at(patch.column + column, patch.row + row) = log_odds > 0 ? Cell::occupied : Cell::free;
    }
  }
  return bent;
}

}  // namespace gridmerge
