// SPDX-License-Identifier: Apache-2.0
#include "merge/solution.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "match/pair_pose.hpp"
#include "merge/candidates.hpp"
#include "merge/component.hpp"
#include "merge/joins.hpp"
#include "merge/prior.hpp"

namespace gridmerge::internal {

namespace {

using MapId = MapStore::MapId;
using Pair = PairLooks::Pair;

/// In the order in which the maps were added.
std::vector<Join> make_joins(const MapStore& store, const std::vector<MapId>& maps, const PairLooks& looks,
                             const Solution& solution) {
  const JoinProblem& problem = solution.problem;
  std::map<std::size_t, std::size_t> used;  // candidate by pair
  for (const UsedCandidate& one : solution.consistent_set.used) used[one.pair] = one.candidate;
  const std::vector<std::size_t>& over_budget = solution.consistent_set.over_budget;
  std::vector<bool> is_placed(maps.size());
  for (const NodeGroup& group : solution.consistent_set.groups) {
    for (const PlacedNode& node : group) is_placed[node.map] = group.size() > 1;
  }
  const std::vector<std::size_t> index = store.places_of(maps);
  std::vector<Join> joins;
  for (std::size_t i = 0; i < problem.pairs.size(); ++i) {
    const PairCandidates& pair = problem.pairs[i];
    // Nobody may have looked at it, if a group speaks for the pair.
    const MatchResult match = looks.holds(maps[pair.fixed], maps[pair.moving])
                                  ? looks.between(maps[pair.fixed], maps[pair.moving], solution.again)
                                  : MatchResult{};
    const CandidateJoin* candidate = used.contains(i) ? &pair.candidates[used.at(i)] : nullptr;
    const bool is_in_company = is_placed[pair.fixed] || is_placed[pair.moving];
    const bool is_over_budget = std::binary_search(over_budget.begin(), over_budget.end(), i);
    Join join =
        make_join(index[pair.fixed], index[pair.moving], match, {candidate, is_in_company, is_over_budget});
    if (join.T_fixed_moving != match.T_fixed_moving || match.hypotheses.empty())
      count_common(store.at(maps[pair.fixed]).prepared, store.at(maps[pair.moving]).prepared, join);
    joins.push_back(join.fixed < join.moving ? std::move(join) : inverted(join));
  }
  std::sort(joins.begin(), joins.end(), [](const Join& a, const Join& b) {
    return std::pair(a.fixed, a.moving) < std::pair(b.fixed, b.moving);
  });
  return joins;
}

void add_components(const std::vector<MergeInput>& inputs, const Solution& solution,
                    const MergeOptions& options, MergeResult& result) {
  for (const NodeGroup& group : solution.consistent_set.groups) {
    if (group.size() == 1) {
      result.left_out.push_back(left_out(inputs[group.front().map].index, result.joins));
    } else {
      result.components.push_back(
          make_component(group, solution.problem, solution.consistent_set, inputs, options));
    }
  }
  std::sort(result.left_out.begin(), result.left_out.end(),
            [](const LeftOut& a, const LeftOut& b) { return a.map < b.map; });
}

}  // namespace

void sort_components(MergeResult& result) {
  std::sort(result.components.begin(), result.components.end(), [](const Component& a, const Component& b) {
    const auto key = [](const Component& c) {
      return std::pair(-std::ssize(c.members), c.members.front().map);
    };
    return key(a) < key(b);
  });
}

JoinProblem make_problem(const MapStore& store, const std::vector<MapId>& maps,
                         const std::vector<Pair>& chosen, const PairLooks& looks,
                         const std::set<Pair>& again) {
  JoinProblem problem;
  std::map<MapId, std::size_t> place;
  for (const MapId id : maps) {
    place[id] = problem.maps.size();
    const Coverage& coverage = store.at(id).coverage;
    const std::optional<KnownPose> known = store.known_pose(id);
    problem.maps.push_back({coverage.extent(), &coverage,
                            known && known->fixed ? std::optional(known->T_world_map) : std::nullopt});
  }
  for (const auto& [fixed, moving] : chosen) {
    const std::size_t a = place.at(fixed), b = place.at(moving);
    PairCandidates pair{a, b, candidate_joins(looks.between(fixed, moving, again))};
    const std::optional<KnownPose> of_a = store.known_pose(fixed), of_b = store.known_pose(moving);
    if (of_a && of_b && !(of_a->fixed && of_b->fixed))
      apply_known_poses(*of_a, *of_b, problem.maps[a], problem.maps[b], pair);
    problem.pairs.push_back(std::move(pair));
  }
  // In whatever order they were chosen.
  std::sort(problem.pairs.begin(), problem.pairs.end(), [](const PairCandidates& a, const PairCandidates& b) {
    return std::pair(a.fixed, a.moving) < std::pair(b.fixed, b.moving);
  });
  return problem;
}

std::vector<Pair> pairs_apart(const std::vector<Pair>& chosen, const std::vector<MapId>& maps,
                              const ConsistentSet& consistent_set) {
  std::map<MapId, std::size_t> group_of;
  for (std::size_t i = 0; i < consistent_set.groups.size(); ++i) {
    for (const PlacedNode& node : consistent_set.groups[i]) group_of[maps[node.map]] = i;
  }
  std::vector<Pair> pairs = chosen;
  std::erase_if(pairs, [&](const Pair& pair) { return group_of.at(pair.first) == group_of.at(pair.second); });
  return pairs;
}

MergeResult make_result(const MapStore& store, const std::vector<MapId>& maps,
                        const std::vector<Copy>& copies, const PairLooks& looks, const Solution& solution,
                        const MergeOptions& options) {
  MergeResult result;
  result.expected_false_joins = expected_false_joins(solution.consistent_set);
  result.joins = make_joins(store, maps, looks, solution);
  result.open_ways = make_open_ways(store.places_of(maps), solution.problem, solution.consistent_set);
  add_components(store.inputs_of(maps), solution, options, result);
  add_copies(copies, store.grids(), store.known_poses(), options.resolution, result);
  sort_components(result);
  return result;
}

}  // namespace gridmerge::internal
