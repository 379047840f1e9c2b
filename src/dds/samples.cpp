// SPDX-License-Identifier: Apache-2.0
#include "dds/samples.hpp"

#include <dds/dds.h>

#include <chrono>
#include <cmath>
#include <span>

#include "dds/loan.hpp"

namespace gridmerge::internal {

namespace {

template <typename Sequence>
std::span<const std::int8_t> values_of(const Sequence& sequence) {
  return {reinterpret_cast<const std::int8_t*>(sequence._buffer), sequence._length};
}

}  // namespace

MapSample view_of(const nav_msgs_msg_dds__OccupancyGrid_& sample) {
  MapSample message;
  message.stamp = {sample.header.stamp.sec, sample.header.stamp.nanosec};
  message.frame = text_of(sample.header.frame_id);
  message.resolution = sample.info.resolution;
  message.width = sample.info.width;
  message.height = sample.info.height;
  const auto& position = sample.info.origin.position;
  const auto& orientation = sample.info.origin.orientation;
  message.position = {position.x, position.y, position.z};
  message.orientation = {orientation.x, orientation.y, orientation.z, orientation.w};
  message.data = values_of(sample.data);
  return message;
}

UpdateSample view_of(const map_msgs_msg_dds__OccupancyGridUpdate_& sample) {
  UpdateSample message;
  message.stamp = {sample.header.stamp.sec, sample.header.stamp.nanosec};
  message.frame = text_of(sample.header.frame_id);
  message.x = sample.x;
  message.y = sample.y;
  message.width = sample.width;
  message.height = sample.height;
  message.data = values_of(sample.data);
  return message;
}

Stamp now() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(since);
  return {static_cast<std::int32_t>(seconds.count()),
          static_cast<std::uint32_t>(std::chrono::nanoseconds(since - seconds).count())};
}

bool write(const DdsEntity& writer, const void* sample, std::string_view what) {
  const dds_return_t code = dds_write(writer.get(), sample);
  if (code == DDS_RETCODE_TIMEOUT) return false;
  require_dds(code, what);
  return true;
}

bool write_map(const DdsEntity& writer, const OccupancyGrid& grid, const std::string& frame,
               const Stamp& stamp) {
  std::vector<std::int8_t> values = message_values(grid);
  nav_msgs_msg_dds__OccupancyGrid_ sample{};
  sample.header.stamp = time_of(stamp);
  sample.header.frame_id = text(frame);
  sample.info.map_load_time = time_of(stamp);
  sample.info.resolution = static_cast<float>(grid.resolution);
  sample.info.width = static_cast<std::uint32_t>(grid.width);
  sample.info.height = static_cast<std::uint32_t>(grid.height);
  sample.info.origin.position = {grid.origin.x, grid.origin.y, 0.0};
  sample.info.origin.orientation = {0.0, 0.0, std::sin(grid.origin.theta / 2),
                                    std::cos(grid.origin.theta / 2)};
  refer(sample.data, values);
  return write(writer, &sample, "a map");
}

}  // namespace gridmerge::internal
