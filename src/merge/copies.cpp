// SPDX-License-Identifier: Apache-2.0
#include "merge/copies.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "grid/equal_grids.hpp"
#include "grid/seen_from.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "merge/joins.hpp"

namespace gridmerge::internal {

namespace {

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

}  // namespace

bool is_copy(const PreparedMap& a, const PreparedMap& b) {
  return a.counts().occupied > 0 && a.counts().occupied == b.counts().occupied &&
         a.counts().free == b.counts().free && has_equal_cells(a.known(), b.known());
}

SE2 between_copies(const PreparedMap& a, const PreparedMap& b) {
  return a.known().origin == b.known().origin ? SE2{} : a.known().origin * inverse(b.known().origin);
}

bool is_placed(const PlacedMap& one, const std::vector<PlacedMap>& placed) {
  return std::any_of(placed.begin(), placed.end(), [&](const PlacedMap& other) {
    return one.T_output_map == other.T_output_map && one.map->origin == other.map->origin &&
           has_equal_cells(*one.map, *other.map);
  });
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
    std::sort(component.members.begin(), component.members.end(),
              [](const Member& a, const Member& b) { return a.map < b.map; });
  }
}

}  // namespace gridmerge::internal
