// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bag/bag_builder.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/grid/message_values.hpp"

namespace gridmerge::test {

/// A map of one row: its values tell which it is.
inline MapFields row_of(const std::vector<std::int8_t>& values) {
  MapFields map;
  map.width = static_cast<std::uint32_t>(values.size());
  map.height = 1;
  map.values = values;
  return map;
}

/// The cells of such a map.
inline std::vector<Cell> cells_of(const std::vector<std::int8_t>& values) {
  std::vector<Cell> cells;
  for (const std::int8_t value : values) cells.push_back(cell_of_percentage(value));
  return cells;
}

/// A recorded map of one row.
inline Recorded row_at(std::int64_t time, const std::vector<std::int8_t>& values,
                       const std::string& topic = "/map") {
  return {topic, time, map_message(row_of(values)), kMapType, "cdr"};
}

/// A recorded update.
inline Recorded update_at(std::int64_t time, const UpdateFields& fields,
                          const std::string& topic = "/map_updates") {
  return {topic, time, update_message(fields), kUpdateType, "cdr"};
}

/// The cells of each map of a topic, in their order.
inline std::vector<std::vector<Cell>> all_cells(const Bag& bag, const std::string& topic = {}) {
  std::vector<std::vector<Cell>> all;
  BagMaps maps(bag, topic);
  while (const auto map = maps.next()) all.push_back(map->grid.cells);
  return all;
}

}  // namespace gridmerge::test
