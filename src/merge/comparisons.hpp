// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gridmerge/merge/merger.hpp"
#include "preselect/signature.hpp"

namespace gridmerge::internal {

/// Log-odds that the maps of two signatures join (log_odds_of_joining()), of each pair a < b in the order
/// (0, 1), (0, 2), ... The first map of a pair moves. Parts that the store has are not made, and those that
/// are made are kept there; `contents` gives content_id() of the maps, and is not called without a store.
/// Runs in the calling TBB arena.
std::vector<float> compare_all(const std::vector<const Signature*>& signatures, const ComparisonStore& store,
                               const std::function<std::vector<std::string>()>& contents);

}  // namespace gridmerge::internal
