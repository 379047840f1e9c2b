// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/report/merge_output.hpp"

namespace gridmerge::cli {

/// Which merge that was written before, and where its maps are.
struct SavedMergeOptions {
  std::string directory;
  std::string root;  // folder that the maps' names start from; "" = the current one
  LoadOptions load;
};

/// DIR, --root and the options of map files.
void add_saved_merge_options(CLI::App& command, SavedMergeOptions& options);

/// A merge as it was when its results were written.
struct SavedMerge {
  std::vector<std::string> names;
  std::vector<OccupancyGrid> maps;
  std::optional<OccupancyGrid> plan;         // if the merge has one that is still there
  std::vector<std::filesystem::path> files;  // that all of it was read from
  MergeResult result;
  std::uint64_t fingerprint = 0;  // MergeRecord::fingerprint

  NamedMerge named() const { return {names, maps, result, plan ? &*plan : nullptr}; }
};

/// Reads what 'gridmerge merge' wrote, and the maps that it names. Warns of merged maps that differ from what
/// their maps give now, and of a plan that cannot be read. Throws FileError.
SavedMerge load_saved_merge(const SavedMergeOptions& options, Console& console);

}  // namespace gridmerge::cli
