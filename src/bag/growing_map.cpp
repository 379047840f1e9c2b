// SPDX-License-Identifier: Apache-2.0
#include "bag/growing_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "io/cell_warnings.hpp"

namespace gridmerge::internal {

bool GrowingMap::take_map(std::string_view message) {
  MapMessage map = parse_map_message(message, max_cells_);
  if (map.is_empty()) {
    ++useless_maps_;
    return false;
  }
  map_ = std::move(map);
  return true;
}

bool GrowingMap::take_update(std::string_view message) {
  const MapUpdate update = parse_map_update(message);
  if (!is_there()) return false;  // recording began between a map and its updates
  if (update.x < 0 || update.y < 0 || update.x + update.width > map_.width ||
      update.y + update.height > map_.height) {
    ++useless_updates_;
    return false;
  }
  const auto columns = static_cast<std::size_t>(map_.width);
  for (std::size_t row = 0; row < update.height; ++row) {
    const std::size_t to =
        (static_cast<std::size_t>(update.y) + row) * columns + static_cast<std::size_t>(update.x);
    const std::string_view from = update.values.substr(row * update.width, update.width);
    if (!from.empty()) std::memcpy(map_.values.data() + to, from.data(), from.size());
  }
  return true;
}

OccupancyGrid GrowingMap::grid() const {
  return grid_of_percentages(map_.width, map_.height, map_.resolution, map_.origin, map_.values);
}

std::vector<MapWarning> GrowingMap::warnings(const OccupancyGrid& grid) const {
  std::vector<MapWarning> warnings;
  const auto warn = [&](MapWarningKind kind, std::string text) {
    warnings.push_back({kind, std::move(text)});
  };
  const auto strange =
      std::ranges::count_if(map_.values, [](std::int8_t value) { return value < -1 || value > 100; });
  if (strange > 0)
    warn(MapWarningKind::not_a_percentage,
         fmt::format("{} values are neither -1 nor from 0 to 100: they are read as unknown", strange));
  if (map_.lacks_rotation)
    warn(MapWarningKind::no_rotation, "the origin's orientation is four zeros: it is read as no turn");
  if (useless_maps_ > 0)
    warn(MapWarningKind::no_cells,
         fmt::format("{} messages have a map without cells: they are passed over", useless_maps_));
  if (useless_updates_ > 0)
    warn(MapWarningKind::useless_update,
         fmt::format("{} updates reach beyond their map: they are passed over", useless_updates_));
  warn_of_missing_cells(grid, warnings);
  return warnings;
}

}  // namespace gridmerge::internal
