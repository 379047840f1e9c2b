// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace gridmerge {

namespace {

using Json = nlohmann::ordered_json;

double number(double value) {
  if (!std::isfinite(value))
    throw std::invalid_argument("a result that is not finite cannot be written as JSON");
  return value + 0.0;  // no -0.0: it reads as a direction that is not there
}

Json transform_of(const SE2& T) {
  return {{"x", number(T.x)}, {"y", number(T.y)}, {"theta", number(T.theta)}};
}

Json deviation_of(const std::optional<PoseDeviation>& sd) {
  if (!sd) return nullptr;
  return {{"position", number(sd->position)}, {"theta", number(sd->theta)}};
}

Json member_json(const std::string& name, const Member& member) {
  return {{"source", name},
          {"transform", transform_of(member.T_component_map)},
          {"probability", member.probability ? Json(number(*member.probability)) : Json()},
          {"sd", deviation_of(member.sd)}};
}

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string match_json(const std::string& fixed, const std::string& moving, const MatchResult& result) {
  Json hypotheses = Json::array();
  for (const Hypothesis& hypothesis : result.hypotheses) {
    hypotheses.push_back({{"transform", transform_of(hypothesis.T_fixed_moving)},
                          {"score", number(hypothesis.score)},
                          {"probability", number(hypothesis.probability)}});
  }
  const Json json{{"fixed", fixed},
                  {"moving", moving},
                  {"verdict", name_of(result.verdict)},
                  {"reason", result.verdict == Verdict::accepted ? Json() : Json(name_of(result.reason))},
                  {"transform", transform_of(result.T_fixed_moving)},
                  {"probability", number(result.probability)},
                  {"acceptance_index", number(result.acceptance_index)},
                  {"agreement", result.agreement},
                  {"disagreement", result.disagreement},
                  {"overlap", number(result.overlap)},
                  {"seconds", number(result.seconds)},
                  {"hypotheses", std::move(hypotheses)}};
  return text_of(json, -1);
}

std::string transforms_json(const std::vector<std::string>& names, const MergeResult& result) {
  Json components = Json::array();
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    Json members = Json::array();
    for (const Member& member : result.components[i].members) {
      members.push_back(member_json(names.at(member.map), member));
    }
    const Component& component = result.components[i];
    components.push_back(
        {{"map", component_file(i)},
         {"frame", component.in_world_frame ? Json() : Json(names.at(component.members.front().map))},
         {"members", std::move(members)}});
  }
  Json joins = Json::array();
  for (const Join& join : result.joins) {
    joins.push_back({{"fixed", names.at(join.fixed)},
                     {"moving", names.at(join.moving)},
                     {"transform", transform_of(join.T_fixed_moving)},
                     {"verdict", join.used() ? "accepted" : "refused"},
                     {"probability", number(join.probability)},
                     {"outcome", name_of(join.outcome)}});
  }
  Json left_out = Json::array();
  for (const std::size_t map : result.left_out) left_out.push_back(names.at(map));
  Json reasons = Json::array();
  for (const Reason reason : result.left_out_reasons) reasons.push_back(name_of(reason));
  const Json json{{"components", std::move(components)},
                  {"joins", std::move(joins)},
                  {"left_out", std::move(left_out)},
                  {"left_out_reasons", std::move(reasons)}};
  return text_of(json, 2);
}

std::string component_file(std::size_t component) {
  return component == 0 ? "merged.yaml" : "merged_" + std::to_string(component + 1) + ".yaml";
}

}  // namespace gridmerge
