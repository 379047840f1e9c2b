// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "gridmerge/report/merge_record.hpp"
#include "report/deformation_json.hpp"
#include "report/escaped_bytes.hpp"
#include "report/json_values.hpp"
#include "report/plan_json.hpp"
#include "report/told_joins.hpp"

namespace gridmerge {

using namespace internal;

namespace {

Json member_json(const std::string& name, const Member& member) {
  Json json{{"source", name},
            {"transform", transform_json(member.T_component_map)},
            {"probability", probability_json(member.probability)},
            {"sd", deviation_json(member.sd)}};
  if (!member.deformation.is_identity()) json["deformation"] = deformation_json(member.deformation);
  return json;
}

Json join_json(const std::string& fixed, const std::string& moving, const Join& join, bool in_full) {
  Json json{{"fixed", fixed},
            {"moving", moving},
            {"transform", transform_json(join.T_fixed_moving)},
            {"verdict", name_of(join.verdict())},
            {"probability", number_json(join.probability)},
            {"outcome", name_of(join.outcome)},
            {"reason", reason_json(join.reason())},
            {"by_themselves", own_verdict_json(join.match)}};
  json.update(common_json(join));
  const std::optional<double> sd = deviation_of(join);
  if (join.used() && sd) json["sd"] = number_json(*sd);
  json["hypotheses"] = hypotheses_json(told_hypotheses(join, in_full));
  return json;
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

/// "[" and "]" about a line for each of what follows.
std::string lines_text(const std::vector<std::string>& lines, std::size_t spaces) {
  if (lines.empty()) return "[]";
  std::string text = "[";
  for (const std::string& line : lines) {
    if (text.size() > 1) text += ',';
    text.append("\n").append(spaces + 2, ' ').append(line);
  }
  return text.append("\n").append(spaces, ' ').append("]");
}

/// The joins that are told as objects. Over many lines if they are few, but for refused ones.
std::string joins_text(const std::vector<std::string>& names, const MergeResult& result,
                       const ToldJoins& told) {
  std::vector<std::string> lines;
  for (const std::size_t i : told.objects) {
    const Join& join = result.joins[i];
    const bool in_a_line = join.outcome == JoinOutcome::refused || !told.in_full;
    const Json json = join_json(names.at(join.fixed), names.at(join.moving), join, told.in_full);
    lines.push_back(indented(text_of(json, in_a_line ? -1 : 2), 4));
  }
  return lines_text(lines, 2);
}

/// The refused joins of many maps: how many there are, and the likely ones in rows of a table.
std::string refused_text(const MergeResult& result, const ToldJoins& told) {
  std::size_t count = 0;
  Json reasons = Json::object();
  for (const RefusedCount& refused : told.counts) {
    count += refused.count;
    reasons[name_of(refused.reason)] = refused.count;
  }
  const Json columns{"fixed", "moving", "reason", "probability", "x", "y", "theta"};
  std::vector<std::string> lines;
  for (const std::size_t i : told.rows) {
    const Join& join = result.joins[i];
    const SE2& T = join.T_fixed_moving;
    lines.push_back(
        text_of(Json{join.fixed, join.moving, reason_json(join.reason()), number_json(join.probability),
                     number_json(T.x), number_json(T.y), number_json(T.theta)},
                -1));
  }
  return "{\n    \"count\": " + std::to_string(count) + ",\n    \"reasons\": " + text_of(reasons, -1) +
         ",\n    \"columns\": " + text_of(columns, -1) + ",\n    \"rows\": " + lines_text(lines, 4) + "\n  }";
}

}  // namespace

std::string transforms_json(const std::vector<std::string>& map_names, const MergeResult& result) {
  for (const std::string& name : map_names) {
    if (name.empty() || name.find('\0') != std::string::npos)  // parse_transforms() would refuse it
      throw std::invalid_argument("the name of a map must not be empty, nor hold a null character");
  }
  const bool has_escapes = !std::all_of(map_names.begin(), map_names.end(), is_utf8) ||
                           (result.plan && !is_utf8(result.plan->name));
  const auto written = [&](const std::string& name) { return has_escapes ? escape_bytes(name) : name; };
  std::vector<std::string> names;
  for (const std::string& name : map_names) names.push_back(written(name));
  Json maps = Json::array();
  for (const std::string& name : names) maps.push_back(name);
  Json components = Json::array();
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    Json members = Json::array();
    for (const Member& member : result.components[i].members) {
      members.push_back(member_json(names.at(member.map), member));
    }
    const Component& component = result.components[i];
    const std::optional<std::size_t> frame = frame_of(component);
    const std::optional<EqualCells>& omega = component.fused.omega;
    components.push_back({{"map", component_file(i)},
                          {"frame", frame ? Json(names.at(*frame)) : Json()},
                          {"members", std::move(members)},
                          {"omega", omega ? Json(omega->equal) : Json()},
                          {"cells", omega ? Json(omega->cells) : Json()},
                          {"omega_share", omega ? number_json(omega->share()) : Json()}});
  }
  Json left_out = Json::array(), left_out_maps = Json::array();
  for (const LeftOut& one : result.left_out) {
    const std::string& name = names.at(one.map);
    left_out.push_back(name);
    left_out_maps.push_back({{"source", name}, {"reason", name_of(one.reason)}});
  }
  std::string text;
  const auto add = [&](const char* key, const std::string& value) {
    text += (text.empty() ? "{\n  \"" : ",\n  \"") + std::string(key) + "\": " + value;
  };
  const auto add_json = [&](const char* key, const Json& value) { add(key, indented(text_of(value, 2), 2)); };
  if (has_escapes) add_json("names", "escaped");
  add_json("maps", maps);
  add_json("components", components);
  const ToldJoins told = tell_joins(result);
  add("joins", joins_text(names, result, told));
  if (!told.counts.empty()) add("refused", refused_text(result, told));
  add_json("left_out", left_out);
  add_json("left_out_maps", left_out_maps);
  Json open_ways = Json::array();
  for (const OpenWay& way : result.open_ways)
    open_ways.push_back({{"fixed", names.at(way.fixed)},
                         {"moving", names.at(way.moving)},
                         {"transform", transform_json(way.T_fixed_moving)},
                         {"probability", number_json(way.probability)}});
  add_json("open_ways", open_ways);
  add_json("expected_false_joins", probability_json(result.expected_false_joins));
  if (result.not_compared)
    add_json("not_compared", {{"pairs", result.not_compared->pairs},
                              {"expected_joins", number_json(result.not_compared->expected_joins)}});
  if (result.plan) {
    Json plan = plan_json(names, *result.plan, component_on_plan(result));
    plan["source"] = written(result.plan->name);
    add_json("plan", plan);
  }
  return text + "\n}\n";
}

std::string component_file(std::size_t component) {
  return component == 0 ? "merged.yaml" : "merged_" + std::to_string(component + 1) + ".yaml";
}

}  // namespace gridmerge
