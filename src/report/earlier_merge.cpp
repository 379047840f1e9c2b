// SPDX-License-Identifier: Apache-2.0
#include "report/earlier_merge.hpp"

#include <algorithm>
#include <cstddef>
#include <system_error>

#include "gridmerge/io/file_error.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "io/file_reader.hpp"
#include "report/interchange.hpp"
#include "report/json_reader.hpp"
#include "report/output_names.hpp"

namespace gridmerge::internal {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMarkWithin = std::size_t{16} << 20;  // bytes, of an export

/// How many merged maps a transforms.json names; none where it is not a merge's.
std::size_t merged_maps_of(const fs::path& transforms) {
  try {
    FileReader reader(transforms, NamedBy::file);
    const nlohmann::json json = parse_json(reader.read_all(kMaxRecordBytes));
    const JsonReader record(json);
    const JsonReader components = record.at("components");
    record.at("joins").size();
    record.at("left_out").size();
    for (std::size_t i = 0; i < components.size(); ++i) {
      if (components.at(i).at("map").text() != component_file(i)) return 0;
    }
    return components.size();
  } catch (const FileError&) {
    return 0;
  } catch (const JsonError&) {
    return 0;
  }
}

bool is_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  return fs::is_regular_file(status) || fs::is_symlink(status);
}

}  // namespace

bool holds(const fs::path& file, std::string_view mark) {
  try {
    FileReader reader(file, NamedBy::file);
    return reader.read_up_to(kMarkWithin).find(mark) != std::string::npos;
  } catch (const FileError&) {
    return false;
  }
}

std::vector<std::string> earlier_outputs(const fs::path& directory) {
  const std::size_t merged_maps = merged_maps_of(directory / kTransforms);
  std::vector<std::string> names;
  const auto add_if = [&](const std::string& name, bool is_ours) {
    if (is_ours) names.push_back(name);
  };
  for (std::size_t i = 0; i < merged_maps; ++i) {
    const fs::path yaml = component_file(i);
    for (const fs::path& name : {yaml, fs::path(yaml).replace_extension(".pgm")})
      add_if(name.string(), is_file(directory / name));
  }
  for (const ExportFormat format : export_formats()) {
    const std::size_t files = is_text(format) ? std::min<std::size_t>(1, merged_maps) : merged_maps;
    for (std::size_t i = 0; i < files; ++i) {
      const fs::path name = numbered(export_file(format), i);
      add_if(name.string(), is_file(directory / name) && holds(directory / name, export_mark(format)));
    }
  }
  return names;
}

}  // namespace gridmerge::internal
