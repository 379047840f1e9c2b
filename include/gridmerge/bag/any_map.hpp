// SPDX-License-Identifier: Apache-2.0
// Maps by name, wherever they are: in map files or in bags. It is what the command line takes as a MAP.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/bag/bag.hpp"
#include "gridmerge/export.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge {

/// A file or folder, and a topic of it: "robot.mcap#/tb1/map".
struct MapName {
  std::filesystem::path file;  ///< a map file, a bag or a rosbag2 folder
  std::string topic;           ///< "" = none is named
};

/// Takes a name apart at its last '#'. A name that is a file's as it stands is that file's.
GRIDMERGE_EXPORT MapName parse_map_name(const std::filesystem::path& name);

/// The name of a topic's map: parse_map_name() takes it apart again.
GRIDMERGE_EXPORT std::filesystem::path format_map_name(const MapName& name);

/// Whether two names are of one map: the same topic, or none, of one file, by whichever path. A file that is
/// not there is the same as none. Throws nothing.
GRIDMERGE_EXPORT bool is_same_map(const std::filesystem::path& a, const std::filesystem::path& b);

/// Whether it is a bag by its content, or a folder that has a metadata.yaml. False for what cannot be read.
GRIDMERGE_EXPORT bool is_bag(const std::filesystem::path& path);

/// Reads the map of that name: a map file as load_map() does, or the last map of a bag's topic as
/// BagMaps::last() does; without a topic that of the only topic of maps. Throws FileError: the same as these
/// two, and for a topic of what is no bag. It says of a ROS 1 bag what reads it.
GRIDMERGE_EXPORT LoadedMap load_any_map(const std::filesystem::path& name, const LoadOptions& options = {});

/// The files that load_any_map() reads: those that map_files() tells, or a bag's. Throws FileError.
GRIDMERGE_EXPORT std::vector<std::filesystem::path> any_map_files(const std::filesystem::path& name,
                                                                  const LoadOptions& options = {});

}  // namespace gridmerge
