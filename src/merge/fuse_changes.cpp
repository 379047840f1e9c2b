// SPDX-License-Identifier: Apache-2.0
#include "merge/fuse_changes.hpp"

#include <optional>
#include <utility>

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
  const CellBox reached{cells.left - kNeighbours, cells.bottom - kNeighbours, cells.right + kNeighbours,
                        cells.top + kNeighbours};
  const SE2 T_lattice_grid =
      SE2{-lattice.corner.x, -lattice.corner.y, 0.0} * input.T_output_map * input.map->origin;
  return cells_under(reached, input.map->resolution, T_lattice_grid, lattice.resolution, kRounding,
                     lattice.whole());
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
