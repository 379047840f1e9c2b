// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/json.hpp"

#include <utility>

#include "json_values.hpp"

namespace gridmerge {

namespace {

Json member_json(const std::string& name, const Member& member) {
  return {{"source", name},
          {"transform", transform_json(member.T_component_map)},
          {"probability", probability_json(member.probability)},
          {"sd", deviation_json(member.sd)}};
}

Json join_json(const std::string& fixed, const std::string& moving, const Join& join) {
  return {{"fixed", fixed},
          {"moving", moving},
          {"transform", transform_json(join.T_fixed_moving)},
          {"verdict", join.used() ? "accepted" : "refused"},
          {"probability", number_json(join.probability)},
          {"outcome", name_of(join.outcome)},
          {"reason", reason_json(join.match)},
          {"acceptance_index", number_json(join.match.acceptance_index)},
          {"agreement", join.match.agreement},
          {"disagreement", join.match.disagreement},
          {"overlap", number_json(join.match.overlap)},
          {"hypotheses", hypotheses_json(join.match.hypotheses)}};
}

}  // namespace

std::string match_json(const std::string& fixed, const std::string& moving, const MatchResult& result) {
  const Json json{{"fixed", fixed},
                  {"moving", moving},
                  {"verdict", name_of(result.verdict)},
                  {"reason", reason_json(result)},
                  {"transform", transform_json(result.T_fixed_moving)},
                  {"probability", number_json(result.probability)},
                  {"acceptance_index", number_json(result.acceptance_index)},
                  {"agreement", result.agreement},
                  {"disagreement", result.disagreement},
                  {"overlap", number_json(result.overlap)},
                  {"seconds", number_json(result.seconds)},
                  {"hypotheses", hypotheses_json(result.hypotheses)}};
  return text_of(json, -1) + "\n";
}

std::string transforms_json(const std::vector<std::string>& names, const MergeResult& result) {
  Json maps = Json::array();
  for (const std::string& name : names) maps.push_back(name);
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
  for (const Join& join : result.joins)
    joins.push_back(join_json(names.at(join.fixed), names.at(join.moving), join));
  Json left_out = Json::array();
  for (const std::size_t map : result.left_out) left_out.push_back(names.at(map));
  Json reasons = Json::array();
  for (const Reason reason : result.left_out_reasons) reasons.push_back(name_of(reason));
  const Json json{{"maps", std::move(maps)},
                  {"components", std::move(components)},
                  {"joins", std::move(joins)},
                  {"left_out", std::move(left_out)},
                  {"left_out_reasons", std::move(reasons)},
                  {"expected_false_joins", probability_json(result.expected_false_joins)}};
  return text_of(json, 2) + "\n";
}

std::string component_file(std::size_t component) {
  return component == 0 ? "merged.yaml" : "merged_" + std::to_string(component + 1) + ".yaml";
}

}  // namespace gridmerge
