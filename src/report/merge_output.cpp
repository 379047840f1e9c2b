// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/merge_output.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "gridmerge/io/atomic_file.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/report/json.hpp"
#include "gridmerge/report/page.hpp"
#include "gridmerge/report/preview.hpp"

namespace gridmerge {

namespace {

namespace fs = std::filesystem;

constexpr const char* kPreview = "preview.png";
constexpr const char* kReport = "report.html";
constexpr const char* kTransforms = "transforms.json";

// A directory that can be written to, made if need be with its parents. What was made is removed with this
// object unless there is something in it by then, so that work that fails leaves no empty directory behind.
class OutputDirectory {
 public:
  explicit OutputDirectory(const fs::path& directory) : missing_(missing_parts(directory)) {
    std::error_code error;
    fs::create_directories(directory, error);
    if (error) {
      remove_empty();
      throw FileError(directory, "cannot be created: " + error.message());
    }
    if (::access(directory.c_str(), W_OK | X_OK) != 0) {
      throw FileError(directory, "cannot be written to: " + std::generic_category().message(errno));
    }
  }
  ~OutputDirectory() { remove_empty(); }
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

 private:
  // The innermost first.
  static std::vector<fs::path> missing_parts(const fs::path& directory) {
    std::vector<fs::path> missing;
    std::error_code error;
    for (fs::path part = directory; !part.empty() && !fs::exists(part, error); part = part.parent_path()) {
      missing.push_back(part);
    }
    return missing;
  }

  void remove_empty() const {
    for (const fs::path& part : missing_) ::rmdir(part.c_str());
  }

  std::vector<fs::path> missing_;
};

// merged.yaml, merged_<number>.yaml, and the same as .pgm.
bool is_merged_map(const fs::path& file) {
  if (file.extension() != ".yaml" && file.extension() != ".pgm") return false;
  constexpr std::string_view kFirst = "merged", kFurther = "merged_";
  const std::string stem = file.stem().string();
  if (stem == kFirst) return true;
  const std::string_view number = std::string_view(stem).substr(std::min(stem.size(), kFurther.size()));
  return stem.starts_with(kFurther) && !number.empty() &&
         number.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

bool is_merge_output(const fs::path& name) {
  return is_merged_map(name) || name == kPreview || name == kReport || name == kTransforms;
}

namespace {

// The files in the directory whose names are those of a merge's outputs.
std::vector<fs::path> outputs_in(const fs::path& directory) {
  std::vector<fs::path> outputs;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path name = entry->path().filename();
    if (is_merge_output(name)) outputs.push_back(directory / name);
  }
  if (error) throw FileError(directory, "cannot be read: " + error.message());
  return outputs;
}

void remove_stale_maps(const fs::path& directory, std::size_t components) {
  std::set<fs::path> current;
  for (std::size_t i = 0; i < components; ++i) {
    const fs::path yaml = directory / component_file(i);
    current.insert(yaml);
    current.insert(fs::path(yaml).replace_extension(".pgm"));
  }
  for (const fs::path& path : outputs_in(directory)) {
    if (!is_merged_map(path.filename()) || current.contains(path)) continue;
    std::error_code error;
    if (fs::is_directory(path, error)) continue;  // no map of ours
    fs::remove(path, error);
    if (error) throw FileError(path, "is of an earlier run and cannot be removed: " + error.message());
  }
}

// No file that a map was read from may bear the name of an output, whichever way it was named itself.
void protect(const std::vector<fs::path>& inputs, const fs::path& directory) {
  for (const fs::path& output : outputs_in(directory)) {
    for (const fs::path& input : inputs) {
      std::error_code absent;
      if (fs::equivalent(output, input, absent)) {
        throw FileError(input,
                        "is an input and would be replaced or removed: choose another output directory");
      }
    }
  }
}

}  // namespace

void prepare_merge_output(const fs::path& directory, const std::vector<fs::path>& inputs) {
  const OutputDirectory output(directory);
  protect(inputs, directory);
}

void write_merge_output(const fs::path& directory, const std::vector<fs::path>& inputs,
                        const std::vector<std::string>& names, const std::vector<OccupancyGrid>& maps,
                        const MergeResult& result) {
  const OutputDirectory output(directory);
  protect(inputs, directory);
  std::vector<StagedFile> files;
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    for (StagedFile& file : stage_map(result.components[i].fused.grid, directory / component_file(i))) {
      files.push_back(std::move(file));
    }
  }
  files.emplace_back(directory / kPreview, preview_png(names, maps, result));
  files.emplace_back(directory / kReport, report_page(names, maps, result));
  files.emplace_back(directory / kTransforms, transforms_json(names, result));

  for (StagedFile& file : files) file.commit();
  remove_stale_maps(directory, result.components.size());
}

void write_report(const fs::path& directory, const std::vector<fs::path>& inputs,
                  const std::vector<std::string>& names, const std::vector<OccupancyGrid>& maps,
                  const MergeResult& result) {
  protect(inputs, directory);
  write_file_atomically(directory / kReport, report_page(names, maps, result));
}

}  // namespace gridmerge
