// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// A merge as outputs show it: with its maps, and what they are called. Not owned: all three outlive it. What
/// takes one throws std::out_of_range when there are fewer names than maps.
struct NamedMerge {
  const std::vector<std::string>& names;   ///< `names[i]` is what to call map i
  const std::vector<OccupancyGrid>& maps;  ///< as given to merge()
  const MergeResult& result;               ///< as merge() returned it
};

}  // namespace gridmerge
