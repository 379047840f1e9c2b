// SPDX-License-Identifier: Apache-2.0
#include "merge/consistent_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "grid/parallel.hpp"
#include "merge/group_cuts.hpp"
#include "merge/group_search.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {

namespace {

void validate(const JoinProblem& problem, double accept_probability) {
  const std::size_t maps = problem.maps.size();
  if (!(accept_probability >= 0.0 && accept_probability <= 1.0))
    throw std::invalid_argument("accept_probability must lie in [0, 1]");
  for (const PairCandidates& pair : problem.pairs) {
    if (pair.fixed >= pair.moving || pair.moving >= maps)
      throw std::invalid_argument("a pair must be of two maps, the lower index first");
  }
}

void validate_budget(double max_false_joins) {
  if (!(max_false_joins >= 0.0) || !std::isfinite(max_false_joins))
    throw std::invalid_argument("max_false_joins must be a number from 0 on");
}

std::vector<UsedCandidate> used_in_all(const JoinWeights& weights, const NodeGroups& groups) {
  std::vector<UsedCandidate> all;
  for (const NodeGroup& group : groups) {
    for (const UsedCandidate& used : weights.used_in(group)) all.push_back(used);
  }
  std::sort(all.begin(), all.end(),
            [](const UsedCandidate& a, const UsedCandidate& b) { return a.pair < b.pair; });
  return all;
}

}  // namespace

ConsistentSet find_consistent_set(const JoinProblem& problem, double accept_probability) {
  return find_consistent_set_within(problem, accept_probability, std::numeric_limits<double>::max());
}

std::vector<OpenJoin> find_open_joins(const JoinProblem& problem, const ConsistentSet& consistent_set,
                                      double least_probability) {
  validate(problem, least_probability);
  const JoinWeights weights(problem);
  const std::vector<NodeGroup>& groups = consistent_set.groups;
  std::vector<std::vector<OpenJoin>> of_first(groups.size());
  std::vector<std::size_t> group_of(problem.maps.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const PlacedNode& node : groups[g]) group_of[node.map] = g;
  }
  parallel_for(groups.size(), [&](std::size_t a) {
    std::set<std::size_t> near;  // later groups to which a pair proposes a way
    for (const PlacedNode& node : groups[a]) {
      for (const std::size_t map : weights.partners_of(node.map)) {
        if (group_of[map] > a) near.insert(group_of[map]);
      }
    }
    for (const std::size_t b : near) {
      for (const WeighedJoin& way : weights.ways_to_join(groups[a], groups[b])) {
        if (way.probability >= least_probability) of_first[a].push_back({a, b, way.T_a_b, way.probability});
      }
    }
  });
  std::vector<OpenJoin> open;
  for (const std::vector<OpenJoin>& some : of_first) open.insert(open.end(), some.begin(), some.end());
  std::stable_sort(open.begin(), open.end(),
                   [](const OpenJoin& x, const OpenJoin& y) { return x.probability > y.probability; });
  return open;
}

double expected_false_joins(const ConsistentSet& consistent_set) {
  double expected = 0.0;
  for (const NodeGroup& group : consistent_set.groups) {
    // Every map is doubted given the others: two maps doubt one join twice.
    const double share = static_cast<double>(group.size() - 1) / static_cast<double>(group.size());
    for (const PlacedNode& node : group) expected += share * (1.0 - node.probability);
  }
  return expected;
}

double false_joins_allowed(double max_false_joins, std::size_t maps) {
  validate_budget(max_false_joins);
  return max_false_joins * std::max(1.0, static_cast<double>(maps) / static_cast<double>(kFewMaps));
}

ConsistentSet find_consistent_set_within(const JoinProblem& problem, double accept_probability,
                                         double max_false_joins) {
  validate_budget(max_false_joins);
  validate(problem, accept_probability);
  const JoinWeights weights(problem);
  GroupCuts cuts(weights, GroupSearch(weights, problem, accept_probability).groups());
  cuts.cut_below(accept_probability);
  ConsistentSet consistent_set{cuts.weighed_groups(), {}};
  const std::vector<UsedCandidate> without_budget = used_in_all(weights, consistent_set.groups);
  while (expected_false_joins(consistent_set) > max_false_joins && cuts.cut_least()) {
    cuts.cut_below(accept_probability);
    consistent_set.groups = cuts.weighed_groups();
  }
  consistent_set.used = used_in_all(weights, consistent_set.groups);
  const std::vector<UsedCandidate>& used = consistent_set.used;
  for (const UsedCandidate& one : without_budget) {
    const auto less = [](const UsedCandidate& a, const UsedCandidate& b) { return a.pair < b.pair; };
    if (!std::binary_search(used.begin(), used.end(), one, less))
      consistent_set.over_budget.push_back(one.pair);
  }
  return consistent_set;
}

}  // namespace gridmerge::internal
