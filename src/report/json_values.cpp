// SPDX-License-Identifier: Apache-2.0
#include "report/json_values.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace gridmerge::internal {

Json number_json(double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument("a result that is not finite cannot be written as JSON");
  return value + 0.0;  // no -0.0: it reads as a direction that is not there
}

Json transform_json(const SE2& T) {
  return {{"x", number_json(T.x)}, {"y", number_json(T.y)}, {"theta", number_json(T.theta)}};
}

Json hypotheses_json(const std::vector<Hypothesis>& hypotheses) {
  Json list = Json::array();
  for (const Hypothesis& hypothesis : hypotheses) {
    list.push_back({{"transform", transform_json(hypothesis.T_fixed_moving)},
                    {"score", number_json(hypothesis.score)},
                    {"probability", number_json(hypothesis.probability)}});
  }
  return list;
}

Json common_json(const PairPose& pose) {
  return {{"acceptance_index", number_json(pose.acceptance_index)},
          {"agreement", pose.agreement},
          {"disagreement", pose.disagreement},
          {"overlap", number_json(pose.overlap)}};
}

Json reason_json(Reason reason) {
  return reason == Reason::none ? Json() : Json(name_of(reason));
}

Reason own_reason(const MatchResult& match) {
  return match.verdict == Verdict::accepted ? Reason::none : match.reason;
}

Json own_verdict_json(const MatchResult& match) {
  return {{"verdict", name_of(match.verdict)}, {"reason", reason_json(own_reason(match))}};
}

std::optional<std::size_t> frame_of(const Component& component) {
  if (component.members.empty()) throw std::invalid_argument("a component must have members");
  if (!component.in_world_frame) return component.members.front().map;
  for (const Member& member : component.members) {
    if (member.T_component_map == SE2{}) return member.map;  // such as a fixed map of which no pose is known
  }
  return std::nullopt;
}

Json probability_json(const std::optional<double>& probability) {
  return probability ? number_json(*probability) : Json();
}

Json deviation_json(const std::optional<PoseDeviation>& sd) {
  if (!sd) return nullptr;
  return {{"position", number_json(sd->position)}, {"theta", number_json(sd->theta)}};
}

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gridmerge::internal
