// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::internal {

// What all JSON outputs write in the same way. Numbers that are not finite throw std::invalid_argument.

using Json = nlohmann::ordered_json;

Json number_json(double value);
Json transform_json(const SE2& T);
Json hypotheses_json(const std::vector<Hypothesis>& hypotheses);

/// What two maps have in common at a pose: four keys, from "acceptance_index" to "overlap".
Json common_json(const PairPose& pose);

/// null of none.
Json reason_json(Reason reason);

/// Why two maps are refused by themselves; none of accepted ones.
Reason own_reason(const MatchResult& match);

/// What two maps say by themselves, whatever a merge makes of it.
Json own_verdict_json(const MatchResult& match);

/// The map whose frame the component's is, null if none's is: the world's.
std::optional<std::size_t> frame_of(const Component& component);

/// null where nothing is known.
Json probability_json(const std::optional<double>& probability);
Json deviation_json(const std::optional<PoseDeviation>& sd);

/// As text; `indent` below 0 is one line. What is not UTF-8 becomes U+FFFD.
std::string text_of(const Json& json, int indent);

}  // namespace gridmerge::internal
