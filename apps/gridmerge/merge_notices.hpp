// SPDX-License-Identifier: Apache-2.0
// What the user should know before maps are merged.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/merge/merge.hpp"
#include "search_options.hpp"

namespace gridmerge::cli {

/// Maps as the command line names them, and what is known of their poses. Not owned.
struct GivenMaps {
  const std::vector<std::string>& names;
  const std::vector<OccupancyGrid>& grids;
  const std::vector<std::optional<KnownPose>>& known_poses;
};

/// A map that is given twice is no second opinion, except up a tree of merges, which takes every one. Says so
/// once for names and once for copies. Maps of which both have known poses count each, equal or not.
void tell_of_copies(const GivenMaps& maps, const SearchOptions& search, bool is_any_fixed, Console& console);

/// How many pairs are matched and how long that takes, if that is all pairs of many maps, and what the user
/// may do about it; "" otherwise. `shards` share the matches.
std::string describe_all_pairs(std::size_t maps, const MergeOptions& options, std::size_t shards,
                               const std::string& what_helps);

}  // namespace gridmerge::cli
