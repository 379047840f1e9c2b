// SPDX-License-Identifier: Apache-2.0
#include "report/plan_layer.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>

#include "match/drawing.hpp"
#include "report/shown_map.hpp"

namespace gridmerge::internal {

namespace {

/// What the page takes for a plan: scanned ones have far more pixels than lines need.
constexpr std::size_t kMostCells = std::size_t{1} << 22;
constexpr std::size_t kMostBytes = 500'000;

ShownMap show_plan(const OccupancyGrid& plan) {
  const OccupancyGrid walls = walls_of_plan(plan);
  std::size_t most_cells = kMostCells;
  while (true) {
    ShownMap shown = show_map(walls, most_cells);
    const std::size_t cells = static_cast<std::size_t>(shown.width) * static_cast<std::size_t>(shown.height);
    if (shown.cells.size() <= kMostBytes || cells <= 1) return shown;
    most_cells = cells / 2;
  }
}

struct Placed {
  std::optional<std::size_t> component;
  SE2 T_scene_first;
};

/// Where the first map of a part is drawn.
Placed placed(const MergeResult& result, std::size_t first) {
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    for (const Member& member : result.components[i].members) {
      if (member.map == first) return {i, member.T_component_map};
    }
  }
  return {};
}

Json places_json(const std::vector<PlanPlace>& places) {
  Json json = Json::array();
  for (const PlanPlace& place : places) {
    json.push_back({{"component", place.component ? Json(*place.component) : Json()},
                    {"map", place.component ? Json() : Json(place.map)},
                    {"transform", transform_json(place.T_scene_plan)},
                    {"scale", number_json(place.scale)},
                    {"probability", number_json(place.probability)},
                    {"on_plan", place.on_plan}});
  }
  return json;
}

}  // namespace

std::vector<PlanPlace> plan_places(const MergeResult& result) {
  std::vector<PlanPlace> places;
  std::set<std::size_t> told;  // components
  for (const PlanPart& part : result.plan->parts) {
    if (part.probability <= 0.0) continue;
    const auto [component, T_scene_first] = placed(result, part.maps.front());
    if (component && !told.insert(*component).second) continue;
    const bool is_frame = component && part.on_plan();
    const SE2 T_scene_plan = is_frame ? SE2{} : T_scene_first * inverse(part.T_plan_first);
    places.push_back({component, part.maps.front(), T_scene_plan,
                      part.on_plan() ? result.plan->scale : part.scale, part.probability, part.on_plan()});
  }
  return places;
}

OccupancyGrid walls_of_plan(const OccupancyGrid& plan) {
  OccupancyGrid walls = with_enclosed_free(plan);
  walls.probability.clear();
  std::replace(walls.cells.begin(), walls.cells.end(), Cell::free, Cell::unknown);
  return walls;
}

Json plan_page_json(const NamedMerge& merge) {
  const PlanPlacement& plan = *merge.result.plan;
  Json places = places_json(plan_places(merge.result));
  const bool is_drawn = merge.plan != nullptr && !places.empty();
  return {{"name", plan.name},
          {"scale", number_json(plan.scale)},
          {"probability", number_json(plan.probability())},
          {"maps", plan.maps_on_plan()},
          {"places", std::move(places)},
          {"grid", is_drawn ? grid_json(show_plan(*merge.plan)) : Json()}};
}

}  // namespace gridmerge::internal
