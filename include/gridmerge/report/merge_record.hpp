// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/file_error.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// `transforms.json` of a merge, indented: all that there is to say of it but the maps' cells, the order of
/// the maps included, and no times, so that the same merge gives the same bytes. Keys come in the order in
/// which the documentation lists them, numbers in the shortest form that reads back to the same bits.
/// `names[i]` is what to call map i, and may hold any bytes but null: where one is not UTF-8, all are
/// escaped, and parse_transforms() takes that back. Throws std::out_of_range when there are fewer names than
/// maps, and std::invalid_argument for an empty name or one with a null, a component without members, and a
/// number that is not finite.
GRIDMERGE_EXPORT std::string transforms_json(const std::vector<std::string>& names,
                                             const MergeResult& result);

/// The file of a component's map beside transforms.json, by its place in the result: merged.yaml,
/// merged_2.yaml, ...
GRIDMERGE_EXPORT std::string component_file(std::size_t component);

/// What `transforms.json` keeps of a merge.
struct MergeRecord {
  std::vector<std::string> names;  ///< of all maps, in their order
  /// As merge() returned it, but for what is not kept: the fused maps have their omega and no more (see
  /// fuse_again()), and of a join's match there are no times.
  MergeResult result;
  /// Of the text that it was read from: other texts have others, as good as surely.
  std::uint64_t fingerprint = 0;
};

/// Reads the text of a `transforms.json`. Strict: every key that transforms_json() writes has to be there and
/// to make sense with the others, angles lie in (-pi, pi], each map is in one place. Keys that it does not
/// know are passed over. `file` is what to call it. Throws FileError that says what is wrong where:
/// "file: joins[2].transform.x is no number". O(bytes).
GRIDMERGE_EXPORT MergeRecord parse_transforms(const std::filesystem::path& file, std::string_view text);

/// The same of a file. Throws FileError also when there is none, or it exceeds 256 MiB.
GRIDMERGE_EXPORT MergeRecord read_transforms(const std::filesystem::path& file);

/// The same of `directory`/transforms.json.
GRIDMERGE_EXPORT MergeRecord read_merge_record(const std::filesystem::path& directory);

/// Fuses the maps of every component anew, at the resolutions of the merged maps that lie in `directory`,
/// which gives what merge() gave if the maps are the same. `maps[i]` is map i of the record, with as many
/// maps as names. Returns the components, ascending, whose file holds other cells: it or a map has been
/// changed since. Throws FileError for a merged map that cannot be read, or not be fused again, and
/// std::invalid_argument for another number of maps. Time as fuse().
GRIDMERGE_EXPORT std::vector<std::size_t> fuse_again(MergeRecord& record,
                                                     const std::vector<OccupancyGrid>& maps,
                                                     const std::filesystem::path& directory);

}  // namespace gridmerge
