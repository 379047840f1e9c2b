// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "merge/coverage.hpp"
#include "merge/joins.hpp"
#include "merge/pose_graph.hpp"
#include "report/interchange.hpp"
#include "report/json_values.hpp"
#include "report/told_joins.hpp"

namespace gridmerge::internal {

namespace {

MapExtent extent_of(const OccupancyGrid& map) {
  return count_cells(map).known() == 0 ? MapExtent{} : Coverage(crop_to_known(map)).extent();
}

std::string pose_text(const SE2& T) {
  return fmt::format("{} {} {}", T.x + 0.0, T.y + 0.0, T.theta + 0.0);  // no -0
}

/// The upper triangle of the information matrix of (x, y, theta), the error of the moving map's pose in its
/// own frame, of which the deviations are known at the pivot.
std::string information_text(const RelativePose& measured) {
  const double place = 1.0 / (measured.sd_position * measured.sd_position);
  const double direction = 1.0 / (measured.sd_theta * measured.sd_theta);
  const Point2& p = measured.pivot;
  return fmt::format("{} {} {} {} {} {}", place, 0.0, -p.y * place + 0.0, place, p.x * place + 0.0,
                     (p.x * p.x + p.y * p.y) * place + direction);
}

bool holds_the_frame(const Component& component, const Member& member) {
  if (frame_of(component) == member.map) return true;
  return component.in_world_frame && member.sd && member.sd->position == 0.0 && member.sd->theta == 0.0;
}

/// Those that an optimiser must not move: one at least, or the poses are not determined. A plan holds each of
/// the parts that hang on it.
std::vector<std::size_t> held_in(const Component& component, const std::optional<PlanPlacement>& plan) {
  std::vector<std::size_t> held;
  if (plan && component.in_world_frame) {
    for (const PlanPart& part : plan->parts) {
      if (part.on_plan()) held.push_back(part.maps.front());
    }
    return held;
  }
  for (const Member& member : component.members) {
    if (holds_the_frame(component, member)) held.push_back(member.map);
  }
  if (held.empty()) held.push_back(component.members.front().map);
  return held;
}

}  // namespace

std::string g2o_text(const NamedMerge& merge) {
  const auto& [names, maps, result, plan] = merge;
  // Vertices and edges come first: GTSAM reads no edge behind a line that it does not know, such as a
  // comment.
  std::string text;
  std::string notes(kG2oMark);
  notes += "# metres and radians; a vertex takes a map's frame to its merged map's\n";
  if (is_any_bent(result))
    notes += "# of maps that are bent or stretched these are the rigid parts: this format has poses alone\n";
  std::vector<std::optional<std::size_t>> component_of(maps.size());
  std::vector<MapExtent> extents(maps.size());
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    for (const Member& member : result.components[i].members) {
      component_of.at(member.map) = i;
      extents[member.map] = extent_of(maps[member.map]);
      fmt::format_to(std::back_inserter(text), "VERTEX_SE2 {} {}\n", member.map,
                     pose_text(member.T_component_map));
      fmt::format_to(std::back_inserter(notes), "# {}: {} in {}\n", member.map, quoted(names.at(member.map)),
                     component_file(i));
    }
  }
  for (const Join& join : result.joins) {
    const auto& component = component_of.at(join.fixed);
    if (!join.used() || !component || component != component_of.at(join.moving)) continue;
    const std::optional<double> sd = deviation_of(join);
    const MapExtent &fixed = extents[join.fixed], &moving = extents[join.moving];
    if (!sd)
      fmt::format_to(std::back_inserter(notes),
                     "# {} to {}: no deviation is known; it is that of poses that are taken for equal\n",
                     join.fixed, join.moving);
    const RelativePose measured = measured_between(join.fixed, join.moving, join.T_fixed_moving, fixed,
                                                   moving, sd ? *sd : agreement_tolerance(fixed, moving));
    fmt::format_to(std::back_inserter(text), "EDGE_SE2 {} {} {} {}\n", join.fixed, join.moving,
                   pose_text(join.T_fixed_moving), information_text(measured));
  }
  for (const Component& component : result.components) {
    for (const std::size_t map : held_in(component, result.plan))
      fmt::format_to(std::back_inserter(text), "FIX {}\n", map);
  }
  return text + notes;
}

}  // namespace gridmerge::internal
