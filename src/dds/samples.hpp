// SPDX-License-Identifier: Apache-2.0
// Samples as Cyclone DDS takes them: they refer to our values, and are written before these go. And samples
// as it gives them, to which what is read refers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dds/entity.hpp"
#include "dds/message.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "ros_messages.h"

namespace gridmerge::internal {

/// Cyclone DDS changes nothing in what it is given to write.
inline char* text(const std::string& value) {
  return const_cast<char*>(value.c_str());
}

/// Makes a generated sequence refer to a vector, likewise.
template <typename Sequence, typename Element>
void refer(Sequence& sequence, const std::vector<Element>& elements) {
  sequence._length = static_cast<std::uint32_t>(elements.size());
  sequence._maximum = sequence._length;
  sequence._buffer = const_cast<Element*>(elements.data());
  sequence._release = false;
}

inline builtin_interfaces_msg_dds__Time_ time_of(const Stamp& stamp) {
  return {stamp.seconds, stamp.nanoseconds};
}

/// A sample that was received, with nothing checked.
MapSample view_of(const nav_msgs_msg_dds__OccupancyGrid_& sample);
UpdateSample view_of(const map_msgs_msg_dds__OccupancyGridUpdate_& sample);

/// The system's time.
Stamp now();

/// Whether it was sent; false when a subscriber does not keep up. `what` is for the error, which is thrown as
/// by require_dds().
bool write(const DdsEntity& writer, const void* sample, std::string_view what);

/// Writes a map as nav_msgs/OccupancyGrid, likewise. O(cells).
bool write_map(const DdsEntity& writer, const OccupancyGrid& grid, const std::string& frame,
               const Stamp& stamp);

}  // namespace gridmerge::internal
