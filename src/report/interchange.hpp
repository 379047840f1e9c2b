// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "internal_export.hpp"
#include "merge/fused_windows.hpp"

namespace gridmerge::internal {

// What every file of a format holds, and no other program's does.
inline constexpr std::string_view kG2oMark =
    "# gridmerge: a vertex for each map that was placed, an edge for each join that was used\n";
inline constexpr std::string_view kOpenRmfMark =
    "# Where each robot's map lies, for Open-RMF's fleet adapters: ";
inline constexpr std::string_view kGeoJsonMark =
    "local coordinates, no longitude and latitude; features of different merged maps are in different frames";
inline constexpr std::string_view kGeoTiffMark = " maps; occupancy in percent, ";

/// That of a format, by which an export is known again.
std::string_view export_mark(ExportFormat format);

/// Whether export_text() has the format.
bool is_text(ExportFormat format);

// The texts of export_text(), one a format that is a text.
std::string g2o_text(const NamedMerge& merge);
std::string open_rmf_text(const NamedMerge& merge);
std::string geojson_text(const NamedMerge& merge);

/// What an export did to files.
struct ExportedFiles {
  std::vector<std::filesystem::path> written;
  /// GeoTIFFs of further merged maps that an earlier export to the same name had, and this one has not.
  std::vector<std::filesystem::path> removed;
};

/// write_export() of the public header, for who tells what it removed, too.
GRIDMERGE_INTERNAL_EXPORT ExportedFiles write_export_files(ExportFormat format,
                                                           const std::filesystem::path& file,
                                                           const std::vector<std::filesystem::path>& inputs,
                                                           const NamedMerge& merge);

/// Throws FileError if `file` is one that the maps were read from.
void protect_inputs(const std::filesystem::path& file, const std::vector<std::filesystem::path>& inputs);

/// A GeoTIFF of each merged map: `file`, and for further components files beside it (numbered()); those of an
/// earlier export that has more are removed. All of that is one step, as far as it is in one folder. Runs in
/// the calling TBB arena. Throws FileError, and std::invalid_argument for a merged map that is too large even
/// so; then all is as it was. O(cells).
ExportedFiles write_geotiff(const std::filesystem::path& file,
                            const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge);

/// What a component's merged map is fused of, in the cells of its finest map. Refers to `merge`.
FusedWindows windows_of(const NamedMerge& merge, std::size_t component);

/// Whose frame a component's merged map is in: "the map robot1.yaml".
std::string frame_owner(const NamedMerge& merge, const Component& component);

/// A text in double quotes, as YAML and JSON have it: one line of printable characters. What is not UTF-8
/// becomes U+FFFD. O(length).
std::string quoted(const std::string& text);

/// The corners of the smallest upright rectangle in the grid that holds all known cells, in the map's frame,
/// counter-clockwise; none if nothing is known. O(cells).
std::vector<Point2> known_corners(const OccupancyGrid& grid);

/// The centres of up to 16 known cells that lie all over a map, in its frame: of each of 4 x 4 parts of what
/// is known, the one nearest to its middle. O(cells).
std::vector<Point2> spread_cells(const OccupancyGrid& grid);

/// The corners of the smallest convex shape that holds all known cells where `member` puts them, in the
/// component's frame, counter-clockwise; none if nothing is known. O(cells + h log h) for a grid of h rows,
/// or h cells at the rim of what is known if the map is bent or stretched.
std::vector<Point2> known_outline(const OccupancyGrid& grid, const Member& member = {});

/// The corners of the smallest convex shape that holds all points, counter-clockwise, without those on a
/// straight line between others (Andrew 1979). O(n log n).
std::vector<Point2> convex_hull(std::vector<Point2> points);

}  // namespace gridmerge::internal
