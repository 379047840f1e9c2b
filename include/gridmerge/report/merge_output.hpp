// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/report/named_merge.hpp"

namespace gridmerge {

/// Whether a file of this name in the output directory is a merge's own: written, replaced or removed by it.
GRIDMERGE_EXPORT bool is_merge_output(const std::filesystem::path& name);

/// Makes sure, before long work, that a merge can be written to `directory`: throws FileError when it is not
/// a directory, and cannot be made one, that can be written to, or when one of `inputs` (all files that the
/// maps were read from, images too: LoadedMap::files) lies there under a name that write_merge_output() would
/// replace or remove. Leaves everything as it was: a directory that is made to try is removed again.
GRIDMERGE_EXPORT void prepare_merge_output(const std::filesystem::path& directory,
                                           const std::vector<std::filesystem::path>& inputs);

/// Makes sure, before long work, that what comes of the maps can be written: throws FileError, naming the
/// map, when one alone has more than 2^28 cells of `resolution` [m] (0: that of the finest map that is
/// placed, so that nothing is sure yet), or lies so far from zero that the merged map may begin further off
/// than a map file can say. Returns a resolution to choose where the merged map may have more cells than
/// that, as all maps side by side have; else nothing. O(cells).
GRIDMERGE_EXPORT std::optional<double> check_merged_size(const std::vector<std::string>& names,
                                                         const std::vector<OccupancyGrid>& maps,
                                                         double resolution);

/// Writes what a merge gives to `directory`, which is made if need be, with its parents: `merged.yaml` with
/// `merged.pgm` for the first component, `merged_2.yaml` and so on for further ones, `preview.png`,
/// `report.html` and `transforms.json`. `inputs` as in prepare_merge_output(), which is called first.
///
/// Every other `merged.yaml`, `merged_<number>.yaml` and `.pgm` in the directory is removed, and so are the
/// exports of an earlier run (export_file()), so that nothing of it looks like this run's; without a
/// component there is no `merged.yaml`. At every point of time who opens files by name finds all of an
/// earlier run's or all of this one's, whether the program is killed, the disk is full or another merge
/// writes there too; what a killed one has left is put in order first. Other files of the directory stay.
/// Throws FileError: then the directory is as it was, or is not made.
GRIDMERGE_EXPORT void write_merge_output(const std::filesystem::path& directory,
                                         const std::vector<std::filesystem::path>& inputs,
                                         const NamedMerge& merge);

/// Writes `report.html` alone to `directory`, which is there. Arguments as of write_merge_output(). Throws
/// FileError, also when one of the inputs would be replaced.
GRIDMERGE_EXPORT void write_report(const std::filesystem::path& directory,
                                   const std::vector<std::filesystem::path>& inputs, const NamedMerge& merge);

}  // namespace gridmerge
