// SPDX-License-Identifier: Apache-2.0
#include "merge/on_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "merge/copies.hpp"
#include "merge/joins.hpp"
#include "merge/solution.hpp"

namespace gridmerge::internal {

namespace {

/// How well a member is known on the plan, if so well within its part.
PoseDeviation deviation_of(const std::optional<PoseDeviation>& in_part, const OnPlan& on_plan) {
  const double radius = std::max(on_plan.part->voices.front().input->coverage.extent().radius, 1e-9);
  const PoseDeviation own = in_part.value_or(PoseDeviation{});
  return {std::hypot(own.position, on_plan.way.sd), std::hypot(own.theta, on_plan.way.sd / radius)};
}

Component component_of(const std::vector<OnPlan>& hung, const PlanInputs& inputs, double resolution) {
  Component component;
  component.in_world_frame = true;
  for (const OnPlan& one : hung) {
    for (const Member& member : one.part->members) {
      Member placed = member;
      placed.T_component_map = one.way.T_plan_part * member.T_component_map;
      placed.probability = member.probability.value_or(1.0) * one.way.probability;
      placed.sd = deviation_of(member.sd, one);
      component.members.push_back(std::move(placed));
    }
  }
  std::sort(component.members.begin(), component.members.end(),
            [](const Member& a, const Member& b) { return a.map < b.map; });
  std::vector<PlacedInput> placed;
  placed.reserve(component.members.size());
  for (const Member& member : component.members)
    placed.push_back({&inputs[member.map]->prepared, member.T_component_map});
  std::vector<const OccupancyGrid*> grids;
  grids.reserve(inputs.size());
  for (const auto& input : inputs) grids.push_back(input->grid.get());
  component.fused = fuse_members(component.members, without_copies(placed), grids, resolution);
  return component;
}

}  // namespace

void join_on_plan(const std::vector<OnPlan>& hung, const PlanInputs& inputs, double resolution,
                  MergeResult& merged) {
  std::size_t maps = 0;
  for (const OnPlan& one : hung) maps += one.part->members.size();
  if (maps < 2) return;
  Component component = component_of(hung, inputs, resolution);
  std::set<std::size_t> gone;  // components
  for (const OnPlan& one : hung) {
    if (one.part->component) gone.insert(*one.part->component);
    if (merged.expected_false_joins) *merged.expected_false_joins += 1.0 - one.way.probability;
  }
  std::vector<Component> components;
  for (std::size_t i = 0; i < merged.components.size(); ++i) {
    if (!gone.contains(i)) components.push_back(std::move(merged.components[i]));
  }
  tell_ways_anew(component, merged.open_ways);
  std::erase_if(merged.left_out, [&](const LeftOut& one) {
    return std::any_of(component.members.begin(), component.members.end(),
                       [&](const Member& member) { return member.map == one.map; });
  });
  components.push_back(std::move(component));
  merged.components = std::move(components);
  sort_components(merged);
}

}  // namespace gridmerge::internal
