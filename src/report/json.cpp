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

Reason own_reason(const MatchResult& match) {
  return match.verdict == Verdict::accepted ? Reason::none : match.reason;
}

Json join_json(const std::string& fixed, const std::string& moving, const Join& join) {
  return {{"fixed", fixed},
          {"moving", moving},
          {"transform", transform_json(join.T_fixed_moving)},
          {"verdict", name_of(join.verdict())},
          {"probability", number_json(join.probability)},
          {"outcome", name_of(join.outcome)},
          {"reason", reason_json(join.reason())},
          {"by_themselves",
           {{"verdict", name_of(join.match.verdict)}, {"reason", reason_json(own_reason(join.match))}}},
          {"acceptance_index", number_json(join.acceptance_index)},
          {"agreement", join.agreement},
          {"disagreement", join.disagreement},
          {"overlap", number_json(join.overlap)},
          {"hypotheses", hypotheses_json(join)}};
}

/// Every line but the first further in.
std::string indented(const std::string& text, std::size_t spaces) {
  std::string result;
  for (const char c : text) {
    result += c;  // within JSON's strings line breaks are escaped
    if (c == '\n') result.append(spaces, ' ');
  }
  return result;
}

/// The joins, each over many lines but for refused ones, of which large teams have thousands.
std::string joins_text(const std::vector<std::string>& names, const MergeResult& result) {
  if (result.joins.empty()) return "[]";
  std::string text = "[";
  for (const Join& join : result.joins) {
    const bool in_a_line = join.outcome == JoinOutcome::refused;
    const Json json = join_json(names.at(join.fixed), names.at(join.moving), join);
    text += (text.size() > 1 ? ",\n    " : "\n    ") + indented(text_of(json, in_a_line ? -1 : 2), 4);
  }
  return text + "\n  ]";
}

}  // namespace

std::string match_json(const std::string& fixed, const std::string& moving, const MatchResult& result) {
  const Json json{{"fixed", fixed},
                  {"moving", moving},
                  {"verdict", name_of(result.verdict)},
                  {"reason", reason_json(own_reason(result))},
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
    const std::optional<std::size_t> frame = frame_of(result.components[i]);
    components.push_back({{"map", component_file(i)},
                          {"frame", frame ? Json(names.at(*frame)) : Json()},
                          {"members", std::move(members)}});
  }
  Json left_out = Json::array(), left_out_maps = Json::array();
  for (std::size_t i = 0; i < result.left_out.size(); ++i) {
    const std::string& name = names.at(result.left_out[i]);
    left_out.push_back(name);
    left_out_maps.push_back({{"source", name}, {"reason", name_of(result.left_out_reasons.at(i))}});
  }
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    text += (text.empty() ? "{\n  \"" : ",\n  \"") + std::string(key) + "\": " + value;
  };
  const auto add_json = [&](const char* key, const Json& value) { add(key, indented(text_of(value, 2), 2)); };
  add_json("maps", maps);
  add_json("components", components);
  add("joins", joins_text(names, result));
  add_json("left_out", left_out);
  add_json("left_out_maps", left_out_maps);
  add_json("expected_false_joins", probability_json(result.expected_false_joins));
  return text + "\n}\n";
}

std::string component_file(std::size_t component) {
  return component == 0 ? "merged.yaml" : "merged_" + std::to_string(component + 1) + ".yaml";
}

}  // namespace gridmerge
