// SPDX-License-Identifier: Apache-2.0
#include "component.hpp"

#include <algorithm>
#include <utility>

#include "alignment.hpp"

namespace gridmerge {

namespace {

/// Places in a group by map.
std::vector<std::optional<std::size_t>> places_of(const NodeGroup& group, std::size_t maps) {
  std::vector<std::optional<std::size_t>> places(maps);
  for (std::size_t i = 0; i < group.size(); ++i) places[group[i].map] = i;
  return places;
}

std::vector<RelativePose> measured_in(const NodeGroup& group, const ArrangementProblem& problem,
                                      const Arrangement& arrangement) {
  const auto places = places_of(group, problem.maps.size());
  std::vector<RelativePose> measured;
  for (const UsedCandidate& used : arrangement.used) {
    const PairCandidates& pair = problem.pairs[used.pair];
    if (!places[pair.fixed] || !places[pair.moving]) continue;
    const CandidateJoin& candidate = pair.candidates[used.candidate];
    measured.push_back(measured_between(*places[pair.fixed], *places[pair.moving], candidate.T_fixed_moving,
                                        problem.maps[pair.fixed], problem.maps[pair.moving], candidate.sd));
  }
  return measured;
}

double finest(const NodeGroup& group, const std::vector<const OccupancyGrid*>& grids) {
  double resolution = grids[group.front().map]->resolution;
  for (const PlacedNode& node : group) resolution = std::min(resolution, grids[node.map]->resolution);
  return resolution;
}

}  // namespace

Component make_component(const NodeGroup& group, const ArrangementProblem& problem,
                         const Arrangement& arrangement, const std::vector<const OccupancyGrid*>& grids,
                         const std::vector<const PreparedMap*>& prepared,
                         const std::vector<std::optional<KnownPose>>& known_poses, double resolution) {
  std::vector<AlignedMap> maps;
  for (const PlacedNode& node : group)
    maps.push_back({prepared[node.map], node.T_group_map, problem.maps[node.map], known_poses[node.map]});
  const std::vector<AdjustedPose> poses = align(maps, measured_in(group, problem, arrangement));

  Component component;
  std::vector<PlacedMap> placed;
  for (std::size_t i = 0; i < group.size(); ++i) {
    component.members.push_back({group[i].map, poses[i].T_frame_map, group[i].probability, poses[i].sd});
    placed.push_back({grids[group[i].map], poses[i].T_frame_map});
  }
  component.fused = fuse(placed, resolution > 0.0 ? resolution : finest(group, grids));
  return component;
}

}  // namespace gridmerge
