// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// The time of a message's header, as ROS has it.
struct Stamp {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): the 0 is one that the compiler puts there
  friend auto operator<=>(const Stamp&, const Stamp&) = default;
};

/// A `nav_msgs/OccupancyGrid` as it came from a peer: nothing in it is checked, and it owns nothing.
struct MapSample {
  Stamp stamp;
  std::string_view frame;
  float resolution = 0.0F;  // [m/cell]
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::array<double, 3> position{};                       // of the origin [m]
  std::array<double, 4> orientation{0.0, 0.0, 0.0, 1.0};  // of the origin: x, y, z, w
  std::span<const std::int8_t> data;
};

/// A `map_msgs/OccupancyGridUpdate` as it came from a peer, likewise.
struct UpdateSample {
  Stamp stamp;
  std::string_view frame;
  std::int32_t x = 0;  // column of the whole map where the part begins
  std::int32_t y = 0;  // row
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::span<const std::int8_t> data;
};

/// Why a message is not used, in a few words.
class RefusedMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A map that may be used.
struct HeardMap {
  Stamp stamp;
  std::string frame;  // of the map, without a leading slash
  OccupancyGrid grid;
};

/// A part of a map that may be used.
struct HeardPart {
  Stamp stamp;
  std::string frame;   // as HeardMap's
  int x = 0;           // column where it begins
  int y = 0;           // row
  OccupancyGrid grid;  // of resolution 1 and without an origin: both are the whole map's
};

/// An origin [m] beyond this is no robot's.
inline constexpr double kFarthestOrigin = 1e7;
inline constexpr std::size_t kLongestFrame = 255;

/// The resolution is the shortest decimal number that the message's can mean, 0.05 say, as map files have it.
/// Cells are free up to 19 percent and occupied from 65 on, as nav2 reads map files. Throws RefusedMessage
/// for sizes that are 0, above kMaxGridCells or not those of the data; for a resolution that no map file may
/// have; for an origin that is not finite, too far off or not level; for cells outside -1 to 100; for a
/// frame that TF could not name; and for a time with a second or more of nanoseconds. O(cells).
HeardMap read_map(const MapSample& message);

/// Throws RefusedMessage likewise. Whether it fits its map is not asked. O(cells).
HeardPart read_update(const UpdateSample& message);

/// The values of a message: -1 unknown, 0 free, 100 occupied. O(cells).
std::vector<std::int8_t> message_values(const OccupancyGrid& grid);

/// A frame's name without a leading slash, which TF knows no longer. Throws RefusedMessage for a name that is
/// empty, begins with a further slash, is longer than kLongestFrame, or has other characters than printable
/// ASCII without blanks.
std::string read_frame(std::string_view frame);

}  // namespace gridmerge::internal
