// SPDX-License-Identifier: Apache-2.0
// The parts of a merge, and what each of their maps says of a plan.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/map_store.hpp"

namespace gridmerge::internal {

/// All maps of a merge, by their index.
using PlanInputs = std::vector<std::shared_ptr<const MapStore::Input>>;

/// What is matched with the plan: a map, or all maps of a part as one.
struct PlanVoice {
  std::optional<std::size_t> map;  ///< index of the input map; none of all maps as one
  SE2 T_part_voice;
  std::shared_ptr<const MapStore::Input> input;  ///< bent, where the member is
  MatchResult match;                             ///< of this one, fixed, and the plan
};

/// A component of a merge, or a map that was left out.
struct MergePart {
  std::optional<std::size_t> component;  ///< its index; none of a map that was left out
  std::vector<Member> members;           ///< ascending; of a map that was left out, itself
  /// All maps as one first, if they are several, and then the members that know most; no copies, and none
  /// without walls.
  std::vector<PlanVoice> voices;
};

/// In the order of their first maps.
std::vector<MergePart> parts_of(const MergeResult& merged, const PlanInputs& inputs);

/// Matches the voices of these parts with the plan. Runs in the calling TBB arena.
void hear(std::vector<MergePart>& parts, const PreparedMap& plan, const MatchOptions& options,
          const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace gridmerge::internal
