// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// A file that cannot be read or written: the message names the file and the cause, on one line.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LoadOptions {
  double resolution = 0.0;          ///< [m/cell] of a bare image; 0 = a bare image is an error
  std::size_t max_cells = 1u << 28;  ///< larger maps are refused
};

struct LoadedMap {
  OccupancyGrid grid;
  std::vector<std::string> warnings;  ///< what the file says that its author may not have meant, a sentence each
};

/// Reads a map_server YAML with its image (PGM or PNG), or a bare image with `options.resolution`.
/// Follows nav2's map_io. Throws FileError.
LoadedMap load_map(const std::filesystem::path& path, const LoadOptions& options = {});

/// Writes `<stem>.yaml` and `<stem>.pgm` for map_server (trinary: occupied 0, free 254, unknown 205; thresholds 0.65
/// and 0.196), each to a temporary file that is then renamed. Throws FileError.
void save_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path);

}  // namespace gridmerge
