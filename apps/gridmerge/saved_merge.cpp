// SPDX-License-Identifier: Apache-2.0
#include "saved_merge.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "gridmerge/bag/bag.hpp"
#include "gridmerge/report/merge_record.hpp"

namespace gridmerge::cli {

namespace {

LoadedMap load_map_of(const std::string& name, const SavedMergeOptions& options, MapReader& reader) {
  const std::filesystem::path path = std::filesystem::path(options.root) / name;
  std::error_code error;
  if (!std::filesystem::exists(parse_map_name(path).file, error))
    throw FileError(path,
                    "is not there, and the report shows it: name the folder from which the maps were merged "
                    "with --root FOLDER");
  return reader.read(path.string());
}

/// The report does without it: its maps are what it is about.
std::optional<LoadedMap> load_plan_of(const PlanPlacement& plan, double usual_resolution,
                                      const SavedMergeOptions& options, Console& console) {
  const std::string path = (std::filesystem::path(options.root) / plan.name).string();
  LoadOptions load = options.load;
  load.regular_files_only = true;
  // The scale that was found counts from these metres, whatever an option says of the maps.
  load.resolution = plan.resolution > 0.0 ? plan.resolution : usual_resolution;
  try {
    LoadedMap loaded = load_any_map(path, load);
    if (plan.resolution > 0.0 && loaded.grid.resolution != plan.resolution)
      throw FileError(path, fmt::format("has pixels of {:.6g} m, and had {:.6g} m when it was merged",
                                        loaded.grid.resolution, plan.resolution));
    return loaded;
  } catch (const FileError& error) {
    console.warn(fmt::format("{}; the report does not show the plan", error.what()));
    return std::nullopt;
  }
}

}  // namespace

void add_saved_merge_options(CLI::App& command, SavedMergeOptions& options) {
  command.add_option("DIR", options.directory, "Directory that 'gridmerge merge' wrote to")
      ->type_name("DIR")
      ->required();
  command
      .add_option("--root", options.root,
                  "Folder from which the maps were merged, if it is not the current one")
      ->type_name("FOLDER");
  add_map_file_options(command, options.load);
}

SavedMerge load_saved_merge(const SavedMergeOptions& options, Console& console) {
  MergeRecord record = read_merge_record(options.directory);
  SavedMerge merge;
  LoadOptions load = options.load;
  load.regular_files_only = true;
  MapReader reader(load, console);
  for (const std::string& name : record.names) {
    LoadedMap map = load_map_of(name, options, reader);
    merge.maps.push_back(std::move(map.grid));
    merge.files.insert(merge.files.end(), map.files.begin(), map.files.end());
  }
  reader.tell_warnings();
  if (record.result.plan) {
    if (auto plan = load_plan_of(*record.result.plan, merge.maps.front().resolution, options, console)) {
      merge.plan = std::move(plan->grid);
      merge.files.insert(merge.files.end(), plan->files.begin(), plan->files.end());
    }
  }
  for (const std::size_t component : fuse_again(record, merge.maps, options.directory)) {
    console.warn((std::filesystem::path(options.directory) / component_file(component)).string() +
                 ": is not what the maps give: it or they have been changed since");
  }
  merge.fingerprint = record.fingerprint;
  merge.names = std::move(record.names);
  merge.result = std::move(record.result);
  return merge;
}

}  // namespace gridmerge::cli
