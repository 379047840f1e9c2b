// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "bag/map_messages.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge::internal {

/// A map that messages draw: the last whole one, and the updates that came after it.
class GrowingMap {
 public:
  /// `max_cells` as in LoadOptions.
  explicit GrowingMap(std::size_t max_cells) : max_cells_(max_cells) {}

  /// Takes the message of a whole map, and returns whether it did: one without cells changes nothing. Throws
  /// ParseError, and changes nothing then.
  bool take_map(std::string_view message);

  /// Takes an update, and returns whether it did: one before any map, or one that reaches beyond the map,
  /// changes nothing. Throws ParseError, and changes nothing then.
  bool take_update(std::string_view message);

  /// Whether there is a map by now.
  bool is_there() const { return !map_.is_empty(); }

  /// The frame that the last whole map named.
  const std::string& frame_id() const { return map_.frame_id; }

  /// The map as it is; there has to be one. O(cells).
  OccupancyGrid grid() const;

  /// What is odd about the messages that drew it and about its cells. O(cells).
  std::vector<MapWarning> warnings(const OccupancyGrid& grid) const;

 private:
  std::size_t max_cells_;
  MapMessage map_;
  std::size_t useless_maps_ = 0;
  std::size_t useless_updates_ = 0;
};

}  // namespace gridmerge::internal
