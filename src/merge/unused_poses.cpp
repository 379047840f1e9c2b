// SPDX-License-Identifier: Apache-2.0
#include "merge/unused_poses.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/merge.hpp"
#include "merge/coverage.hpp"
#include "merge/map_extent.hpp"
#include "merge/prior.hpp"

namespace gridmerge::internal {

namespace {

struct KnownMap {
  KnownPose pose;
  MapExtent extent;
};

using KnownMaps = std::map<std::size_t, KnownMap>;

KnownMaps known_maps(const std::vector<OccupancyGrid>& maps,
                     const std::vector<std::optional<KnownPose>>& known_poses) {
  KnownMaps known;
  for (std::size_t i = 0; i < std::min(maps.size(), known_poses.size()); ++i) {
    if (!known_poses[i]) continue;
    const bool is_blank = count_cells(maps[i]).known() == 0;
    known[i] = {*known_poses[i], is_blank ? MapExtent{} : Coverage(crop_to_known(maps[i])).extent()};
  }
  return known;
}

double angle_between(const SE2& a, const SE2& b) {
  return std::abs(normalize_angle(a.theta - b.theta));
}

/// The members of a component whose poses are not true if that of `anchor` is.
std::vector<UnusedPose> overruled_by(const Member& anchor, const std::vector<Member>& members,
                                     const KnownMaps& known) {
  const KnownMap& first = known.at(anchor.map);
  const SE2 T_component_world = anchor.T_component_map * inverse(first.pose.T_world_map);
  std::vector<UnusedPose> overruled;
  for (const Member& member : members) {
    const KnownMap& one = known.at(member.map);
    const SE2 T_given = T_component_world * one.pose.T_world_map;
    const double distance = displacement(one.extent, member.T_component_map, T_given);
    const double believed = agreement_tolerance(first.extent, one.extent) +
                            kDeviationsOfKnown * sd_between(first.pose, one.pose, first.extent, one.extent);
    if (distance > believed)
      overruled.push_back({.map = member.map,
                           .why = UnusedPose::Why::overruled,
                           .distance = distance,
                           .angle = angle_between(member.T_component_map, T_given)});
  }
  return overruled;
}

std::vector<UnusedPose> overruled_in(const Component& component, const KnownMaps& known) {
  std::vector<Member> members;
  for (const Member& member : component.members) {
    if (known.contains(member.map)) members.push_back(member);
  }
  std::vector<Member> anchors = members;
  if (component.in_world_frame)
    std::erase_if(anchors, [&](const Member& member) { return !known.at(member.map).pose.fixed; });
  std::optional<std::vector<UnusedPose>> fewest;
  for (const Member& anchor : anchors) {
    std::vector<UnusedPose> overruled = overruled_by(anchor, members, known);
    if (!fewest || overruled.size() < fewest->size()) fewest = std::move(overruled);
  }
  return fewest.value_or(std::vector<UnusedPose>{});
}

std::optional<UnusedPose> unused_of(std::size_t map, const KnownMaps& known) {
  const KnownMap& one = known.at(map);
  std::optional<UnusedPose> best;
  for (const auto& [other, its] : known) {
    if (other == map) continue;
    const double sd = sd_between(one.pose, its.pose, one.extent, its.extent);
    const double allowed = agreement_tolerance(one.extent, its.extent);
    if (best && sd / allowed >= best->sd / best->sd_allowed) continue;
    const auto why = sd > allowed ? UnusedPose::Why::not_sure_enough : UnusedPose::Why::contradicted;
    best = UnusedPose{.map = map, .why = why, .other = other, .sd = sd, .sd_allowed = allowed};
  }
  return best;  // none where no other pose is known: it says nothing then
}

struct Offset {
  double distance = 0.0;  // [m]
  double angle = 0.0;     // [rad]
};

/// How far the given poses of two maps are from how the maps alone surely lie; none where they agree, or the
/// maps alone are not sure.
std::optional<Offset> offset_from_match(const Join& join, const KnownMap& fixed, const KnownMap& moving) {
  if (join.match.verdict != Verdict::accepted) return std::nullopt;
  const SE2 T_given = inverse(fixed.pose.T_world_map) * moving.pose.T_world_map;
  const double distance = difference(fixed.extent, moving.extent, T_given, join.match.T_fixed_moving);
  double believed = agreement_tolerance(fixed.extent, moving.extent);
  if (!fixed.pose.fixed || !moving.pose.fixed)
    believed += kDeviationsOfKnown * sd_between(fixed.pose, moving.pose, fixed.extent, moving.extent);
  if (distance <= believed) return std::nullopt;
  return Offset{distance, angle_between(T_given, join.match.T_fixed_moving)};
}

std::optional<UnusedPose> against_match(std::size_t map, const KnownMaps& known, const MergeResult& result) {
  for (const Join& join : result.joins) {
    if ((join.fixed != map && join.moving != map) || !known.contains(join.fixed) ||
        !known.contains(join.moving))
      continue;
    if (const auto offset = offset_from_match(join, known.at(join.fixed), known.at(join.moving)))
      return UnusedPose{.map = map,
                        .why = UnusedPose::Why::against_match,
                        .distance = offset->distance,
                        .other = join.fixed == map ? join.moving : join.fixed,
                        .angle = offset->angle};
  }
  return std::nullopt;
}

}  // namespace

std::vector<UnusedPose> find_unused_poses(const std::vector<OccupancyGrid>& maps,
                                          const std::vector<std::optional<KnownPose>>& known_poses,
                                          const MergeResult& result) {
  const KnownMaps known = known_maps(maps, known_poses);
  std::vector<UnusedPose> unused;
  for (const Component& component : result.components) {
    for (const UnusedPose& one : overruled_in(component, known)) unused.push_back(one);
  }
  for (const LeftOut& alone : result.left_out) {
    if (!known.contains(alone.map)) continue;
    std::optional<UnusedPose> one = against_match(alone.map, known, result);
    if (!one) one = unused_of(alone.map, known);
    if (one) unused.push_back(*one);
  }
  std::sort(unused.begin(), unused.end(),
            [](const UnusedPose& a, const UnusedPose& b) { return a.map < b.map; });
  return unused;
}

std::vector<ContradictedFix> find_contradicted_fixes(const std::vector<OccupancyGrid>& maps,
                                                     const std::vector<std::optional<KnownPose>>& known_poses,
                                                     const MergeResult& result) {
  const KnownMaps known = known_maps(maps, known_poses);
  const auto is_fixed = [&](std::size_t map) { return known.contains(map) && known.at(map).pose.fixed; };
  std::vector<ContradictedFix> contradicted;
  for (const Join& join : result.joins) {
    if (!is_fixed(join.fixed) || !is_fixed(join.moving)) continue;
    if (const auto offset = offset_from_match(join, known.at(join.fixed), known.at(join.moving)))
      contradicted.push_back({join.fixed, join.moving, offset->distance, offset->angle});
  }
  return contradicted;
}

}  // namespace gridmerge::internal
