// SPDX-License-Identifier: Apache-2.0
#include "dds/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gridmerge/grid/message_values.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::int8_t kUnknown = -1;
constexpr std::int8_t kFree = 0;
constexpr std::int8_t kOccupied = 100;

/// A message means what a map file of the same values does.
OccupancyGrid read_cells(std::uint32_t width, std::uint32_t height, double resolution, const SE2& origin,
                         std::span<const std::int8_t> data) {
  if (width == 0 || height == 0) throw RefusedMessage(fmt::format("a size of {} x {} cells", width, height));
  // Of two numbers of 32 bits, so the product does not overflow.
  const std::uint64_t size = std::uint64_t{width} * height;
  if (size > kMaxGridCells) throw RefusedMessage(fmt::format("{} x {} cells are above 2^28", width, height));
  if (data.size() != size)
    throw RefusedMessage(fmt::format("{} values for {} x {} cells", data.size(), width, height));
  const auto wrong = std::find_if(data.begin(), data.end(),
                                  [](std::int8_t value) { return value < kUnknown || value > kOccupied; });
  if (wrong != data.end())
    throw RefusedMessage(
        fmt::format("the cell value {}, which is neither -1 nor a percentage", static_cast<int>(*wrong)));
  return grid_of_percentages(static_cast<int>(width), static_cast<int>(height), resolution, origin, data);
}

double read_resolution(float resolution) {
  if (!std::isfinite(resolution)) throw RefusedMessage(fmt::format("a resolution of {} m", resolution));
  const double read = decimal_of(resolution);
  if (!is_resolution(read)) throw RefusedMessage(fmt::format("a resolution of {} m", resolution));
  return read;
}

Stamp read_stamp(const Stamp& stamp) {
  constexpr std::uint32_t kNanosecondsPerSecond = 1'000'000'000;
  if (stamp.nanoseconds >= kNanosecondsPerSecond)
    throw RefusedMessage(fmt::format("a time with {} ns", stamp.nanoseconds));
  return stamp;
}

/// A quaternion of four zeros is none, as in bags.
double read_yaw(const std::array<double, 4>& orientation) {
  const auto& [x, y, z, w] = orientation;
  const Yaw yaw = yaw_of({x, y, z, w});
  if (yaw.kind == Rotation::not_unit) throw RefusedMessage("an orientation that is no unit quaternion");
  if (yaw.kind == Rotation::tilted) throw RefusedMessage("an origin that is not level");
  return yaw.theta;
}

}  // namespace

std::string read_frame(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  if (frame.empty()) throw RefusedMessage("no frame_id");
  if (frame.starts_with('/')) throw RefusedMessage("a frame_id that begins with more than one '/'");
  if (frame.size() > kLongestFrame)
    throw RefusedMessage(fmt::format("a frame_id of {} characters", frame.size()));
  if (!std::all_of(frame.begin(), frame.end(), [](char c) { return c > ' ' && c < '\x7f'; }))
    throw RefusedMessage("a frame_id with other than printable ASCII characters");
  return std::string(frame);
}

HeardMap read_map(const MapSample& message) {
  HeardMap heard{read_stamp(message.stamp), read_frame(message.frame), {}};
  // Sizes first: they are cheap to look at.
  const double resolution = read_resolution(message.resolution);
  const auto& [x, y, z] = message.position;
  if (!(std::abs(x) <= kFarthestOrigin && std::abs(y) <= kFarthestOrigin && std::isfinite(z)))
    throw RefusedMessage(fmt::format("an origin at ({}, {}, {})", x, y, z));
  const double yaw = read_yaw(message.orientation);
  heard.grid = read_cells(message.width, message.height, resolution, {x, y, yaw}, message.data);
  return heard;
}

HeardPart read_update(const UpdateSample& message) {
  HeardPart part{read_stamp(message.stamp), read_frame(message.frame), 0, 0, {}};
  if (message.x < 0 || message.y < 0)
    throw RefusedMessage(fmt::format("an update at ({}, {})", message.x, message.y));
  part.x = message.x;
  part.y = message.y;
  part.grid = read_cells(message.width, message.height, 1.0, {}, message.data);
  return part;
}

std::vector<std::int8_t> message_values(const OccupancyGrid& grid) {
  constexpr std::array<std::int8_t, 3> kValues{kUnknown, kFree, kOccupied};
  std::vector<std::int8_t> values(grid.cells.size());
  std::transform(grid.cells.begin(), grid.cells.end(), values.begin(),
                 [&](Cell cell) { return kValues[static_cast<std::size_t>(cell)]; });
  return values;
}

}  // namespace gridmerge::internal
