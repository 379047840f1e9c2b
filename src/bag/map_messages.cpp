// SPDX-License-Identifier: Apache-2.0
#include "bag/map_messages.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "bag/cdr.hpp"
#include "gridmerge/io/map_file.hpp"
#include "io/map_yaml.hpp"
#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

// std_msgs/Header: the time at which the message was made, and a frame.
std::string read_header(CdrReader& reader) {
  reader.read_int32();
  reader.read_uint32();
  return reader.read_string();
}

double read_coordinate(CdrReader& reader) {
  const double value = reader.read_double();
  if (!std::isfinite(value) || std::abs(value) > kMaxOrigin)
    throw ParseError(fmt::format("the map's origin is {}: it must lie within {} m", value, kMaxOrigin));
  return value;
}

void read_origin(CdrReader& reader, MapMessage& map) {
  map.origin.x = read_coordinate(reader);
  map.origin.y = read_coordinate(reader);
  reader.read_double();  // its height: a map is flat wherever it lies
  Quaternion rotation;
  rotation.x = reader.read_double();
  rotation.y = reader.read_double();
  rotation.z = reader.read_double();
  rotation.w = reader.read_double();
  const Yaw yaw = yaw_of(rotation);
  switch (yaw.kind) {
    case Rotation::about_z:
      map.origin.theta = yaw.theta;
      break;
    case Rotation::missing:
      map.lacks_rotation = true;
      break;
    case Rotation::tilted:
      throw ParseError("the map is tilted: only a turn about z is a map's");
    case Rotation::not_unit:
      throw ParseError(fmt::format("the map's orientation ({}, {}, {}, {}) is no quaternion of length 1",
                                   rotation.x, rotation.y, rotation.z, rotation.w));
  }
}

void check_count(std::size_t values, std::uint32_t width, std::uint32_t height) {
  if (values != std::uint64_t{width} * height)
    throw ParseError(fmt::format("the message has {} values for {} x {} cells", values, width, height));
}

}  // namespace

bool is_map_type(std::string_view type) {
  return type == "nav_msgs/msg/OccupancyGrid" || type == "nav_msgs/OccupancyGrid";
}

bool is_update_type(std::string_view type) {
  return type == "map_msgs/msg/OccupancyGridUpdate" || type == "map_msgs/OccupancyGridUpdate";
}

MapMessage parse_map_message(std::string_view bytes, std::size_t max_cells) {
  CdrReader reader(bytes);
  MapMessage map;
  map.frame_id = read_header(reader);
  reader.read_int32();  // when the map was loaded
  reader.read_uint32();
  const float resolution = reader.read_float();
  const std::uint32_t width = reader.read_uint32();
  const std::uint32_t height = reader.read_uint32();
  if (width == 0 || height == 0) return map;
  map.resolution = decimal_of(resolution);
  check_resolution(map.resolution);
  constexpr std::uint32_t kMaxSide = std::numeric_limits<int>::max();
  if (width > kMaxSide || height > kMaxSide || std::uint64_t{width} * height > max_cells)
    throw ParseError(fmt::format("{} x {} cells exceed the limit of {}", width, height, max_cells));
  map.width = static_cast<int>(width);
  map.height = static_cast<int>(height);
  read_origin(reader, map);
  const std::string_view values = reader.read_bytes();
  check_count(values.size(), width, height);
  map.values.resize(values.size());
  std::memcpy(map.values.data(), values.data(), values.size());
  return map;
}

MapUpdate parse_map_update(std::string_view bytes) {
  CdrReader reader(bytes);
  read_header(reader);
  MapUpdate update;
  update.x = reader.read_int32();
  update.y = reader.read_int32();
  update.width = reader.read_uint32();
  update.height = reader.read_uint32();
  update.values = reader.read_bytes();
  check_count(update.values.size(), update.width, update.height);
  return update;
}

}  // namespace gridmerge::internal
