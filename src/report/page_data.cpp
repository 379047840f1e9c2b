// SPDX-License-Identifier: Apache-2.0
#include "report/page_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "grid/parallel.hpp"
#include "grid/sha256.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "gridmerge/version.hpp"
#include "report/bent_maps.hpp"
#include "report/deformation_json.hpp"
#include "report/plan_layer.hpp"
#include "report/shown_map.hpp"
#include "report/told_joins.hpp"

namespace gridmerge::internal {

namespace {

/// Of more maps than this the page takes so many bytes at most for the maps, and so many for the merged ones.
constexpr std::size_t kMaxMapsInFull = 50;
constexpr std::size_t kMostBytesOfMaps = 10'000'000;
constexpr std::size_t kMostBytesOfMerged = 4'000'000;
constexpr std::size_t kAnyBytes = std::numeric_limits<std::size_t>::max();

std::string colour_text(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

Json map_json(const std::string& name, std::size_t index, const ShownMap& shown) {
  Json json{{"name", name}, {"color", colour_text(map_colour(index))}};
  json.update(grid_json(shown));
  return json;
}

/// With the lattices of bent maps, or with what these do to a map alone.
Json component_json(std::size_t index, const Component& component, const ShownMap& shown, bool in_full) {
  Json members = Json::array();
  for (const Member& member : component.members) {
    members.push_back({{"map", member.map},
                       {"transform", transform_json(member.T_component_map)},
                       {"probability", probability_json(member.probability)},
                       {"sd", deviation_json(member.sd)}});
    if (member.deformation.is_identity()) continue;
    if (in_full) {
      members.back()["deformation"] = deformation_json(member.deformation);
    } else {
      members.back()["shape"] = shape_json(member.deformation);
    }
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

Json join_json(const Join& join, bool in_full) {
  Json json{{"fixed", join.fixed},
            {"moving", join.moving},
            {"outcome", name_of(join.outcome)},
            {"reason", reason_json(join.reason())},
            {"by_themselves", own_verdict_json(join.match)},
            {"transform", transform_json(join.T_fixed_moving)},
            {"probability", number_json(join.probability)}};
  json.update(common_json(join));
  json["hypotheses"] = hypotheses_json(told_hypotheses(join, in_full));
  return json;
}

/// The refused joins of many maps, as transforms.json has them.
Json refused_json(const MergeResult& result, const ToldJoins& told) {
  std::size_t count = 0;
  for (const RefusedCount& refused : told.counts) count += refused.count;
  Json rows = Json::array();
  for (const std::size_t i : told.rows) {
    const Join& join = result.joins[i];
    const SE2& T = join.T_fixed_moving;
    rows.push_back(
        Json::array({join.fixed, join.moving, name_of(join.reason()), number_json(join.probability),
                     number_json(T.x), number_json(T.y), number_json(T.theta)}));
  }
  return {{"count", count}, {"rows", std::move(rows)}};
}

/// 64 bits: enough to tell the merges apart that come under one address.
std::string name_of_content(const Json& content) {
  constexpr std::size_t kDigits = 16;
  return to_hex(Sha256().add(text_of(content, -1)).digest()).substr(0, kDigits);
}

/// What takes time is done for several at once. If they take more than `bytes`, the largest are shown
/// coarser.
std::vector<ShownMap> show_all(const std::vector<const OccupancyGrid*>& grids, std::size_t bytes) {
  std::vector<ShownMap> shown(grids.size());
  std::vector<std::size_t> made_with(grids.size(), 0);
  std::size_t max_cells = kMaxShownCells;
  while (true) {
    parallel_for(grids.size(), [&](std::size_t i) {
      const bool is_as_before = made_with[i] != 0 && grids[i]->cells.size() <= max_cells;
      if (!is_as_before) shown[i] = show_map(*grids[i], max_cells);
      made_with[i] = max_cells;
    });
    std::size_t sum = 0, most = 0;
    for (const ShownMap& map : shown) {
      sum += map.cells.size();
      most = std::max(most, static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
    }
    if (sum <= bytes || most <= 1) return shown;
    max_cells = most / 2;
  }
}

}  // namespace

Json page_data(const NamedMerge& merge) {
  const auto& [names, maps, result, plan] = merge;
  const bool is_small = maps.size() <= kMaxMapsInFull;
  // The page bends few maps itself, and many are shown as they are merged.
  std::vector<std::optional<OccupancyGrid>> bent(maps.size());
  if (!is_small) bent = bent_maps(maps, result);
  std::vector<const OccupancyGrid*> grids;
  for (std::size_t i = 0; i < maps.size(); ++i) grids.push_back(bent[i] ? &*bent[i] : &maps[i]);
  const std::vector<ShownMap> shown = show_all(grids, is_small ? kAnyBytes : kMostBytesOfMaps);
  grids.clear();
  for (const Component& component : result.components) grids.push_back(&component.fused.grid);
  const std::vector<ShownMap> shown_fused = show_all(grids, is_small ? kAnyBytes : kMostBytesOfMerged);
  Json shown_maps = Json::array();
  for (std::size_t i = 0; i < maps.size(); ++i) shown_maps.push_back(map_json(names.at(i), i, shown[i]));
  Json components = Json::array();
  for (std::size_t i = 0; i < result.components.size(); ++i)
    components.push_back(component_json(i, result.components[i], shown_fused[i], is_small));
  Json joins = Json::array();
  const ToldJoins told = tell_joins(result);
  for (const std::size_t i : told.objects) joins.push_back(join_json(result.joins[i], told.in_full));
  Json open_ways = Json::array();
  for (const OpenWay& way : result.open_ways)
    open_ways.push_back({{"fixed", way.fixed},
                         {"moving", way.moving},
                         {"transform", transform_json(way.T_fixed_moving)},
                         {"probability", number_json(way.probability)}});
  Json left_out = Json::array();
  for (const LeftOut& one : result.left_out)
    left_out.push_back(
        {{"map", one.map}, {"reason", name_of(one.reason)}, {"explanation", explain(result, one)}});
  Json content{{"maps", std::move(shown_maps)},   {"components", std::move(components)},
               {"joins", std::move(joins)},       {"refused", refused_json(result, told)},
               {"left_out", std::move(left_out)}, {"open_ways", std::move(open_ways)}};
  if (result.plan) content["plan"] = plan_page_json(merge);
  Json page{{"version", kVersion}, {"live", false}, {"merge", name_of_content(content)}};
  // Moved: it holds all cells.
  for (auto& [key, value] : content.items()) page[key] = std::move(value);
  return page;
}

}  // namespace gridmerge::internal
