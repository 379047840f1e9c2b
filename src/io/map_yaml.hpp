// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/message_values.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/io/map_file.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// How pixels become cells; see load_map.
enum class MapMode { trinary, scale, raw };

/// What a map_server YAML says. The defaults are nav2's usual values.
struct MapYaml {
  std::string image;        ///< as written: relative to the YAML's directory, or absolute
  double resolution = 0.0;  ///< [m/cell]
  SE2 origin;               ///< pose of the lower-left corner of the lower-left pixel
  double occupied_thresh = kOccupiedThreshold;
  double free_thresh = kFreeThreshold;
  bool negate = false;
  MapMode mode = MapMode::trinary;
  std::vector<MapWarning> warnings;  ///< of what was not read to the letter
};

/// Reads the text of a map_server YAML. Throws ParseError for what load_map says is refused, naming the key.
MapYaml parse_map_yaml(std::string_view text);

/// The text that parse_map_yaml reads back to the same values. Throws ParseError when `image` cannot be
/// written in YAML (it is not UTF-8).
std::string format_map_yaml(const MapYaml& map);

/// Throws ParseError unless a map of `resolution` [m/cell] is within [kMinResolution, kMaxResolution].
GRIDMERGE_INTERNAL_EXPORT void check_resolution(double resolution);

}  // namespace gridmerge::internal
