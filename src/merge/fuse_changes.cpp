// SPDX-License-Identifier: Apache-2.0
#include "merge/fuse_changes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "grid/box.hpp"
#include "grid/changed_cells.hpp"
#include "merge/fuse_box.hpp"
#include "merge/log_odds.hpp"
#include "similarity/equal_cells.hpp"

namespace gridmerge::internal {

namespace {

/// The lattice's cells whose value may depend on a box of a map's cells.
CellBox lattice_box(const CellBox& cells, const PlacedMap& input, const Lattice& lattice) {
  constexpr int kNeighbours = 1;  // cells that touch at a corner make a band across it
  constexpr int kRounding = 1;
  const OccupancyGrid& map = *input.map;
  const SE2 T_output_grid = input.T_output_map * map.origin;
  Box box;  // [cells of the lattice]
  for (const int column : {cells.left - kNeighbours, cells.right + kNeighbours}) {
    for (const int row : {cells.bottom - kNeighbours, cells.top + kNeighbours}) {
      const Point2 corner = T_output_grid * Point2{column * map.resolution, row * map.resolution};
      box.add(Point2{(corner.x - lattice.corner.x) / lattice.resolution,
                     (corner.y - lattice.corner.y) / lattice.resolution});
    }
  }
  const auto clip = [](double cell, int size) {
    return static_cast<int>(std::clamp<double>(std::floor(cell), 0.0, size));
  };
  return {clip(box.min_x - kRounding, lattice.width), clip(box.min_y - kRounding, lattice.height),
          clip(box.max_x + kRounding + 1, lattice.width), clip(box.max_y + kRounding + 1, lattice.height)};
}

bool lies_on(const OccupancyGrid& grid, const Lattice& lattice) {
  return Lattice{grid.width, grid.height, grid.resolution, {grid.origin.x, grid.origin.y}} == lattice;
}

/// What is drawn again is drawn twice, as it was and as it is.
bool is_worth_it(const CellBox& box, const Lattice& lattice) {
  constexpr double kMostDrawn = 1.0 / 3.0;
  return static_cast<double>(box.width()) * box.height() <= kMostDrawn * lattice.width * lattice.height;
}

/// The lattice's cells that have to be drawn again; none where that is all of them.
std::optional<CellBox> cells_to_draw(const std::vector<PlacedMap>& was, const std::vector<PlacedMap>& now,
                                     const Lattice& lattice) {
  if (was.size() != now.size()) return std::nullopt;
  CellBox box;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (was[i].T_output_map != now[i].T_output_map) return std::nullopt;
    if (was[i].map == now[i].map) continue;
    const std::optional<CellBox> changed = changed_cells(*was[i].map, *now[i].map);
    if (!changed) return std::nullopt;
    if (!changed->empty()) box = unite(box, lattice_box(*changed, now[i], lattice));
  }
  return box;
}

}  // namespace

FusedMap fuse_changes(FusedMap before, const std::vector<PlacedMap>& was, const std::vector<PlacedMap>& now,
                      double resolution) {
  const FusedInputs old_inputs(was), inputs(now);
  // What is taken for paint may be elsewhere in a map than what has changed of it.
  if (old_inputs.is_any_painted() || inputs.is_any_painted()) return fuse(now, resolution);
  const Lattice lattice = cover(inputs.maps(), resolution);
  const std::optional<CellBox> box = cells_to_draw(was, now, lattice);
  if (!box || !lies_on(before.grid, lattice) || !is_worth_it(*box, lattice)) return fuse(now, resolution);
  if (box->empty()) return before;

  FusedMap fused = std::move(before);
  const SharedCells gone = fuse_box(was, {}, lattice, *box, fused.grid);
  const SharedCells come = fuse_box(now, {}, lattice, *box, fused.grid);
  fused.agreeing += static_cast<std::size_t>(come.agreeing - gone.agreeing);
  fused.conflicting += static_cast<std::size_t>(come.conflicting - gone.conflicting);
  if (fused.omega)
    fused.omega->equal += count_equal_cells(fused.grid, now, *box) - count_equal_cells(fused.grid, was, *box);
  return fused;
}

}  // namespace gridmerge::internal
