// SPDX-License-Identifier: Apache-2.0
#include "grid_bytes.hpp"

#include <bit>
#include <cstdint>

namespace gridmerge::python {

using namespace internal;

void write_grid(const OccupancyGrid& grid, ByteWriter& writer) {
  writer.whole(static_cast<std::uint64_t>(grid.width));
  writer.whole(static_cast<std::uint64_t>(grid.height));
  writer.number(grid.resolution);
  writer.pose(grid.origin);
  writer.text({reinterpret_cast<const char*>(grid.cells.data()), grid.cells.size()});
  writer.whole(grid.probability.size());
  for (const float value : grid.probability) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) writer.byte(static_cast<std::uint8_t>(bits >> shift & 0xff));
  }
}

OccupancyGrid read_grid(ByteReader& reader) {
  OccupancyGrid grid;
  grid.width = static_cast<int>(reader.whole());
  grid.height = static_cast<int>(reader.whole());
  grid.resolution = reader.number();
  grid.origin = reader.pose();
  for (const char cell : reader.text()) grid.cells.push_back(static_cast<Cell>(cell));
  grid.probability.resize(reader.count(4));
  for (float& value : grid.probability) {
    std::uint32_t bits = 0;
    for (int shift = 0; shift < 32; shift += 8) bits |= std::uint32_t{reader.byte()} << shift;
    value = std::bit_cast<float>(bits);
  }
  validate(grid);
  return grid;
}

}  // namespace gridmerge::python
