// SPDX-License-Identifier: Apache-2.0
#include "bag/metadata.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "io/parse_error.hpp"
#include "io/yaml.hpp"

namespace gridmerge::internal {

std::vector<std::string> parse_metadata(std::string_view text) {
  const YAML::Node document = load_yaml(text);
  if (!document.IsMap()) throw ParseError("is no rosbag2 metadata: it has no keys");
  const YAML::Node information = document["rosbag2_bagfile_information"];
  if (!information.IsDefined() || !information.IsMap())
    throw ParseError("is no rosbag2 metadata: missing key 'rosbag2_bagfile_information'");
  const YAML::Node paths = information["relative_file_paths"];
  if (!paths.IsDefined() || !paths.IsSequence() || paths.size() == 0)
    throw ParseError("names no files ('relative_file_paths')");
  // Each file is opened, and kept open.
  constexpr std::size_t kMaxFiles = 1000;
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const YAML::Node& path : paths) {
    const std::string written = path.IsScalar() ? path.Scalar() : std::string();
    // Old recorders wrote the bag's folder too. Nobody else's word leads out of it.
    std::string name = written.substr(written.find_last_of("/\\") + 1);
    if (name.empty() || name == "." || name == ".." || name.find('\0') != std::string::npos)
      throw ParseError("'relative_file_paths' holds what is no file's name");
    if (!known.insert(name).second) continue;  // its messages are there once
    if (names.size() == kMaxFiles)
      throw ParseError(
          fmt::format("names more than {} files: join some of them (ros2 bag convert)", kMaxFiles));
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace gridmerge::internal
