// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/file_error.hpp"

namespace gridmerge {

/// How map files are read.
struct LoadOptions {
  double resolution = 0.0;                ///< [m/cell] of a bare image; 0 = a bare image is an error
  std::size_t max_cells = kMaxGridCells;  ///< larger maps are refused before memory is taken for them
  /// Read thresholds to the letter: in trinary mode the gray that map savers write for unknown is then
  /// whatever the thresholds make of it.
  bool literal_thresholds = false;
  /// For a map that another file names: a pipe or a device is an error, as it may never end. A map's image
  /// always has to be a regular file.
  bool regular_files_only = false;
};

/// What a warning about a map's file is about. Warnings of one kind differ in their figures only.
enum class MapWarningKind {
  unknown_gray,        ///< the gray that map savers write for unknown is unknown, whatever the thresholds say
  gray_is_known,       ///< that gray is loaded as free or occupied
  alpha,               ///< nav2 would read the picture's transparent pixels otherwise
  image_elsewhere,     ///< the image is not where the YAML says, but beside it
  yaw_not_a_number,    ///< it is read as 0
  long_origin,         ///< the origin has a fourth number
  negate_in_raw_mode,  ///< where it has no effect
  no_known_cell,       ///< all are unknown
  no_occupied_cell,    ///< all known ones are free
  no_free_cell,        ///< all known ones are occupied
  painted_black,       ///< most of the map is occupied, far from any free cell
  not_a_percentage,    ///< of a message: values below -1 or above 100 are unknown
  no_rotation,         ///< of a message: its orientation is four zeros, read as no turn
  no_cells,            ///< of a bag: messages of a map without cells are passed over
  useless_update,      ///< of a bag: updates that reach beyond their map are passed over
  cut_off,             ///< of a bag: its file ends within a record
};

/// What a map's file may not have meant.
struct MapWarning {
  MapWarningKind kind;  ///< what it is about
  std::string text;     ///< a sentence, without the file's name
};

/// A map, and what there is to say of its files.
struct LoadedMap {
  OccupancyGrid grid;                        ///< what the files hold
  std::vector<MapWarning> warnings;          ///< what the file says that its author may not have meant
  std::vector<std::filesystem::path> files;  ///< what it was read from, as map_files() tells
};

/// Reads a map_server YAML with its image (PGM, PPM, PNG, BMP or JPEG, told apart by content), or a bare
/// image with `options.resolution`, origin 0 and nav2's usual thresholds (0.65 and 0.196).
///
/// A pixel's occupancy p is 1 - lightness (lightness with `negate`), lightness the mean of its colour
/// channels.
/// - `trinary`: occupied where p > occupied_thresh, free where p < free_thresh, else unknown.
/// - `scale`: the same cells; `probability` is 1, 0 and, between the thresholds, p stretched to [0, 1].
/// - `raw`: the 8-bit lightness is the occupancy in percent, above 100 unknown; `probability` holds it.
///   Occupied from occupied_thresh on, free up to free_thresh (what map_saver does with percentages), else
///   unknown. No `negate`.
///
/// This is nav2's map_io but for alpha: a pixel that is not opaque is unknown in `trinary` and `scale`, and
/// alpha never counts as colour. (nav2 averages it into the lightness in `trinary`; a warning says where that
/// makes a difference.)
///
/// What files hold that were not made for the letter of these rules is read as it was meant, with a warning:
/// - in `trinary`, lightness 205 of 255 (50 with `negate`) is unknown whatever the thresholds: map savers
///   write it for unknown, many beside a free_thresh of 0.25. Of a JPEG, whose pixels are a little off, so is
///   all that is nearer to 205 than to the 254 of free cells. `options.literal_thresholds` turns this off;
/// - an image that is not at its path (that of another machine) is looked for by its name beside the YAML;
/// - a yaw that is not a number is 0; a fourth number of the origin is passed over, as ROS 1 does.
///
/// Refused: resolutions outside [kMinResolution, kMaxResolution], origins that are not finite or beyond 1e9
/// m, thresholds outside [0, 1] or crossed, YAML above 1 MiB, images with less data than their header
/// promises (more is tolerated). Throws FileError. O(pixels); peak memory is the file and 3
/// to 8 bytes per cell, of a progressive JPEG up to 6 more.
GRIDMERGE_EXPORT LoadedMap load_map(const std::filesystem::path& path, const LoadOptions& options = {});

/// The files that load_map(path) reads: the YAML and its image, or a bare image alone. The image is not
/// opened, and need not be there. Throws FileError for a YAML that load_map refuses. O(bytes of the YAML).
GRIDMERGE_EXPORT std::vector<std::filesystem::path> map_files(const std::filesystem::path& path,
                                                              const LoadOptions& options = {});

/// Writes the map for map_server: the YAML, and beside it the image, of the same name but for its ending
/// `.pgm` (trinary: occupied 0, free 254, unknown 205; thresholds 0.65 and 0.196). `yaml_path` must end in
/// .yaml or .yml. Loading gives the same cells, resolution and origin, to the bit (an angle that is in
/// (-pi, pi]); probabilities are not kept.
///
/// Both files take their places at one point of time, even if the program is killed. A link of such a name is
/// replaced, not followed. Throws FileError, then the old files are there and nothing is left behind, or
/// std::invalid_argument for a grid that `validate` refuses.
GRIDMERGE_EXPORT void save_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path);

/// Writes the map with its probabilities: mode `raw`, a pixel the occupancy in percent, 255 unknown. Loading
/// gives the same cells, and the probabilities to within a percent. A known cell without a probability gets
/// that of its kind, 0 or 1. The thresholds are 0.65 and 0.196 if these tell the cells apart, and else what
/// does; nav2's own reader ignores them in this mode. Where no percentages tell free, unknown and occupied
/// cells apart, loading gives the cells that follow from 0.65 and 0.196.
///
/// Throws as save_map(), and std::invalid_argument for a grid without probabilities.
GRIDMERGE_EXPORT void save_probability_map(const OccupancyGrid& grid, const std::filesystem::path& yaml_path);

}  // namespace gridmerge
