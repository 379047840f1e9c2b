// SPDX-License-Identifier: Apache-2.0
#include "merge/group_search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "grid/parallel.hpp"
#include "merge/disjoint_sets.hpp"

namespace gridmerge::internal {

namespace {

/// A map that moves elsewhere must gain so much, or rounding would keep it moving [nats].
constexpr double kMinGain = 0.1;
/// A map may gain by a move, and lose it again when poses settle or its old group falls apart. So it may go
/// back and forth, but not for ever.
constexpr int kMostMoves = 2;
/// From a little more on, a probability is 1 to rounding [nats].
constexpr double kSurely = 36.0;

/// The groups of one connected part while they are arranged. A group has a number that grows with time: of
/// two that are joined the lower one stays, and what is cut off gets new ones.
class Arranger {
 public:
  using Number = std::size_t;

  Arranger(const JoinWeights& weights, double accept_probability, NodeGroups groups)
      : weights_(weights),
        accept_(accept_probability),
        min_worth_(std::min(kSurely, std::log(accept_probability / (1.0 - accept_probability)) - 1e-9)),
        group_of_(weights.maps()) {
    for (NodeGroup& group : groups) add(std::move(group));
  }

  NodeGroups settle() {
    join_all();
    while (move_one()) join_all();
    NodeGroups all;
    for (auto& [number, group] : groups_) all.push_back(std::move(group));
    return all;
  }

 private:
  using Sides = std::pair<Number, Number>;  // ascending

  void add(NodeGroup group) { set(next_++, std::move(group)); }

  void set(Number number, NodeGroup group) {
    for (const PlacedNode& node : group) group_of_[node.map] = number;
    groups_[number] = std::move(group);
    changed_.insert(number);
  }

  /// The group is no more, or no more what it was: what was found out about it is void.
  void remove(Number number) {
    forget(number);
    groups_.erase(number);
    changed_.erase(number);
  }

  void forget(Number number) {
    for (const Number other : near_[number]) {
      const Sides sides = std::minmax(number, other);
      if (const auto join = joins_.find(sides); join != joins_.end()) {
        best_.erase(key_of(sides, *join));
        joins_.erase(join);
      }
      near_[other].erase(number);
    }
    near_.erase(number);
    for (const PlacedNode& node : groups_.at(number)) {
      gains_.erase(node.map);
      for (const std::size_t map : weights_.partners_of(node.map)) gains_.erase(map);
    }
  }

  /// The groups to which a pair proposes a way.
  std::set<Number> groups_near(const NodeGroup& group) const {
    std::set<Number> near;
    for (const PlacedNode& node : group) {
      for (const std::size_t map : weights_.partners_of(node.map)) near.insert(group_of_[map]);
    }
    return near;
  }

  /// Most is said for the first one; the order of the groups decides between equals.
  using Best = std::tuple<double, Number, Number>;
  static Best key_of(const Sides& sides, const std::pair<const Sides, WeighedJoin>& join) {
    return {-join.second.worth.against_apart, sides.first, sides.second};
  }

  /// Weighs the joins of the groups that have changed.
  void weigh_joins() {
    std::set<Sides> due;
    for (const Number number : changed_) {
      for (const Number other : groups_near(groups_.at(number))) {
        if (other != number) due.insert(std::minmax(number, other));
      }
    }
    changed_.clear();
    const std::vector<Sides> all(due.begin(), due.end());
    std::vector<std::optional<WeighedJoin>> found(all.size());
    parallel_for(all.size(), [&](std::size_t i) {
      found[i] = weights_.best_join(groups_.at(all[i].first), groups_.at(all[i].second), min_worth_);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!found[i] || found[i]->probability < accept_) continue;
      const auto& join = *joins_.emplace(all[i], *found[i]).first;
      best_.insert(key_of(all[i], join));
      near_[all[i].first].insert(all[i].second);
      near_[all[i].second].insert(all[i].first);
    }
  }

  /// Joins the two groups that belong together most surely, until none do surely enough.
  void join_all() {
    while (true) {
      weigh_joins();
      if (best_.empty()) return;
      const auto [worth, a, b] = *best_.begin();
      join(a, b, joins_.at({a, b}).T_a_b);
    }
  }

  void join(Number a, Number b, SE2 T_a_b) {
    NodeGroup joined = groups_.at(a);
    for (const PlacedNode& node : groups_.at(b)) joined.push_back({node.map, T_a_b * node.T_group_map});
    remove(a);
    remove(b);
    set(a, weights_.adjusted(std::move(joined)));
  }

  /// Takes out the map that gains most by lying elsewhere, or alone, and puts it there; false if none gains
  /// that has moves left.
  bool move_one() {
    weigh_moves();
    double most = kMinGain;
    std::optional<std::pair<Number, std::size_t>> which;  // group, place in it
    for (const auto& [number, group] : groups_) {
      if (group.size() < 2) continue;
      for (std::size_t i = 0; i < group.size(); ++i) {
        const auto gain = gains_.find(group[i].map);
        if (gain == gains_.end() || gain->second <= most || moves_[group[i].map] == kMostMoves) continue;
        most = gain->second;
        which = {number, i};
      }
    }
    if (!which) return false;
    const auto [rest, alone] = taken_out(groups_.at(which->first), which->second);
    ++moves_[alone.front().map];
    remove(which->first);
    for (NodeGroup& part : weights_.connected(rest)) add(std::move(part));
    place_best(alone);
    return true;
  }

  void weigh_moves() {
    std::vector<std::pair<Number, std::size_t>> due;
    for (const auto& [number, group] : groups_) {
      for (std::size_t i = 0; group.size() > 1 && i < group.size(); ++i) {
        if (!weights_.is_fixed(group[i].map) && !gains_.contains(group[i].map)) due.emplace_back(number, i);
      }
    }
    std::vector<double> gains(due.size());
    parallel_for(due.size(), [&](std::size_t i) { gains[i] = gain_of_moving(due[i].first, due[i].second); });
    for (std::size_t i = 0; i < due.size(); ++i)
      gains_[groups_.at(due[i].first)[due[i].second].map] = gains[i];
  }

  /// Exact where it is more than a move has to gain.
  double gain_of_moving(Number number, std::size_t place) const {
    const auto [rest, alone] = taken_out(groups_.at(number), place);
    const double stays = weights_.worth_of(rest, alone, {}).against_apart;
    std::vector<const NodeGroup*> others{&rest};
    for (const Number other : groups_near(alone)) {
      if (other != number) others.push_back(&groups_.at(other));
    }
    double elsewhere = 0.0;  // apart
    for (const NodeGroup* other : others) {
      // What gains too little for a move need not be known.
      const std::optional<WeighedJoin> way =
          weights_.best_way(*other, alone, std::max(elsewhere, stays + kMinGain));
      if (way) elsewhere = std::max(elsewhere, way->worth.against_apart);
    }
    return elsewhere - stays;
  }

  /// Joins a map where it is worth most, if it is worth anything.
  void place_best(const NodeGroup& alone) {
    double most = 0.0;
    std::optional<Number> where;
    SE2 T_where_alone;
    for (const Number number : groups_near(alone)) {
      const std::optional<WeighedJoin> join = weights_.best_way(groups_.at(number), alone, most);
      if (!join || join->worth.against_apart <= most) continue;
      most = join->worth.against_apart;
      where = number;
      T_where_alone = join->T_a_b;
    }
    const Number last = next_;
    add(alone);
    if (where) join(*where, last, T_where_alone);
  }

  const JoinWeights& weights_;
  double accept_;
  double min_worth_;  // a way of less worth is not so probable, whatever the others are [nats]
  Number next_ = 0;
  std::map<Number, NodeGroup> groups_;
  std::vector<Number> group_of_;             // by map
  std::set<Number> changed_;                 // groups whose joins are not weighed
  std::map<Sides, WeighedJoin> joins_;       // that are sure enough
  std::set<Best> best_;                      // the same
  std::map<Number, std::set<Number>> near_;  // the groups of each group's joins
  std::map<std::size_t, double> gains_;      // of moving a map
  std::map<std::size_t, int> moves_;         // of a map, so far
};

/// Maps that candidates or being fixed connect, each part ascending: first that of the lowest map.
std::vector<std::vector<std::size_t>> connected_maps(const JoinProblem& problem, const JoinWeights& weights) {
  DisjointSets maps(problem.maps.size());
  for (const PairCandidates& pair : problem.pairs) {
    if (!pair.candidates.empty()) maps.unite(pair.fixed, pair.moving);
  }
  std::optional<std::size_t> fixed;
  for (std::size_t map = 0; map < problem.maps.size(); ++map) {
    if (!weights.is_fixed(map)) continue;
    if (fixed) maps.unite(*fixed, map);
    fixed = map;
  }
  return maps.all();
}

}  // namespace

GroupSearch::GroupSearch(const JoinWeights& weights, const JoinProblem& problem, double accept_probability) {
  const std::vector<std::vector<std::size_t>> parts = connected_maps(problem, weights);
  parts_.resize(parts.size());
  parallel_for(parts.size(), [&](std::size_t i) {
    NodeGroups groups;
    NodeGroup fixed;
    for (const std::size_t map : parts[i]) {
      if (weights.is_fixed(map)) {
        fixed.push_back({map, *problem.maps[map].T_world_map});
      } else {
        groups.push_back({PlacedNode{map, {}}});
      }
    }
    if (!fixed.empty()) groups.push_back(std::move(fixed));
    parts_[i] = groups.size() == 1 ? std::move(groups)
                                   : Arranger(weights, accept_probability, std::move(groups)).settle();
  });
}

NodeGroups GroupSearch::groups() const {
  NodeGroups all;
  for (const NodeGroups& part : parts_) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace gridmerge::internal
