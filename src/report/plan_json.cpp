// SPDX-License-Identifier: Apache-2.0
#include "report/plan_json.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "gridmerge/match/match.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "report/record_values.hpp"

namespace gridmerge::internal {

namespace {

/// The first map of that name that is not taken yet, which takes it.
std::size_t take(const JsonReader& json, const std::vector<std::string>& names, std::vector<bool>& is_taken) {
  const std::string name = json.text();
  bool is_known = false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] != name) continue;
    is_known = true;
    if (is_taken[i]) continue;
    is_taken[i] = true;
    return i;
  }
  json.fail((is_known ? "is in two parts: '" : "is none of the maps: '") + name + "'");
}

PlanPart read_part(const JsonReader& json, const std::vector<std::string>& names,
                   std::vector<bool>& is_taken) {
  PlanPart part;
  const JsonReader maps = json.at("maps");
  for (std::size_t i = 0; i < maps.size(); ++i) part.maps.push_back(take(maps.at(i), names, is_taken));
  if (part.maps.empty()) maps.fail("is empty");
  std::sort(part.maps.begin(), part.maps.end());
  part.T_plan_first = json.at("transform").transform(kFarthest);
  part.scale = json.at("scale").number_in(kMinScale, kMaxScale);
  part.probability = read_share(json.at("probability"));
  const JsonReader reason = json.at("reason");
  part.reason = reason.is_null() ? Reason::none : read_reason(reason);
  return part;
}

}  // namespace

std::string component_on_plan(const MergeResult& result) {
  if (!result.plan) return {};
  for (const PlanPart& part : result.plan->parts) {
    if (!part.on_plan()) continue;
    for (std::size_t i = 0; i < result.components.size(); ++i) {
      const std::vector<Member>& members = result.components[i].members;
      if (std::any_of(members.begin(), members.end(),
                      [&](const Member& member) { return member.map == part.maps.front(); }))
        return component_file(i);
    }
  }
  return {};
}

Json plan_json(const std::vector<std::string>& names, const PlanPlacement& plan,
               const std::string& component) {
  const auto named = [&](const std::vector<std::size_t>& maps) {
    Json json = Json::array();
    for (const std::size_t map : maps) json.push_back(names.at(map));
    return json;
  };
  Json maps = named(plan.maps_on_plan()), parts = Json::array();
  for (const PlanPart& part : plan.parts) {
    parts.push_back({{"maps", named(part.maps)},
                     {"transform", transform_json(part.T_plan_first)},
                     {"scale", number_json(part.scale)},
                     {"probability", number_json(part.probability)},
                     {"reason", reason_json(part.reason)}});
  }
  const bool any = !maps.empty();
  return {{"source", plan.name},
          {"resolution", number_json(plan.resolution)},
          {"scale", any ? number_json(plan.scale) : Json()},
          {"probability", any ? number_json(plan.probability()) : Json()},
          {"component", component.empty() ? Json() : Json(component)},
          {"maps", std::move(maps)},
          {"parts", std::move(parts)}};
}

namespace {

/// What is told twice has to be the same.
void check_plan(const JsonReader& json, const std::vector<std::string>& names, const MergeResult& result) {
  const PlanPlacement& plan = *result.plan;
  const std::vector<std::size_t> on_plan = plan.maps_on_plan();
  const JsonReader maps = json.at("maps");
  bool is_same = maps.size() == on_plan.size();
  for (std::size_t i = 0; is_same && i < on_plan.size(); ++i)
    is_same = maps.at(i).text() == names[on_plan[i]];
  if (!is_same) maps.fail("does not go with the parts");
  for (const char* key : {"scale", "probability"}) {
    if (json.at(key).is_null() != on_plan.empty()) json.at(key).fail("does not go with the parts");
  }
  if (!on_plan.empty() && std::abs(read_share(json.at("probability")) - plan.probability()) > 1e-9)
    json.at("probability").fail("is not that of the surest part");
  const JsonReader component = json.at("component");
  if ((component.is_null() ? std::string() : component.text()) != component_on_plan(result))
    component.fail("does not hold the maps on the plan");
}

}  // namespace

void read_plan(const JsonReader& json, const std::vector<std::string>& names, MergeResult& result) {
  PlanPlacement plan;
  plan.name = json.at("source").text();
  // Not in what earlier versions wrote.
  if (json.has("resolution")) plan.resolution = json.at("resolution").number_in(0.0, kFarthest);
  if (!json.at("scale").is_null()) plan.scale = json.at("scale").number_in(kMinScale, kMaxScale);
  std::vector<bool> is_taken(names.size(), false);
  const JsonReader parts = json.at("parts");
  for (std::size_t i = 0; i < parts.size(); ++i)
    plan.parts.push_back(read_part(parts.at(i), names, is_taken));
  result.plan = std::move(plan);
  check_plan(json, names, result);
}

}  // namespace gridmerge::internal
