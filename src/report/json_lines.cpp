// SPDX-License-Identifier: Apache-2.0
#include "report/json_lines.hpp"

#include <utility>

#include "report/json_values.hpp"

namespace gridmerge::internal {

namespace {

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

std::string match_json(const std::string& fixed, const std::string& moving, const MatchResult& result,
                       bool with_scale) {
  Json json{{"fixed", fixed},
            {"moving", moving},
            {"verdict", name_of(result.verdict)},
            {"reason", reason_json(own_reason(result))},
            {"transform", transform_json(result.T_fixed_moving)}};
  if (with_scale) json["scale"] = number_json(result.scale);
  json["probability"] = number_json(result.probability);
  json.update(common_json(result));
  json["seconds"] = number_json(result.seconds);
  json["hypotheses"] = hypotheses_json(result.hypotheses);
  for (std::size_t i = 0; with_scale && i < result.hypotheses.size(); ++i)
    json["hypotheses"][i]["scale"] = number_json(result.hypotheses[i].scale);
  return text_of(json, -1) + "\n";
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

}  // namespace gridmerge::internal
