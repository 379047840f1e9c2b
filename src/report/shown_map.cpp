// SPDX-License-Identifier: Apache-2.0
#include "report/shown_map.hpp"

#include <zlib.h>

#include <cmath>
#include <new>
#include <utility>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "report/base64.hpp"

namespace gridmerge::internal {

namespace {

/// Higher levels take several times as long to make maps a few percent smaller.
constexpr int kLevel = 6;

std::string deflated(const std::vector<Cell>& cells) {
  static_assert(sizeof(Cell) == 1 && static_cast<int>(Cell::free) == 1 &&
                static_cast<int>(Cell::occupied) == 2);
  uLongf size = compressBound(cells.size());
  std::string stream(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(stream.data()), &size, reinterpret_cast<const Bytef*>(cells.data()),
                cells.size(), kLevel) != Z_OK)
    throw std::bad_alloc();  // the buffer is large enough, so nothing else can have failed
  stream.resize(size);
  return stream;
}

}  // namespace

OccupancyGrid at_most(OccupancyGrid grid, std::size_t max_cells) {
  const auto cells_of = [&](int factor) {
    return (static_cast<std::size_t>(grid.width - 1) / factor + 1) *
           (static_cast<std::size_t>(grid.height - 1) / factor + 1);
  };
  int factor = 1;
  while (cells_of(factor) > max_cells) factor *= 2;
  if (factor > 1) return downsample(grid, factor);
  return grid;
}

ShownMap show_map(const OccupancyGrid& grid, std::size_t max_cells) {
  if (count_cells(grid).known() == 0) return {0, 0, grid.resolution, grid.origin, "", 1};
  const OccupancyGrid known = at_most(crop_to_known(grid), max_cells);
  return {known.width,
          known.height,
          known.resolution,
          known.origin,
          to_base64(deflated(known.cells)),
          static_cast<int>(std::lround(known.resolution / grid.resolution))};
}

Json grid_json(const ShownMap& map) {
  Json json{{"width", map.width},
            {"height", map.height},
            {"resolution", number_json(map.resolution)},
            {"origin", transform_json(map.origin)},
            {"cells", map.cells}};
  if (map.coarser > 1) json["coarser"] = map.coarser;
  return json;
}

}  // namespace gridmerge::internal
