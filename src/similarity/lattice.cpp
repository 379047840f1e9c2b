// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "similarity/equal_cells.hpp"
#include "similarity/lattice_frames.hpp"
#include "similarity/nearest_cells.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// The map's cells on a valid lattice, where the box has cells. Empty if there are none.
CellsOnLattice draw_within(const OccupancyGrid& lattice, const CellBox& limits, const PlacedMap& map) {
  validate(map);
  check_resolutions(lattice, *map.map);
  const SE2 T_lattice_grid = between_grids(lattice, *map.map, map.T_output_map);
  const CellBox box = intersect(box_on_lattice(*map.map, T_lattice_grid, lattice.resolution),
                                intersect(limits, all_cells(lattice)));
  CellsOnLattice drawn;
  if (box.width() > 0 && box.height() > 0)
    draw_nearest_cells(*map.map, T_lattice_grid, lattice.resolution, box, 1, drawn);
  return drawn;
}

}  // namespace

OccupancyGrid draw_on_lattice(const OccupancyGrid& lattice, const PlacedMap& map) {
  validate(lattice);
  const CellsOnLattice drawn = draw_within(lattice, all_cells(lattice), map);
  OccupancyGrid grid = make_grid(lattice.width, lattice.height, lattice.resolution, lattice.origin);
  for (int row = drawn.box.bottom; row < drawn.box.top; ++row) {
    throw_if_cancelled();
    for (int column = drawn.box.left; column < drawn.box.right; ++column)
      grid.at(column, row) = static_cast<Cell>(*drawn.at(column, row));
  }
  return grid;
}

std::int64_t count_equal_cells(const OccupancyGrid& lattice, std::span<const PlacedMap> maps) {
  return internal::count_equal_cells(lattice, maps, all_cells(lattice));
}

std::int64_t internal::count_equal_cells(const OccupancyGrid& lattice, std::span<const PlacedMap> maps,
                                         const CellBox& box) {
  if (maps.empty()) return 0;
  validate(lattice);
  constexpr auto kUnknown = static_cast<std::uint8_t>(Cell::unknown);
  constexpr std::uint8_t kDiffer = 0xff;  // no value of a cell
  const auto width = static_cast<std::size_t>(box.width());
  std::vector<std::uint8_t> values(width * static_cast<std::size_t>(box.height()),
                                   kUnknown);  // of all so far
  for (const PlacedMap& map : maps) {
    const bool is_first = &map == &maps.front();
    const CellsOnLattice drawn = draw_within(lattice, box, map);
    for (int row = box.bottom; row < box.top; ++row) {
      throw_if_cancelled();
      std::uint8_t* const of_row = values.data() + static_cast<std::size_t>(row - box.bottom) * width;
      const bool inside = row >= drawn.box.bottom && row < drawn.box.top;
      const int left = inside ? drawn.box.left : box.right;
      const int right = inside ? drawn.box.right : box.right;
      const auto compare = [&](int column, std::uint8_t value) {
        std::uint8_t& before = of_row[column - box.left];
        if (is_first) before = value;
        if (before != value) before = kDiffer;
      };
      for (int column = box.left; column < left; ++column) compare(column, kUnknown);
      for (int column = left; column < right; ++column) compare(column, *drawn.at(column, row));
      for (int column = right; column < box.right; ++column) compare(column, kUnknown);
    }
  }
  return std::count_if(values.begin(), values.end(), [](std::uint8_t value) { return value != kDiffer; });
}

bool lie_on_each_other(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_fixed_moving) {
  validate(fixed);
  validate(moving);
  check_resolutions(fixed, moving);
  if (!is_finite(T_fixed_moving)) return false;
  const OccupancyGrid known_fixed = crop_to_known(fixed);
  const OccupancyGrid known_moving = crop_to_known(moving);
  if (!is_within_lattice(known_moving, between_grids(known_fixed, known_moving, T_fixed_moving),
                         known_fixed.resolution))
    return false;
  const CellsOnLattice drawn =
      draw_within(known_fixed, all_cells(known_fixed), {&known_moving, T_fixed_moving});
  return std::any_of(drawn.spans.begin(), drawn.spans.end(),
                     [](const CellsOnLattice::Span& span) { return span.left < span.right; });
}

}  // namespace gridmerge
