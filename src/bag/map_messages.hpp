// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/message_values.hpp"

namespace gridmerge::internal {

/// Whether a type of message is nav_msgs/msg/OccupancyGrid, by its name of ROS 2 or of ROS 1.
bool is_map_type(std::string_view type);

/// The same of map_msgs/msg/OccupancyGridUpdate.
bool is_update_type(std::string_view type);

/// What a nav_msgs/OccupancyGrid says: `values` are width * height percentages, row 0 at the bottom.
struct MapMessage {
  std::string frame_id;
  double resolution = 0.0;  ///< [m/cell], the decimal that the message's float was made from
  int width = 0;
  int height = 0;
  SE2 origin;                   ///< T_map_grid
  bool lacks_rotation = false;  ///< its orientation is four zeros, which is read as none
  std::vector<std::int8_t> values;

  /// Mappers send such maps before they have seen anything.
  bool is_empty() const { return values.empty(); }
};

/// What a map_msgs/OccupancyGridUpdate says: new values of a rectangle of cells.
struct MapUpdate {
  std::int64_t x = 0;  ///< column of its left side
  std::int64_t y = 0;  ///< row of its lower side
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string_view values;  ///< width * height bytes of the message
};

/// Reads a message in CDR. Throws ParseError for bytes that are none, for more than `max_cells` cells, for
/// values that do not number width * height, and for a place that load_map refuses: a resolution, an origin
/// or a rotation that no map has. A map without cells is let pass. O(cells).
MapMessage parse_map_message(std::string_view bytes, std::size_t max_cells);

/// The same of an update. Its values are those of `bytes`, which must outlive it. O(1).
MapUpdate parse_map_update(std::string_view bytes);

}  // namespace gridmerge::internal
