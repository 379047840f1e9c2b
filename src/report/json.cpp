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

Json distance_json(const DirectedDistance& distance) {
  return distance.defined() ? number_json(distance.mean()) : Json();
}

Json engine_json(const Hypothesis& engine) {
  Json figures;
  for (const PoseFigure& figure : pose_figures())
    figures[figure.name] = number_json(engine.figures.*figure.value);
  return {{"probability", number_json(engine.probability)}, {"figures", std::move(figures)}};
}

Json pair_measure_json(const std::string& fixed, const std::string& moving, const PoseMeasure& measure,
                       double c_lock) {
  const ImageSimilarity& similarity = measure.similarity;
  return {{"fixed", fixed},
          {"moving", moving},
          {"transform", transform_json(measure.T_fixed_moving)},
          {"omega", similarity.omega},
          {"cells", measure.cells},
          {"psi", number_json(similarity.psi())},
          {"psi_terms",
           {{"fixed_moving_occupied", distance_json(similarity.fixed_to_moving_occupied)},
            {"fixed_moving_free", distance_json(similarity.fixed_to_moving_free)},
            {"moving_fixed_occupied", distance_json(similarity.moving_to_fixed_occupied)},
            {"moving_fixed_free", distance_json(similarity.moving_to_fixed_free)}}},
          {"agreement", similarity.agreement},
          {"disagreement", similarity.disagreement},
          {"delta", number_json(similarity.delta(c_lock))},
          {"c_lock", number_json(c_lock)},
          {"acceptance_index", number_json(similarity.acceptance_index())},
          {"common",
           {{"occupied_occupied", measure.common.occupied_occupied},
            {"free_free", measure.common.free_free},
            {"contradicting", measure.common.contradicting}}},
          {"engine", engine_json(measure.engine)}};
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
    const std::optional<EqualCells>& omega = component.fused.omega;
    components.push_back(
        {{"map", component_file(i)},
         {"frame", component.in_world_frame ? Json() : Json(names.at(component.members.front().map))},
         {"members", std::move(members)},
         {"omega", omega ? Json(omega->equal) : Json()},
         {"cells", omega ? Json(omega->cells) : Json()},
         {"omega_share", omega ? number_json(omega->share()) : Json()}});
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

std::string measure_json(const std::string& fixed, const std::vector<std::string>& moving,
                         const JointMeasure& measure, double c_lock) {
  if (measure.pairs.size() == 1)
    return text_of(pair_measure_json(fixed, moving.at(0), measure.pairs.front(), c_lock), -1) + "\n";
  Json pairs = Json::array();
  for (std::size_t i = 0; i < measure.pairs.size(); ++i)
    pairs.push_back(pair_measure_json(fixed, moving.at(i), measure.pairs[i], c_lock));
  const Json json{
      {"fixed", fixed}, {"omega", measure.omega}, {"cells", measure.cells}, {"pairs", std::move(pairs)}};
  return text_of(json, -1) + "\n";
}

std::string component_file(std::size_t component) {
  return component == 0 ? "merged.yaml" : "merged_" + std::to_string(component + 1) + ".yaml";
}

}  // namespace gridmerge
