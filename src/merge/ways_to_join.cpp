// SPDX-License-Identifier: Apache-2.0
// The ways in which two groups of maps may lie, and how probable each is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "grid/logistic.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {

namespace {

/// One in so many sure matches of two of three or more maps is of a place that repeats, whatever they say.
constexpr double kRepeats = 0.005;

/// So many poses are weighed in full for two groups: those with which most pairs agree.
constexpr std::size_t kMaxProposals = 50;
/// A pose that must be worth so much less than another one is not weighed: all that are left out together
/// change no probability by more than 50 exp(-30), which is 5e-12 [nats].
constexpr double kNegligible = 30.0;
/// Candidates less likely than this propose no join, though they may agree with one.
constexpr double kMinLogOdds = -6.0;
/// Poses nearer to each other than this many tolerances are one way to join: the same candidate may agree
/// with both.
constexpr double kDistinct = 2.0;

MapExtent extent_of(const NodeGroup& group, const std::vector<ProblemMap>& maps) {
  MapExtent all;
  for (const PlacedNode& node : group) {
    const Point2 centre = node.T_group_map * maps[node.map].extent.centre;
    all.centre.x += centre.x / static_cast<double>(group.size());
    all.centre.y += centre.y / static_cast<double>(group.size());
    all.side = std::max(all.side, maps[node.map].extent.side);
  }
  double squares = 0.0;
  for (const PlacedNode& node : group) {
    const Point2 centre = node.T_group_map * maps[node.map].extent.centre;
    squares += std::pow(maps[node.map].extent.radius, 2) + std::pow(centre.x - all.centre.x, 2) +
               std::pow(centre.y - all.centre.y, 2);
  }
  all.radius = std::sqrt(squares / static_cast<double>(group.size()));
  return all;
}

bool is_worth_more(const WeighedJoin& x, const WeighedJoin& y) {
  return x.worth.against_other_poses > y.worth.against_other_poses;
}

/// The one for which most is said, the first of equals.
std::optional<WeighedJoin> first_of(const std::vector<WeighedJoin>& ways) {
  const auto first = std::min_element(ways.begin(), ways.end(), is_worth_more);
  return first == ways.end() ? std::nullopt : std::optional(*first);
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

/// The poses that candidates of pairs across the groups propose, those first that most pairs agree with:
/// weighing a pose in full takes a hundred times as long.
std::vector<JoinWeights::Proposal> JoinWeights::proposals(const NodeGroup& a, const NodeGroup& b) const {
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
  const std::vector<ManyPointsTransform> poses_a = poses_of(a), poses_b = poses_of(b);
  for (Proposal& proposal : all) {
    const ManyPointsTransform T_a_b(proposal.T_a_b);
    for (const Across& one : across) {
      const ManyPointsTransform T = poses_a[one.a].inverse() * T_a_b * poses_b[one.b];
      const auto agreement = find_agreement(one.pair, a[one.a].map, T);
      if (!agreement) continue;
      proposal.agreement += agreement->worth;
      proposal.most_worth += std::max(0.0, agreement->worth);
    }
    proposal.most_worth -= kPoseNats;  // as worth_of(), with every pair that agrees counted in full
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Proposal& x, const Proposal& y) { return x.agreement > y.agreement; });
  return all;
}

/// Two maps alone lie as their pair says, which has weighed all that there is.
std::vector<WeighedJoin> JoinWeights::ways_of_pair(const PlacedNode& a, const PlacedNode& b) const {
  const std::optional<std::size_t> index = pair_of(a.map, b.map);
  if (!index) return {};
  const PairCandidates& pair = problem_.pairs[*index];
  const auto probability = [&](const CandidateJoin& candidate) {
    const double p = logistic(candidate.log_odds);
    if (!problem_.may_look_alike() || candidate.is_known) return p;
    // As worth_of() weighs one pair against being unrelated, and against two places that look alike.
    const double odds = logistic(kAlikeNats) * p / (1.0 - p + kRepeats);
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

std::vector<WeighedJoin> JoinWeights::weigh_proposals(const NodeGroup& a, const NodeGroup& b, double margin,
                                                      double least) const {
  const std::vector<Proposal> all = proposals(a, b);
  if (std::none_of(all.begin(), all.end(), [&](const Proposal& one) { return one.most_worth > least; }))
    return {};
  const MapExtent of_a = extent_of(a, problem_.maps), of_b = extent_of(b, problem_.maps);
  const double distinct = kDistinct * agreement_tolerance(of_a, of_b);
  std::vector<WeighedJoin> ways;
  double most = -std::numeric_limits<double>::infinity();
  for (const Proposal& proposal : all) {
    if (proposal.most_worth < most - margin) continue;
    const bool is_new = std::none_of(ways.begin(), ways.end(), [&](const WeighedJoin& way) {
      return difference(of_a, of_b, proposal.T_a_b, way.T_a_b) < distinct;
    });
    if (!is_new) continue;
    ways.push_back({proposal.T_a_b, worth_of(a, b, proposal.T_a_b)});
    most = std::max(most, ways.back().worth.against_other_poses);
    if (ways.size() == kMaxProposals) break;
  }
  return ways;
}

std::vector<WeighedJoin> JoinWeights::ways_by_worth(const NodeGroup& a, const NodeGroup& b) const {
  std::vector<WeighedJoin> ways = weigh_proposals(a, b, kNegligible, kAny);
  weigh_against_each_other(ways);
  return ways;
}

std::vector<WeighedJoin> JoinWeights::ways_to_join(const NodeGroup& a, const NodeGroup& b) const {
  std::vector<WeighedJoin> ways =
      a.size() == 1 && b.size() == 1 ? ways_of_pair(a.front(), b.front()) : ways_by_worth(a, b);
  std::stable_sort(ways.begin(), ways.end(), is_worth_more);
  return ways;
}

std::optional<WeighedJoin> JoinWeights::best_join(const NodeGroup& a, const NodeGroup& b,
                                                  double least) const {
  if (a.size() == 1 && b.size() == 1) return first_of(ways_of_pair(a.front(), b.front()));
  std::vector<WeighedJoin> ways = weigh_proposals(a, b, kNegligible, least);
  weigh_against_each_other(ways);
  return first_of(ways);
}

std::optional<WeighedJoin> JoinWeights::best_way(const NodeGroup& a, const NodeGroup& b, double least) const {
  return first_of(weigh_proposals(a, b, 0.0, least));
}

double JoinWeights::probability_of_lying_so(const NodeGroup& a, const NodeGroup& b) const {
  const std::vector<WeighedJoin> all = ways_to_join(a, b);
  const MapExtent of_a = extent_of(a, problem_.maps), of_b = extent_of(b, problem_.maps);
  const double distinct = kDistinct * agreement_tolerance(of_a, of_b);
  if (a.size() == 1 && b.size() == 1) {
    const auto so = std::find_if(all.begin(), all.end(), [&](const WeighedJoin& way) {
      return difference(of_a, of_b, way.T_a_b, {}) < distinct;
    });
    return so == all.end() ? 0.0 : so->probability;
  }
  std::vector<WeighedJoin> ways{{{}, worth_of(a, b, {})}};
  for (const WeighedJoin& way : all) {
    if (difference(of_a, of_b, way.T_a_b, {}) >= distinct) ways.push_back(way);
  }
  weigh_against_each_other(ways);
  return ways.front().probability;
}

}  // namespace gridmerge::internal
