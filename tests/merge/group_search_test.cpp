// SPDX-License-Identifier: Apache-2.0
// The search of maps in groups beside a literal one, which weighs every two groups in every round.
#include "merge/group_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>

#include "grid/parallel.hpp"
#include "merge/consistent_set.hpp"
#include "merge/group_cuts.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {
namespace {

/// A map that moves elsewhere must gain so much, or rounding would keep it moving [nats].
constexpr double kMinGain = 0.1;
constexpr int kMostMoves = 2;

/// Weighs all groups against each other in every round.
class LiteralArranger {
 public:
  LiteralArranger(const JoinProblem& problem, double accept_probability, double keep_probability)
      : weights_(problem), accept_(accept_probability), keep_(keep_probability) {
    NodeGroup fixed;
    for (std::size_t map = 0; map < problem.maps.size(); ++map) {
      if (weights_.is_fixed(map)) {
        fixed.push_back({map, *problem.maps[map].T_world_map});
      } else {
        groups_.push_back({PlacedNode{map, {}}});
      }
    }
    if (!fixed.empty()) groups_.push_back(std::move(fixed));
  }

  NodeGroups settle() {
    join_all();
    while (move_one()) join_all();
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
        if (weights_.is_fixed(groups_[g][i].map) || moves_[groups_[g][i].map] == kMostMoves) continue;
        const double gain = gain_of_moving(g, i);
        if (gain <= most) continue;
        most = gain;
        which = {g, i};
      }
    }
    if (!which) return false;
    const auto [rest, alone] = taken_out(groups_[which->first], which->second);
    ++moves_[alone.front().map];
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
      const std::optional<WeighedJoin> join = best_way_of(groups_[g], groups_[alone]);
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

  /// The way for which most is said, two single maps weighed as groups are: so is what a map leaves.
  std::optional<WeighedJoin> best_way_of(const NodeGroup& a, const NodeGroup& b) {
    if (a.size() > 1 || b.size() > 1) return best_join_of(a, b);
    const std::vector<WeighedJoin> ways = weights_.ways_by_worth(a, b);
    const auto most =
        std::max_element(ways.begin(), ways.end(), [](const WeighedJoin& x, const WeighedJoin& y) {
          return x.worth.against_other_poses < y.worth.against_other_poses;
        });
    return most == ways.end() ? std::nullopt : std::optional(*most);
  }

  /// Beside being apart.
  double gain_of_joining(const NodeGroup& a, const NodeGroup& b) {
    const std::optional<WeighedJoin> way = best_way_of(a, b);
    return way ? way->worth.against_apart : 0.0;
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
  std::set<Key> sure_;                // groups that need no cut
  std::map<std::size_t, int> moves_;  // of a map
};

/// Maps of several places, of which pairs speak truly, falsely, weakly or not at all.
JoinProblem drawn(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const std::size_t maps = 6 + random() % 14;
  JoinProblem problem;
  std::vector<SE2> T_world_map;
  std::vector<std::size_t> place;
  for (std::size_t i = 0; i < maps; ++i) {
    problem.maps.push_back(
        {{{uniform(-3.0, 3.0), uniform(-3.0, 3.0)}, uniform(6.0, 12.0), uniform(20.0, 30.0)}});
    T_world_map.push_back({uniform(-30.0, 30.0), uniform(-30.0, 30.0), uniform(-3.0, 3.0)});
    place.push_back(random() % 3);
    if (seed % 4 == 0 && random() % 5 == 0) problem.maps.back().T_world_map = T_world_map.back();
  }
  for (std::size_t a = 0; a < maps; ++a) {
    for (std::size_t b = a + 1; b < maps; ++b) {
      if (seed % 3 == 0 && random() % 2 == 0) continue;  // nobody looked
      PairCandidates pair{a, b, {}};
      const SE2 T = inverse(T_world_map[a]) * T_world_map[b];
      if (place[a] == place[b] && random() % 3 != 0)
        pair.candidates.push_back(
            {T * SE2{uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.01, 0.01)}, uniform(-3.0, 8.0), 0.2});
      while (random() % 3 == 0)
        pair.candidates.push_back(
            {{uniform(-30.0, 30.0), uniform(-30.0, 30.0), uniform(-3.0, 3.0)}, uniform(-8.0, 5.0), 0.2});
      problem.pairs.push_back(std::move(pair));
    }
  }
  return problem;
}

NodeGroups sorted(NodeGroups groups) {
  std::sort(groups.begin(), groups.end(), [](const NodeGroup& a, const NodeGroup& b) {
    const auto lowest = [](const NodeGroup& group) {
      return std::min_element(group.begin(), group.end(),
                              [](const PlacedNode& x, const PlacedNode& y) { return x.map < y.map; })
          ->map;
    };
    return lowest(a) < lowest(b);
  });
  return groups;
}

TEST(GroupSearch, IsThatOfTheLiteralOneToTheBit) {
  std::size_t joined = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const JoinProblem problem = drawn(seed);
    const double keep = seed % 2 == 0 ? 0.8 : 0.97;
    const JoinWeights weights(problem);
    GroupCuts cuts(weights, GroupSearch(weights, problem, 0.8).groups());
    cuts.cut_below(keep);
    const NodeGroups found = sorted(cuts.groups());
    const NodeGroups expected = sorted(LiteralArranger(problem, 0.8, keep).settle());
    ASSERT_EQ(found.size(), expected.size()) << seed;
    for (std::size_t g = 0; g < found.size(); ++g) {
      ASSERT_EQ(found[g].size(), expected[g].size()) << seed;
      joined += found[g].size() - 1;
      for (std::size_t i = 0; i < found[g].size(); ++i) {
        EXPECT_EQ(found[g][i].map, expected[g][i].map) << seed;
        EXPECT_EQ(found[g][i].T_group_map, expected[g][i].T_group_map) << seed;
      }
    }
  }
  EXPECT_GT(joined, 100u);
}

/// The maps of a problem in two groups, as they lie in the world or nearly so.
std::pair<NodeGroup, NodeGroup> two_groups(const JoinProblem& problem, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-30.0, 30.0);
  std::pair<NodeGroup, NodeGroup> groups;
  for (std::size_t map = 0; map < problem.maps.size(); ++map) {
    const SE2 pose{uniform(random), uniform(random), uniform(random) / 10.0};
    (map % 2 == 0 ? groups.first : groups.second).push_back({map, pose});
  }
  return groups;
}

TEST(JoinWeights, NoCandidateProposesABetterWayThanTheBest) {
  std::size_t compared = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const JoinProblem problem = drawn(seed);
    const JoinWeights weights(problem);
    std::mt19937 random(seed);
    const auto [a, b] = two_groups(problem, random);
    const std::vector<WeighedJoin> ways = weights.ways_to_join(a, b);
    const std::optional<WeighedJoin> best = weights.best_join(a, b);
    ASSERT_EQ(best.has_value(), !ways.empty());
    for (const PairCandidates& pair : problem.pairs) {
      const auto in_a = std::find_if(a.begin(), a.end(), [&](const PlacedNode& node) {
        return node.map == pair.fixed || node.map == pair.moving;
      });
      const auto in_b = std::find_if(b.begin(), b.end(), [&](const PlacedNode& node) {
        return node.map == pair.fixed || node.map == pair.moving;
      });
      if (in_a == a.end() || in_b == b.end()) continue;  // of one group
      for (const CandidateJoin& candidate : pair.candidates) {
        if (candidate.log_odds < -6.0) continue;  // proposes nothing
        const SE2 T = pair.fixed == in_a->map ? candidate.T_fixed_moving : inverse(candidate.T_fixed_moving);
        const SE2 T_a_b = in_a->T_group_map * T * inverse(in_b->T_group_map);
        const double worth = weights.worth_of(a, b, T_a_b).against_other_poses;
        if (worth <= best->worth.against_other_poses) continue;
        // Then it is left out for one beside it with which more pairs agree.
        double nearest = 1e9;
        for (const WeighedJoin& way : ways)
          nearest = std::min(nearest, std::hypot(way.T_a_b.x - T_a_b.x, way.T_a_b.y - T_a_b.y));
        EXPECT_LT(nearest, 10.0) << seed;
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 500u);
}

TEST(JoinWeights, TheBestWayIsTheFirstOfAll) {
  std::size_t found = 0, left_out = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const JoinProblem problem = drawn(seed);
    const JoinWeights weights(problem);
    std::mt19937 random(seed);
    const auto [a, b] = two_groups(problem, random);
    const std::vector<WeighedJoin> ways = weights.ways_to_join(a, b);
    const std::optional<WeighedJoin> best = weights.best_join(a, b), way = weights.best_way(a, b);
    ASSERT_EQ(best.has_value(), !ways.empty());
    ASSERT_EQ(way.has_value(), !ways.empty());
    if (ways.empty()) continue;
    EXPECT_EQ(best->T_a_b, ways.front().T_a_b);
    EXPECT_EQ(best->probability, ways.front().probability);
    EXPECT_EQ(way->T_a_b, ways.front().T_a_b);
    const double worth = way->worth.against_apart;
    EXPECT_EQ(worth, weights.worth_of(a, b, way->T_a_b).against_apart);  // as of what a map would leave
    for (const double least : {worth - 1.0, worth + 1.0, worth + 10.0, 100.0}) {
      const std::optional<WeighedJoin> above = weights.best_way(a, b, least);
      EXPECT_EQ(above.has_value(), weights.best_join(a, b, least).has_value());
      EXPECT_TRUE(!above || above->T_a_b == way->T_a_b);
      EXPECT_TRUE(above || least >= worth);
      ++(above ? found : left_out);
    }
  }
  EXPECT_GT(found, 50u);
  EXPECT_GT(left_out, 60u);
}

}  // namespace
}  // namespace gridmerge::internal
