// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// A merge as outputs show it: with its maps, and what they are called. Not owned: all of it outlives this.
/// What takes one throws std::out_of_range when a map that it speaks of has no name, and
/// std::invalid_argument for a component without members.
struct NamedMerge {
  const std::vector<std::string>& names;   ///< `names[i]` is what to call map i
  const std::vector<OccupancyGrid>& maps;  ///< as given to merge()
  const MergeResult& result;               ///< as merge() returned it
  /// As given to place_on_plan(): report and preview draw it. Null: no plan, or one that is not at hand.
  const OccupancyGrid* plan = nullptr;
};

/// Makes sure, before long work, that a merge can be written to `directory`: throws FileError when it is not
/// a directory, and cannot be made one, that can be written to, or when one of `inputs` (all files that the
/// maps were read from, images too: LoadedMap::files) lies there under a name that write_merge_output() would
/// replace or remove. Leaves everything as it was: a directory that is made to try is removed again.
GRIDMERGE_EXPORT void prepare_merge_output(const std::filesystem::path& directory,
                                           const std::vector<std::filesystem::path>& inputs);

/// Makes sure, before long work, that what comes of the maps can be written: throws FileError, naming the
/// map, when one alone has more than kMaxGridCells of `resolution` [m] (0: merged maps are drawn so that they
/// fit), or lies so far from zero that the merged map may begin further off than a map file can say. Returns
/// a resolution to choose where the merged map may have more cells than that, as all maps side by side have;
/// else nothing. Throws std::invalid_argument for a resolution that is neither 0 nor within [kMinResolution,
/// kMaxResolution], and std::out_of_range when there are fewer names than maps. O(cells).
GRIDMERGE_EXPORT std::optional<double> check_merged_size(const std::vector<std::string>& names,
                                                         const std::vector<OccupancyGrid>& maps,
                                                         double resolution);

/// Writes what a merge gives to `directory`, which is made if need be, with its parents: `merged.yaml` with
/// `merged.pgm` for the first component, `merged_2.yaml` and so on for further ones, `preview.png`,
/// `report.html` and `transforms.json`. `inputs` as in prepare_merge_output(), which is called first.
///
/// Merged maps of an earlier merge, which its `transforms.json` in the directory names, are removed where
/// this one has none of the name, and so are exports (export_file()) that gridmerge wrote of them: nothing of
/// that merge looks like this one's. Returns the files that it removed. Other files of the directory stay.
///
/// At every point of time who opens files by name finds all of an earlier run's or all of this one's, whether
/// the program is killed, the disk is full or another merge writes there too; what a killed one has left is
/// put in order first. Throws FileError, and std::invalid_argument as transforms_json(): then the directory
/// is as it was, or is not made.
GRIDMERGE_EXPORT std::vector<std::filesystem::path> write_merge_output(
    const std::filesystem::path& directory, const std::vector<std::filesystem::path>& inputs,
    const NamedMerge& merge);

/// Writes `report.html` alone to `directory`, which is there. Arguments as of write_merge_output(). Throws
/// FileError, also when one of the inputs would be replaced. `fingerprint` is that of the MergeRecord that
/// the merge was read as: then also when the directory holds another merge by now, which the report would
/// belie.
GRIDMERGE_EXPORT void write_report(const std::filesystem::path& directory,
                                   const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge,
                                   std::optional<std::uint64_t> fingerprint = std::nullopt);

/// What other programs read of a merge; docs/exports.md describes each.
enum class ExportFormat {
  /// A pose graph, as g2o's text files hold it: https://github.com/RainerKuemmerle/g2o/wiki/File-Format
  g2o,
  /// The points by which Open-RMF's fleet adapters find where a robot's map lies (YAML):
  /// https://github.com/open-rmf/fleet_adapter_template
  open_rmf,
  /// Outlines of maps (RFC 7946), in metres of the merged map's frame.
  geojson,
  /// The merged maps themselves as cloud-optimised GeoTIFFs, in the cells of their finest maps, and of any
  /// size: up to 2^36 cells, and 2^19 per side.
  geotiff,
};

/// All of them, in the order in which they are listed.
GRIDMERGE_EXPORT std::span<const ExportFormat> export_formats();

/// As users spell it: "g2o", "open-rmf", "geojson", "geotiff".
GRIDMERGE_EXPORT const char* name_of(ExportFormat format);

/// The one that name_of() calls so, if there is one.
GRIDMERGE_EXPORT std::optional<ExportFormat> export_format(std::string_view name);

/// What the file beside transforms.json is called, unless it is named: "merged.g2o", "open_rmf.yaml",
/// "merged.geojson", "merged.tif".
GRIDMERGE_EXPORT const char* export_file(ExportFormat format);

/// The text of such a file: of all maps that were placed, those of each component in its own frame. Names are
/// text in it, whatever bytes they hold. The same merge gives the same bytes. Throws std::invalid_argument if
/// no map was placed, or the format is no text (`geotiff`), and std::out_of_range when there are fewer names
/// or maps than the result speaks of. O(cells + joins).
GRIDMERGE_EXPORT std::string export_text(ExportFormat format, const NamedMerge& merge);

/// Writes it to a file, which is replaced as a whole, and returns the files that it wrote: of `geotiff` one
/// for each component, `file`, then file_2 and so on beside it. These are replaced together, and those that
/// an earlier export to `file` had more of are removed. Throws FileError, also if no map was placed, or if
/// such a file is one of `inputs`: files that the maps were read from. Runs in the calling TBB arena
/// (with_threads()). O(cells + joins); of `geotiff` also O(cells of the merged maps).
GRIDMERGE_EXPORT std::vector<std::filesystem::path> write_export(
    ExportFormat format, const std::filesystem::path& file, const std::vector<std::filesystem::path>& inputs,
    const NamedMerge& merge);

/// A colour, 8 bits a channel.
struct Colour {
  std::uint8_t red = 0;    ///< 0 to 255
  std::uint8_t green = 0;  ///< 0 to 255
  std::uint8_t blue = 0;   ///< 0 to 255

  /// Whether all channels are equal.
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// The colour of input map i, of its walls. The first six are distinct to colour-blind eyes too; further maps
/// get darker and lighter shades of them.
GRIDMERGE_EXPORT Colour map_colour(std::size_t map);

/// A PNG that shows a merge: each component with its maps in their own colours, what they share and where
/// they disagree, a scale bar in metres, and the colours' meaning; below, the maps that were left out, each
/// by itself in its own frame. The walls of a plan are drawn where no map has one, as far from the maps as
/// these are long; a single map that hangs there is shown like a component. Of each kind the first twelve are
/// shown, and how many more there are. Small maps are magnified, large ones drawn at a coarser resolution:
/// the picture is at most 2400 pixels wide, and no map in it higher. Names are UTF-8; folders that all of
/// them lie in are not shown.
GRIDMERGE_EXPORT std::string preview_png(const NamedMerge& merge);

}  // namespace gridmerge
