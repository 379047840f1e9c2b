// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/report/named_merge.hpp"

namespace gridmerge {

/// What other programs read of a merge; docs/exports.md describes each.
enum class ExportFormat {
  /// A pose graph, as g2o's text files hold it: https://github.com/RainerKuemmerle/g2o/wiki/File-Format
  g2o,
  /// The points by which Open-RMF's fleet adapters find where a robot's map lies (YAML):
  /// https://github.com/open-rmf/fleet_adapter_template
  open_rmf,
  /// Outlines of maps (RFC 7946), in metres of the merged map's frame.
  geojson,
};

/// All of them, in the order in which they are told.
GRIDMERGE_EXPORT const std::vector<ExportFormat>& export_formats();

/// As users spell it: "g2o", "open-rmf", "geojson".
GRIDMERGE_EXPORT const char* name_of(ExportFormat format);

/// The one that name_of() calls so, if there is one.
GRIDMERGE_EXPORT std::optional<ExportFormat> export_format(std::string_view name);

/// What the file beside transforms.json is called, unless it is named: "merged.g2o", "open_rmf.yaml",
/// "merged.geojson".
GRIDMERGE_EXPORT const char* export_file(ExportFormat format);

/// The text of such a file: of all maps that were placed, those of each component in its own frame. Names are
/// text in it, whatever bytes they hold. The same merge gives the same bytes. Throws std::invalid_argument if
/// no map was placed, and std::out_of_range when there are fewer names or maps than the result speaks of.
/// O(cells + joins).
GRIDMERGE_EXPORT std::string export_text(ExportFormat format, const NamedMerge& merge);

/// Writes it to a file, which is replaced as a whole. Throws FileError, also if no map was placed, or if the
/// file is one of `inputs`: files that the maps were read from.
GRIDMERGE_EXPORT void write_export(ExportFormat format, const std::filesystem::path& file,
                                   const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge);

}  // namespace gridmerge
