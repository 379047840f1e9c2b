// SPDX-License-Identifier: Apache-2.0
#include "report/page_data.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/report/json.hpp"
#include "gridmerge/report/preview.hpp"
#include "gridmerge/version.hpp"
#include "report/shown_map.hpp"
#include "report/wording.hpp"

namespace gridmerge::internal {

namespace {

Json grid_json(const ShownMap& map) {
  return {{"width", map.width},
          {"height", map.height},
          {"resolution", number_json(map.resolution)},
          {"origin", transform_json(map.origin)},
          {"cells", map.cells}};
}

std::string colour_text(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

Json map_json(const std::string& name, std::size_t index, const ShownMap& shown) {
  Json json{{"name", name}, {"color", colour_text(map_colour(index))}};
  json.update(grid_json(shown));
  return json;
}

Json component_json(std::size_t index, const Component& component, const ShownMap& shown) {
  Json members = Json::array();
  for (const Member& member : component.members) {
    members.push_back({{"map", member.map},
                       {"transform", transform_json(member.T_component_map)},
                       {"probability", probability_json(member.probability)},
                       {"sd", deviation_json(member.sd)}});
  }
  const std::optional<std::size_t> frame = frame_of(component);
  Json json{{"file", component_file(index)},
            {"frame", frame ? Json(*frame) : Json()},
            {"agreeing", component.fused.agreeing},
            {"conflicting", component.fused.conflicting},
            {"members", std::move(members)}};
  json.update(grid_json(shown));
  return json;
}

Json join_json(const Join& join) {
  return {{"fixed", join.fixed},
          {"moving", join.moving},
          {"outcome", name_of(join.outcome)},
          {"reason", reason_json(join.reason())},
          {"by_themselves", own_verdict_json(join.match)},
          {"transform", transform_json(join.T_fixed_moving)},
          {"probability", number_json(join.probability)},
          {"acceptance_index", number_json(join.acceptance_index)},
          {"agreement", join.agreement},
          {"disagreement", join.disagreement},
          {"overlap", number_json(join.overlap)},
          {"hypotheses", hypotheses_json(join)}};
}

/// All maps, bent as they lie, then all fused ones: what takes time is done for several at once.
std::vector<ShownMap> show_all(const std::vector<OccupancyGrid>& maps, const MergeResult& result) {
  std::vector<const OccupancyGrid*> grids;
  grids.reserve(maps.size() + result.components.size());
  for (const OccupancyGrid& map : maps) grids.push_back(&map);
  std::vector<const Deformation*> deformations(maps.size(), nullptr);
  for (const Component& component : result.components) {
    grids.push_back(&component.fused.grid);
    for (const Member& member : component.members) {
      if (!member.deformation.is_identity()) deformations.at(member.map) = &member.deformation;
    }
  }
  std::vector<ShownMap> shown(grids.size());
  parallel_for(grids.size(), [&](std::size_t i) {
    const bool is_bent = i < maps.size() && deformations[i] != nullptr;
    shown[i] = is_bent ? show_map(bent_map(*grids[i], *deformations[i])) : show_map(*grids[i]);
  });
  return shown;
}

}  // namespace

Json page_data(const std::vector<std::string>& names, const std::vector<OccupancyGrid>& maps,
               const MergeResult& result) {
  const std::vector<ShownMap> shown = show_all(maps, result);
  Json shown_maps = Json::array();
  for (std::size_t i = 0; i < maps.size(); ++i) shown_maps.push_back(map_json(names.at(i), i, shown[i]));
  Json components = Json::array();
  for (std::size_t i = 0; i < result.components.size(); ++i)
    components.push_back(component_json(i, result.components[i], shown[maps.size() + i]));
  Json joins = Json::array();
  for (const Join& join : result.joins) joins.push_back(join_json(join));
  Json left_out = Json::array();
  for (std::size_t i = 0; i < result.left_out.size(); ++i) {
    const Reason reason = result.left_out_reasons.at(i);
    left_out.push_back({{"map", result.left_out[i]},
                        {"reason", name_of(reason)},
                        {"explanation", explain_left_out(result, i)}});
  }
  return {{"version", kVersion},           {"live", false},
          {"maps", std::move(shown_maps)}, {"components", std::move(components)},
          {"joins", std::move(joins)},     {"left_out", std::move(left_out)}};
}

}  // namespace gridmerge::internal
