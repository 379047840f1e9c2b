// SPDX-License-Identifier: Apache-2.0
// The ways in which two groups of maps may lie, and how probable each is.
#include <algorithm>
#include <cmath>
#include <limits>

#include "grid/logistic.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {

namespace {

/// What a pair says by itself of two of three or more maps. Most pairs of them share little or nothing, and
/// the surest of many matches is too often of a place that looks the same: the odds are so many times what
/// the match says, and one in so many sure matches is of a place that repeats. With these, 120 simulated
/// teams have as many false joins as their budgets allow (benchmark/teams.py).
constexpr double kOddsAmongMany = 0.4;
constexpr double kRepeats = 0.005;

/// So many poses are weighed in full for two groups: those with which most pairs agree.
constexpr std::size_t kMaxProposals = 50;
/// Candidates less likely than this propose no join, though they may agree with one.
constexpr double kMinLogOdds = -6.0;
/// Poses nearer to each other than this many tolerances are one way to join: the same candidate may agree
/// with both.
constexpr double kDistinct = 2.0;

MapExtent extent_of(const NodeGroup& group, const std::vector<MapExtent>& maps) {
  MapExtent all;
  for (const PlacedNode& node : group) {
    const Point2 centre = node.T_group_map * maps[node.map].centre;
    all.centre.x += centre.x / static_cast<double>(group.size());
    all.centre.y += centre.y / static_cast<double>(group.size());
    all.side = std::max(all.side, maps[node.map].side);
  }
  double squares = 0.0;
  for (const PlacedNode& node : group) {
    const Point2 centre = node.T_group_map * maps[node.map].centre;
    squares += std::pow(maps[node.map].radius, 2) + std::pow(centre.x - all.centre.x, 2) +
               std::pow(centre.y - all.centre.y, 2);
  }
  all.radius = std::sqrt(squares / static_cast<double>(group.size()));
  return all;
}

}  // namespace

void weigh_against_each_other(std::vector<WeighedJoin>& ways) {
  const auto worth = [](const WeighedJoin& way) { return way.worth.against_other_poses; };
  double most = -std::numeric_limits<double>::infinity();
  for (const WeighedJoin& way : ways) most = std::max(most, worth(way));
  double sum = 0.0;  // of all, in units of the best one
  for (const WeighedJoin& way : ways) sum += std::exp(worth(way) - most);
  for (WeighedJoin& way : ways)
    way.probability = 1.0 / (sum * std::exp(most - worth(way)) + std::exp(-way.worth.against_apart));
}

/// The distinct poses that candidates of pairs across the groups propose, those first that most pairs agree
/// with: weighing a pose in full takes a hundred times as long.
std::vector<SE2> JoinWeights::proposals(const NodeGroup& a, const NodeGroup& b) const {
  struct Proposal {
    SE2 T_a_b;
    double agreement = 0.0;
  };
  const std::vector<Across> across = pairs_across(a, b);
  std::vector<Proposal> all;
  for (const Across& one : across) {
    const PairCandidates& pair = problem_.pairs[one.pair];
    for (const CandidateJoin& candidate : pair.candidates) {
      if (candidate.log_odds < kMinLogOdds) continue;
      const SE2 T = pair.fixed == a[one.a].map ? candidate.T_fixed_moving : inverse(candidate.T_fixed_moving);
      all.push_back({a[one.a].T_group_map * T * inverse(b[one.b].T_group_map)});
    }
  }
  for (Proposal& proposal : all) {
    for (const Across& one : across) {
      const SE2 T_map_b = inverse(a[one.a].T_group_map) * proposal.T_a_b;
      if (const auto agreement = find_agreement(one.pair, a[one.a].map, T_map_b * b[one.b].T_group_map))
        proposal.agreement += agreement->worth;
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Proposal& x, const Proposal& y) { return x.agreement > y.agreement; });
  const MapExtent of_a = extent_of(a, problem_.maps), of_b = extent_of(b, problem_.maps);
  const double distinct = kDistinct * agreement_tolerance(of_a, of_b);
  std::vector<SE2> kept;
  for (const Proposal& proposal : all) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const SE2& other) {
      return difference(of_a, of_b, proposal.T_a_b, other) < distinct;
    });
    if (is_new) kept.push_back(proposal.T_a_b);
    if (kept.size() == kMaxProposals) break;
  }
  return kept;
}

/// Two maps alone lie as their pair says, which has weighed all that there is.
std::vector<WeighedJoin> JoinWeights::ways_of_pair(const PlacedNode& a, const PlacedNode& b) const {
  const std::optional<std::size_t> index = pair_of(a.map, b.map);
  if (!index) return {};
  const PairCandidates& pair = problem_.pairs[*index];
  const bool of_many = problem_.maps.size() > 2;
  const auto probability = [&](const CandidateJoin& candidate) {
    const double p = logistic(candidate.log_odds);
    if (!of_many || candidate.is_known) return p;
    const double odds = kOddsAmongMany * p / (1.0 - p + kRepeats);
    return odds / (1.0 + odds);
  };
  double sum = 0.0;  // above 1 where candidates were made likelier by what is known beforehand
  for (const CandidateJoin& candidate : pair.candidates) sum += probability(candidate);
  std::vector<WeighedJoin> ways;
  for (const CandidateJoin& candidate : pair.candidates) {
    const SE2 T = pair.fixed == a.map ? candidate.T_fixed_moving : inverse(candidate.T_fixed_moving);
    ways.push_back({a.T_group_map * T * inverse(b.T_group_map),
                    {candidate.log_odds, candidate.log_odds},
                    probability(candidate) / std::max(1.0, sum)});
  }
  return ways;
}

std::vector<WeighedJoin> JoinWeights::ways_by_worth(const NodeGroup& a, const NodeGroup& b) const {
  std::vector<WeighedJoin> ways;
  for (const SE2& T_a_b : proposals(a, b)) ways.push_back({T_a_b, worth_of(a, b, T_a_b)});
  weigh_against_each_other(ways);
  return ways;
}

std::vector<WeighedJoin> JoinWeights::ways_to_join(const NodeGroup& a, const NodeGroup& b) const {
  std::vector<WeighedJoin> ways =
      a.size() == 1 && b.size() == 1 ? ways_of_pair(a.front(), b.front()) : ways_by_worth(a, b);
  std::stable_sort(ways.begin(), ways.end(), [](const WeighedJoin& x, const WeighedJoin& y) {
    return x.worth.against_other_poses > y.worth.against_other_poses;
  });
  return ways;
}

std::optional<WeighedJoin> JoinWeights::best_join(const NodeGroup& a, const NodeGroup& b) const {
  const std::vector<WeighedJoin> ways = ways_to_join(a, b);
  return ways.empty() ? std::nullopt : std::optional(ways.front());
}

double JoinWeights::probability_of_lying_so(const NodeGroup& a, const NodeGroup& b) const {
  const std::vector<WeighedJoin> all = ways_to_join(a, b);
  if (a.size() == 1 && b.size() == 1) return all.empty() ? 0.0 : all.front().probability;
  const MapExtent of_a = extent_of(a, problem_.maps), of_b = extent_of(b, problem_.maps);
  const double distinct = kDistinct * agreement_tolerance(of_a, of_b);
  std::vector<WeighedJoin> ways{{{}, worth_of(a, b, {})}};
  for (const WeighedJoin& way : all) {
    if (difference(of_a, of_b, way.T_a_b, {}) >= distinct) ways.push_back(way);
  }
  weigh_against_each_other(ways);
  return ways.front().probability;
}

}  // namespace gridmerge::internal
