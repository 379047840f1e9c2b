// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/io/file_error.hpp"
#include "gridmerge/merge/merge.hpp"

namespace gridmerge {

/// Makes sure, before long work, that a merge of `sources` (the paths of its inputs) can be written to
/// `directory`: creates it (and its parents) and throws FileError when it is not a directory that can be
/// written to, or when one of the sources lies there under a name that write_merge_output() would replace or
/// remove.
void prepare_merge_output(const std::filesystem::path& directory, const std::vector<std::string>& sources);

/// Writes what a merge gives to `directory`, after prepare_merge_output(): `merged.yaml` with `merged.pgm`
/// for the first component, `merged_2.yaml` and so on for further ones, `preview.png`, `report.html`, and,
/// last, `transforms.json`. `sources[i]` is the path of map i, as it is to be called in them.
///
/// All files are complete on the disk before the first takes its place: when the disk is full, the directory
/// stays as it was. Every other `merged.yaml`, `merged_<number>.yaml` and `.pgm` in the directory is then
/// removed, so that no map of an earlier run looks like one of this run; without a component there is no
/// `merged.yaml`. Throws FileError.
void write_merge_output(const std::filesystem::path& directory, const std::vector<std::string>& sources,
                        const std::vector<OccupancyGrid>& maps, const MergeResult& result);

}  // namespace gridmerge
