// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "search_options.hpp"

namespace gridmerge::cli {

/// What was asked of a merge, as far as its summary tells of it. Not owned.
struct AskedMerge {
  const std::vector<std::string>& names;  ///< of the maps
  const SearchOptions& search;
  const LoadOptions& load;                                   ///< by which the maps were read
  const std::vector<std::optional<KnownPose>>& known_poses;  ///< of the maps
  MapTransform transform = MapTransform::rigid;
  double max_false_joins = MergeOptions{}.max_false_joins;
  bool is_resolution_asked = false;  ///< that of the merged maps
};

/// The options by which `what` would be believed, which has this probability; "" if neither stands in its
/// way.
std::string what_asks_for_less(const AskedMerge& asked, double probability, const char* what);

/// What became of each comparison, one line each.
std::string describe_joins(const AskedMerge& asked, const MergeResult& result);

/// The merged maps and their members, what was left out and why, and what else a person should know.
/// `unused_poses` tells of known poses that played no part; "" if there are none.
std::string describe_merge(const AskedMerge& asked, const std::vector<OccupancyGrid>& maps,
                           const MergeResult& result, const std::string& unused_poses);

/// How many walls lie double, and what may help: where it is asked for, or there are many. O(cells).
std::string describe_doubled(const AskedMerge& asked, const std::vector<OccupancyGrid>& maps,
                             const MergeResult& result, bool is_asked_for);

}  // namespace gridmerge::cli
