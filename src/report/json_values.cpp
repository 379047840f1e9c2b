// SPDX-License-Identifier: Apache-2.0
#include "json_values.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace gridmerge {

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

Json reason_json(const MatchResult& match) {
  return match.verdict == Verdict::accepted ? Json() : Json(name_of(match.reason));
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

}  // namespace gridmerge
