// SPDX-License-Identifier: Apache-2.0
#include "merge/component.hpp"

#include <algorithm>
#include <utility>

#include "merge/alignment.hpp"
#include "merge/elastic.hpp"
#include "merge/joins.hpp"
#include "merge/stretch.hpp"

namespace gridmerge::internal {

namespace {

/// Places in a group by map.
std::vector<std::optional<std::size_t>> places_of(const NodeGroup& group, std::size_t maps) {
  std::vector<std::optional<std::size_t>> places(maps);
  for (std::size_t i = 0; i < group.size(); ++i) places[group[i].map] = i;
  return places;
}

std::vector<RelativePose> measured_in(const NodeGroup& group, const JoinProblem& problem,
                                      const ConsistentSet& consistent_set) {
  const auto places = places_of(group, problem.maps.size());
  std::vector<RelativePose> measured;
  for (const UsedCandidate& used : consistent_set.used) {
    const PairCandidates& pair = problem.pairs[used.pair];
    if (!places[pair.fixed] || !places[pair.moving]) continue;
    const CandidateJoin& candidate = pair.candidates[used.candidate];
    if (candidate.is_known) continue;  // the known poses speak for themselves
    measured.push_back(measured_between(*places[pair.fixed], *places[pair.moving], candidate.T_fixed_moving,
                                        problem.maps[pair.fixed].extent, problem.maps[pair.moving].extent,
                                        candidate.sd));
  }
  return measured;
}

/// By how much maps are off where they are joined, the median [m].
double usual_deviation(const std::vector<RelativePose>& measured) {
  constexpr double kUnmeasured = 0.3;
  if (measured.empty()) return kUnmeasured;
  std::vector<double> deviations;
  deviations.reserve(measured.size());
  for (const RelativePose& relative : measured) deviations.push_back(relative.sd_position);
  std::sort(deviations.begin(), deviations.end());
  return deviations[deviations.size() / 2];
}

}  // namespace

Component make_component(const NodeGroup& group, const JoinProblem& problem,
                         const ConsistentSet& consistent_set, const std::vector<MergeInput>& inputs,
                         const MergeOptions& options) {
  std::vector<AlignedMap> maps;
  std::size_t first = 0;  // of the result
  bool is_world = false;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const MergeInput& input = inputs[group[i].map];
    maps.push_back(
        {input.prepared, group[i].T_group_map, problem.maps[group[i].map].extent, input.known_pose});
    if (input.index < inputs[group[first].map].index) first = i;
    is_world = is_world || maps.back().is_fixed();
  }
  const std::vector<RelativePose> measured = measured_in(group, problem, consistent_set);
  std::vector<SE2> poses = align(maps, measured);
  const std::vector<std::optional<PoseDeviation>> deviations = find_deviations(maps, measured, first);

  std::vector<Deformation> deformations(group.size());
  if (options.transform != MapTransform::rigid) {
    std::vector<RigidMember> rigid;
    for (std::size_t i = 0; i < group.size(); ++i)
      rigid.push_back({maps[i].map, poses[i], maps[i].is_fixed()});
    const double sd = usual_deviation(measured);
    const std::vector<BentMember> bent =
        options.transform == MapTransform::elastic ? bend(rigid, sd) : stretch(rigid, sd, options.transform);
    for (std::size_t i = 0; i < group.size(); ++i) {
      poses[i] = bent[i].T_group_map;
      deformations[i] = bent[i].deformation;
    }
  }

  Component component;
  component.in_world_frame = is_world;
  const SE2 T_frame_aligned = is_world ? SE2{} : inverse(poses[first]);
  for (std::size_t i = 0; i < group.size(); ++i) {
    const SE2 T = is_world ? poses[i] : i == first ? SE2{} : T_frame_aligned * poses[i];
    component.members.push_back(
        {inputs[group[i].map].index, T, group[i].probability, deviations[i], deformations[i]});
  }
  std::vector<PlacedMap> placed;
  for (std::size_t i = 0; i < group.size(); ++i)
    placed.push_back({inputs[group[i].map].grid, component.members[i].T_component_map});
  std::sort(component.members.begin(), component.members.end(),
            [](const Member& a, const Member& b) { return a.map < b.map; });
  component.fused = fuse(placed, merged_resolution(options.resolution, placed, deformations), deformations);
  return component;
}

}  // namespace gridmerge::internal
