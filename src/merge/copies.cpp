// SPDX-License-Identifier: Apache-2.0
#include "merge/copies.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "grid/equal_grids.hpp"
#include "grid/longer_side.hpp"
#include "grid/quarter_turned.hpp"
#include "grid/seen_from.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "merge/joins.hpp"

namespace gridmerge::internal {

namespace {

/// Of a cell: copies whose poses are worked out in two ways are no farther apart.
constexpr double kSamePlace = 1e-3;

/// A join of the originals as one of two maps that lie on them.
Join carried_over(Join join, const SE2& T_copy_fixed, const SE2& T_moving_copy) {
  const auto carry = [&](SE2& T_fixed_moving) {
    T_fixed_moving = T_copy_fixed * T_fixed_moving * T_moving_copy;
  };
  carry(join.T_fixed_moving);
  carry(join.match.T_fixed_moving);
  for (Hypothesis& hypothesis : join.match.hypotheses) {
    carry(hypothesis.T_fixed_moving);
    double& free_direction = hypothesis.figures.free_direction;
    free_direction = undirected_angle(free_direction + T_copy_fixed.theta);
  }
  return join;
}

/// Of a map and its copy: they lie on each other in every cell.
Join join_of_copies(std::size_t fixed, std::size_t moving, const SE2& T_fixed_moving, std::size_t known) {
  MatchResult match;
  match.verdict = Verdict::accepted;
  match.reason = Reason::none;
  match.T_fixed_moving = T_fixed_moving;
  match.probability = 1.0;
  match.acceptance_index = 1.0;
  match.agreement = known;
  match.overlap = 1.0;
  Hypothesis only;
  only.T_fixed_moving = T_fixed_moving;
  only.probability = 1.0;
  only.figures.acceptance_index = only.figures.overlap = 1.0;
  match.hypotheses.push_back(only);
  return make_join(fixed, moving, std::move(match));
}

/// How many quarters a map was turned by when it was prepared: 0 to 3.
int quarters_of(const GivenMap& map) {
  const double theta = map.grid.origin.theta - map.prepared.known().origin.theta;
  return (static_cast<int>(std::lround(theta / (0.5 * std::numbers::pi))) % 4 + 4) % 4;
}

bool looks_the_same_turned(const OccupancyGrid& map) {
  return has_equal_cells(map, quarter_turned(map, 1)) || has_equal_cells(map, quarter_turned(map, 2));
}

Member* find_member(MergeResult& result, std::size_t map, Component*& of) {
  for (Component& component : result.components) {
    for (Member& member : component.members) {
      if (member.map != map) continue;
      of = &component;
      return &member;
    }
  }
  return nullptr;
}

/// Gives a component the frame of its first map, which is a copy of one that held it.
void hold_by_first(Component& component, const std::vector<Copy>& copies,
                   const std::vector<const OccupancyGrid*>& grids, double resolution) {
  const SE2 T_first_component = inverse(component.members.front().T_component_map);
  if (T_first_component == SE2{}) return;
  std::vector<std::size_t> counting;
  for (std::size_t i = 0; i < component.members.size(); ++i) {
    Member& member = component.members[i];
    member.T_component_map = T_first_component * member.T_component_map;
    if (std::none_of(copies.begin(), copies.end(), [&](const Copy& copy) { return copy.map == member.map; }))
      counting.push_back(i);
  }
  component.members.front().T_component_map = {};  // to the bit
  component.fused = fuse_members(component.members, counting, grids, resolution);
}

}  // namespace

bool is_copy(const PreparedMap& a, const PreparedMap& b) {
  return a.counts().occupied > 0 && a.counts().occupied == b.counts().occupied &&
         a.counts().free == b.counts().free && has_equal_cells(a.known(), b.known());
}

bool is_given_twice(const GivenMap& a, const GivenMap& b) {
  if (!is_copy(a.prepared, b.prepared)) return false;
  return quarters_of(a) == quarters_of(b) || !looks_the_same_turned(a.prepared.known());
}

SE2 between_copies(const PreparedMap& a, const PreparedMap& b) {
  return a.known().origin == b.known().origin ? SE2{} : a.known().origin * inverse(b.known().origin);
}

std::vector<std::size_t> without_copies(const std::vector<PlacedInput>& maps) {
  std::vector<SE2> T_output_grid;
  T_output_grid.reserve(maps.size());
  for (const PlacedInput& one : maps) T_output_grid.push_back(one.T_output_map * one.map->known().origin);
  const auto lie_on_each_other = [&](std::size_t a, std::size_t b) {
    const OccupancyGrid& grid = maps[a].map->known();
    const SE2 &T_a = T_output_grid[a], &T_b = T_output_grid[b];
    const double apart = std::hypot(T_a.x - T_b.x, T_a.y - T_b.y) +
                         std::abs(normalize_angle(T_a.theta - T_b.theta)) * longer_side(grid);
    return apart < kSamePlace * grid.resolution && is_copy(*maps[a].map, *maps[b].map);
  };
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (std::none_of(kept.begin(), kept.end(), [&](std::size_t k) { return lie_on_each_other(k, i); }))
      kept.push_back(i);
  }
  return kept;
}

void tell_ways_anew(const Component& component, std::vector<OpenWay>& ways) {
  std::map<std::size_t, SE2> places;
  for (const Member& member : component.members) places[member.map] = member.T_component_map;
  const std::size_t first = component.members.front().map;
  const SE2 T_first_plan = inverse(component.members.front().T_component_map);
  std::erase_if(
      ways, [&](const OpenWay& way) { return places.contains(way.fixed) && places.contains(way.moving); });
  for (OpenWay& way : ways) {
    if (places.contains(way.fixed)) {
      way.T_fixed_moving = T_first_plan * places.at(way.fixed) * way.T_fixed_moving;
      way.fixed = first;
    } else if (places.contains(way.moving)) {
      way.T_fixed_moving = way.T_fixed_moving * inverse(places.at(way.moving)) * inverse(T_first_plan);
      way.moving = first;
    }
    if (way.fixed < way.moving) continue;
    std::swap(way.fixed, way.moving);
    way.T_fixed_moving = inverse(way.T_fixed_moving);
  }
}

void add_copies(const std::vector<Copy>& copies, const std::vector<const OccupancyGrid*>& grids,
                const std::vector<std::optional<KnownPose>>& known_poses, double resolution,
                MergeResult& result) {
  if (copies.empty()) return;
  struct LiesOn {
    std::size_t original;
    SE2 T_original_map;
  };
  std::map<std::size_t, LiesOn> places;  // of every input
  for (std::size_t i = 0; i < grids.size(); ++i) places[i] = {i, {}};
  for (const Copy& copy : copies) places[copy.map] = {copy.original, copy.T_original_map};

  std::map<std::pair<std::size_t, std::size_t>, Join> joins;
  for (const Join& join : result.joins) joins[{join.fixed, join.moving}] = join;
  result.joins.clear();
  for (std::size_t a = 0; a < grids.size(); ++a) {
    for (std::size_t b = a + 1; b < grids.size(); ++b) {
      const LiesOn &of_a = places[a], &of_b = places[b];
      const SE2 T_a = inverse(of_a.T_original_map);
      if (of_a.original == of_b.original) {
        result.joins.push_back(
            join_of_copies(a, b, T_a * of_b.T_original_map, count_cells(*grids[a]).known()));
        continue;
      }
      const auto [first, second] = std::minmax(of_a.original, of_b.original);
      const auto found = joins.find({first, second});
      if (found == joins.end()) continue;  // nobody has looked at the two
      const Join& of_originals = found->second;
      Join join = carried_over(first == of_a.original ? of_originals : inverted(of_originals), T_a,
                               of_b.T_original_map);
      join.fixed = a;
      join.moving = b;
      result.joins.push_back(std::move(join));
    }
  }

  for (const Copy& copy : copies) {
    Component* component = nullptr;
    const Member* original = find_member(result, copy.original, component);
    if (original == nullptr) {
      std::erase_if(result.left_out, [&](const LeftOut& one) { return one.map == copy.original; });
      const std::optional<KnownPose>& known = known_poses[copy.original];
      const bool is_fixed = known && known->fixed;
      const PlacedMap placed{grids[copy.original], is_fixed ? known->T_world_map : SE2{}};
      component = &result.components.emplace_back();
      component->in_world_frame = is_fixed;
      component->members.push_back(
          {copy.original, placed.T_output_map, 1.0, PoseDeviation{}});  // it holds the frame
      component->fused = fuse({placed}, merged_resolution(resolution, {placed}));
      original = &component->members.front();
    }
    Member member = *original;
    member.map = copy.map;
    member.T_component_map = original->T_component_map * copy.T_original_map;
    member.deformation = seen_from(inverse(copy.T_original_map), original->deformation);
    component->members.push_back(member);
  }
  for (Component& component : result.components) {
    const std::size_t held_by = component.members.front().map;
    std::sort(component.members.begin(), component.members.end(),
              [](const Member& a, const Member& b) { return a.map < b.map; });
    if (component.members.front().map == held_by) continue;
    tell_ways_anew(component, result.open_ways);
    if (!component.in_world_frame) hold_by_first(component, copies, grids, resolution);
  }
}

}  // namespace gridmerge::internal
