// SPDX-License-Identifier: Apache-2.0
#include "merge/consistent_set.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "grid/parallel.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {

namespace {

/// A map that moves elsewhere must gain so much, or rounding would keep it moving [nats].
constexpr double kMinGain = 0.1;

/// Weighs groups against each other, and keeps what it has found until the groups change.
class Arranger {
 public:
  Arranger(const JoinProblem& problem, double accept_probability, double keep_probability)
      : weights_(problem), accept_(accept_probability), keep_(keep_probability) {
    NodeGroup fixed;
    for (std::size_t map = 0; map < problem.maps.size(); ++map) {
      if (weights_.is_fixed(map)) {
        fixed.push_back({map, *problem.fixed[map]});
      } else {
        groups_.push_back({PlacedNode{map, {}}});
      }
    }
    if (!fixed.empty()) groups_.push_back(std::move(fixed));
  }

  NodeGroups settle() {
    join_all();
    // Every move gains, so this ends; the bound is for consistent sets that are worth the same within
    // rounding.
    for (std::size_t moves = 0; moves < 4 * groups_.size() + 64 && move_one(); ++moves) join_all();
    while (cut_one()) {
    }
    return std::move(groups_);
  }

 private:
  /// Joins the two groups that belong together most surely, until none do surely enough.
  void join_all() {
    while (true) {
      std::vector<Sides> sides;
      for (std::size_t a = 0; a < groups_.size(); ++a) {
        for (std::size_t b = a + 1; b < groups_.size(); ++b) sides.emplace_back(groups_[a], groups_[b]);
      }
      weigh(sides);
      std::optional<std::pair<std::size_t, std::size_t>> best;
      WeighedJoin best_join;
      for (std::size_t a = 0; a < groups_.size(); ++a) {
        for (std::size_t b = a + 1; b < groups_.size(); ++b) {
          const std::optional<WeighedJoin>& join = best_join_of(groups_[a], groups_[b]);
          if (!join || join->probability < accept_) continue;
          if (best && join->worth.against_apart <= best_join.worth.against_apart) continue;
          best = {a, b};
          best_join = *join;
        }
      }
      if (!best) return;
      join(best->first, best->second, best_join.T_a_b);
    }
  }

  void join(std::size_t a, std::size_t b, const SE2& T_a_b) {
    NodeGroup joined = groups_[a];
    for (const PlacedNode& node : groups_[b]) joined.push_back({node.map, T_a_b * node.T_group_map});
    groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(b));
    groups_[a] = weights_.adjusted(std::move(joined));
  }

  /// Takes out the map that gains most by lying elsewhere, or alone, and puts it there; false if none gains.
  bool move_one() {
    weigh_moves();
    double most = kMinGain;
    std::optional<std::pair<std::size_t, std::size_t>> which;  // group, place in it
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].size() < 2) continue;
      for (std::size_t i = 0; i < groups_[g].size(); ++i) {
        if (weights_.is_fixed(groups_[g][i].map)) continue;
        const double gain = gain_of_moving(g, i);
        if (gain <= most) continue;
        most = gain;
        which = {g, i};
      }
    }
    if (!which) return false;
    const auto [rest, alone] = taken_out(groups_[which->first], which->second);
    groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(which->first));
    for (NodeGroup& part : weights_.connected(rest)) groups_.push_back(std::move(part));
    groups_.push_back(alone);
    place_best(groups_.size() - 1);
    return true;
  }

  /// Joins the group, which is one map, where it is worth most, if it is worth anything.
  void place_best(std::size_t alone) {
    double most = 0.0;
    std::optional<std::size_t> where;
    SE2 T_where_alone;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (g == alone) continue;
      const std::optional<WeighedJoin>& join = best_join_of(groups_[g], groups_[alone]);
      if (!join || join->worth.against_apart <= most) continue;
      most = join->worth.against_apart;
      where = g;
      T_where_alone = join->T_a_b;
    }
    if (where) join(*where, alone, T_where_alone);
  }

  double gain_of_moving(std::size_t group, std::size_t place) {
    const auto [rest, alone] = taken_out(groups_[group], place);
    const double stays = weights_.worth_of(rest, alone, {}).against_apart;
    double elsewhere = std::max(0.0, gain_of_joining(rest, alone));
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (g != group) elsewhere = std::max(elsewhere, gain_of_joining(groups_[g], alone));
    }
    return elsewhere - stays;
  }

  /// Beside being apart.
  double gain_of_joining(const NodeGroup& a, const NodeGroup& b) {
    const std::optional<WeighedJoin>& join = best_join_of(a, b);
    return join ? join->worth.against_apart : 0.0;
  }

  /// Cuts a group where its parts belong together least surely, if that is not surely enough, or where
  /// nothing holds them together.
  bool cut_one() {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].size() < 2 || sure_.contains(key_of(groups_[g]))) continue;
      NodeGroups parts = weights_.connected(groups_[g]);
      if (parts.size() == 1) parts = weakest_halves(groups_[g]);
      if (parts.size() == 1) {
        sure_.insert(key_of(groups_[g]));
        continue;
      }
      groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(g));
      for (NodeGroup& part : parts) groups_.push_back(weights_.adjusted(std::move(part)));
      return true;
    }
    return false;
  }

  /// The group itself if all its halves belong together surely enough.
  NodeGroups weakest_halves(const NodeGroup& group) const {
    const std::vector<std::pair<NodeGroup, NodeGroup>> halves = weights_.halves(group);
    std::vector<double> probabilities(halves.size());
    parallel_for(halves.size(), [&](std::size_t i) {
      probabilities[i] = weights_.probability_of_lying_so(halves[i].first, halves[i].second);
    });
    const auto least = std::min_element(probabilities.begin(), probabilities.end());
    if (least == probabilities.end() || *least >= keep_) return {group};
    const auto& weakest = halves[static_cast<std::size_t>(least - probabilities.begin())];
    return {weakest.first, weakest.second};
  }

  void weigh_moves() {
    std::vector<Sides> sides;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      for (std::size_t i = 0; groups_[g].size() > 1 && i < groups_[g].size(); ++i) {
        if (weights_.is_fixed(groups_[g][i].map)) continue;
        const auto [rest, alone] = taken_out(groups_[g], i);
        sides.emplace_back(rest, alone);
        for (std::size_t other = 0; other < groups_.size(); ++other) {
          if (other != g) sides.emplace_back(groups_[other], alone);
        }
      }
    }
    weigh(sides);
  }

  using Sides = std::pair<NodeGroup, NodeGroup>;

  /// Works out several joins at once, for best_join_of() to know them.
  void weigh(const std::vector<Sides>& all) {
    std::vector<const Sides*> unknown;
    std::vector<std::optional<WeighedJoin>*> results;
    for (const Sides& sides : all) {
      const auto [found, is_new] = weighed_.try_emplace({key_of(sides.first), key_of(sides.second)});
      if (!is_new) continue;
      unknown.push_back(&sides);
      results.push_back(&found->second);
    }
    parallel_for(unknown.size(), [&](std::size_t i) {
      *results[i] = weights_.best_join(unknown[i]->first, unknown[i]->second);
    });
  }

  /// Remembered by which maps the groups hold and where: groups change little from round to round.
  const std::optional<WeighedJoin>& best_join_of(const NodeGroup& a, const NodeGroup& b) {
    const auto [found, is_new] = weighed_.try_emplace({key_of(a), key_of(b)});
    if (is_new) found->second = weights_.best_join(a, b);
    return found->second;
  }

  using Key = std::vector<double>;
  static Key key_of(const NodeGroup& group) {
    Key key;
    for (const PlacedNode& node : group) {
      const SE2& T = node.T_group_map;
      key.insert(key.end(), {static_cast<double>(node.map), T.x, T.y, T.theta});
    }
    return key;
  }

  JoinWeights weights_;
  double accept_;  // from this probability on, groups are joined
  double keep_;    // and from this one on, they stay together
  NodeGroups groups_;
  std::map<std::pair<Key, Key>, std::optional<WeighedJoin>> weighed_;
  std::set<Key> sure_;  // groups that need no cut
};

void validate(const JoinProblem& problem, double accept_probability) {
  const std::size_t maps = problem.maps.size();
  if (!(accept_probability >= 0.0 && accept_probability <= 1.0))
    throw std::invalid_argument("accept_probability must lie in [0, 1]");
  if ((!problem.coverage.empty() && problem.coverage.size() != maps) || problem.fixed.size() > maps)
    throw std::invalid_argument("coverage and fixed poses must be those of the maps");
  for (const PairCandidates& pair : problem.pairs) {
    if (pair.fixed >= pair.moving || pair.moving >= maps)
      throw std::invalid_argument("a pair must be of two maps, the lower index first");
  }
}

/// In the frame of the lowest map, maps ascending.
NodeGroup in_order(NodeGroup group) {
  std::sort(group.begin(), group.end(),
            [](const PlacedNode& a, const PlacedNode& b) { return a.map < b.map; });
  const SE2 T_first_group = inverse(group.front().T_group_map);
  for (PlacedNode& node : group) node.T_group_map = T_first_group * node.T_group_map;
  group.front().T_group_map = {};
  return group;
}

ConsistentSet find_consistent_set(const JoinProblem& problem, double accept_probability,
                                  double keep_probability) {
  validate(problem, accept_probability);
  ConsistentSet consistent_set;
  for (NodeGroup& group : Arranger(problem, accept_probability, keep_probability).settle())
    consistent_set.groups.push_back(in_order(std::move(group)));
  std::sort(consistent_set.groups.begin(), consistent_set.groups.end(),
            [](const NodeGroup& a, const NodeGroup& b) { return a.front().map < b.front().map; });
  const JoinWeights weights(problem);
  for (NodeGroup& group : consistent_set.groups) {
    if (group.size() > 1) {
      for (std::size_t i = 0; i < group.size(); ++i) {
        if (weights.is_fixed(group[i].map)) continue;
        const auto [rest, alone] = taken_out(group, i);
        group[i].probability = weights.probability_of_lying_so(rest, alone);
      }
    }
    for (const UsedCandidate& used : weights.used_in(group)) consistent_set.used.push_back(used);
  }
  std::sort(consistent_set.used.begin(), consistent_set.used.end(),
            [](const UsedCandidate& a, const UsedCandidate& b) { return a.pair < b.pair; });
  return consistent_set;
}

}  // namespace

ConsistentSet find_consistent_set(const JoinProblem& problem, double accept_probability) {
  return find_consistent_set(problem, accept_probability, accept_probability);
}

std::vector<OpenJoin> find_open_joins(const JoinProblem& problem, const ConsistentSet& consistent_set,
                                      double least_probability) {
  validate(problem, least_probability);
  const JoinWeights weights(problem);
  const std::vector<NodeGroup>& groups = consistent_set.groups;
  std::vector<std::vector<OpenJoin>> of_first(groups.size());
  parallel_for(groups.size(), [&](std::size_t a) {
    for (std::size_t b = a + 1; b < groups.size(); ++b) {
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
    double doubt = 0.0;
    for (const PlacedNode& node : group) doubt += 1.0 - node.probability;  // 0 where it is fixed or alone
    // Every map is doubted given the others: two maps doubt one join twice.
    expected += doubt * static_cast<double>(group.size() - 1) / static_cast<double>(group.size());
  }
  return expected;
}

ConsistentSet find_consistent_set_within(const JoinProblem& problem, double accept_probability,
                                         double max_false_joins) {
  if (!(max_false_joins >= 0.0) || !std::isfinite(max_false_joins))
    throw std::invalid_argument("max_false_joins must be a number from 0 on");
  ConsistentSet consistent_set = find_consistent_set(problem, accept_probability);
  constexpr double kMinStep = 0.2;    // of the doubt that is still allowed, so that this ends
  constexpr double kMinDoubt = 1e-9;  // from there on nothing is surer
  double keep = accept_probability;
  while (expected_false_joins(consistent_set) > max_false_joins && 1.0 - keep > kMinDoubt) {
    double least = 1.0;
    for (const NodeGroup& group : consistent_set.groups) {
      for (const PlacedNode& node : group) least = std::min(least, node.probability);
    }
    keep = std::min(1.0, std::max(std::nextafter(least, 2.0), keep + kMinStep * (1.0 - keep)));
    consistent_set = find_consistent_set(problem, accept_probability, keep);
  }
  return consistent_set;
}

}  // namespace gridmerge::internal
