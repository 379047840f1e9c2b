// SPDX-License-Identifier: Apache-2.0
#include "merge/join_weights.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "merge/pose_graph.hpp"

namespace gridmerge::internal {

namespace {

/// No single pair says more than this about two maps: their errors have causes in common with other pairs'.
constexpr double kMaxLogOdds = 6.0;
/// Where the strongest pair has spoken, the second counts by so much, the third by the square of that...
constexpr double kDependence = 0.3;
/// A pair of whose places a share is fresh speaks of them with this power of the share: what borders on known
/// places is not independent of them either.
constexpr double kFreshPower = 2.0;
/// What a miss says at most, and the shares in common at which it begins to count, and counts in full. Of
/// simulated pairs that have less than a tenth in common the true pose is hardly ever among the candidates,
/// of those with a quarter in two of three cases, and from a half on in 97 of 100.
constexpr double kMissNats = 3.3;
constexpr double kMissFrom = 0.12;
constexpr double kMissWhole = 0.45;

/// Of a pose with which no candidate of a pair agrees: less than any loss.
constexpr double kNone = -std::numeric_limits<double>::infinity();

/// What several losses come to: they have causes in common, as the gains do.
double sum_of_dependent(std::vector<double> losses) {
  std::sort(losses.begin(), losses.end());
  double sum = 0.0, weight = 1.0;
  for (const double loss : losses) {
    sum += weight * loss;
    weight *= kDependence;
  }
  return sum;
}

/// A pair across two groups that speaks for joining them.
struct Witness {
  double worth;
  double against_alike;  // the same against two places that look alike: there poses agree, too. Not negative
  std::vector<Point2> places;  // of which it speaks [m, frame of the first group]
  bool is_known;               // by the given poses of these maps of the two groups
  std::size_t map_a, map_b;
  bool repeats = false;
};

/// Takes out witnesses that repeat a given pose. It is one statement, of however many pairs, and the pair
/// that doubts it most tells its worth. Of equal ones the maps decide, whichever group is called the first.
void hear_given_poses_once(std::vector<Witness>& witnesses) {
  std::vector<Witness*> known;
  for (Witness& witness : witnesses) {
    if (witness.is_known) known.push_back(&witness);
  }
  const auto maps = [](const Witness& witness) {
    return std::pair(std::min(witness.map_a, witness.map_b), std::max(witness.map_a, witness.map_b));
  };
  std::sort(known.begin(), known.end(), [&](const Witness* x, const Witness* y) {
    return std::pair(x->worth, maps(*x)) < std::pair(y->worth, maps(*y));
  });
  std::set<std::size_t> spoken;
  for (Witness* const witness : known) {
    witness->repeats = spoken.contains(witness->map_a) || spoken.contains(witness->map_b);
    if (!witness->repeats) spoken.insert({witness->map_a, witness->map_b});
  }
  std::erase_if(witnesses, [](const Witness& witness) { return witness.repeats; });
}

/// What speaks for a case against two others together, if so much speaks for it against each of them [nats].
double against_both(double x, double y) {
  return std::min(x, y) - std::log1p(std::exp(-std::abs(x - y)));
}

/// The places of which pairs have spoken, in cells wide enough that none that has been is missed by chance.
class SpokenOf {
 public:
  /// The share of the places that are new; 1 if there are none to tell by.
  double add(const std::vector<Point2>& places) {
    std::vector<Place> cells;
    cells.reserve(places.size());
    for (const Point2& at : places) cells.emplace_back(std::floor(at.x / kSide), std::floor(at.y / kSide));
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    std::vector<Place> fresh, all;
    std::set_difference(cells.begin(), cells.end(), spoken_of_.begin(), spoken_of_.end(),
                        std::back_inserter(fresh));
    std::merge(spoken_of_.begin(), spoken_of_.end(), fresh.begin(), fresh.end(), std::back_inserter(all));
    spoken_of_ = std::move(all);
    return cells.empty() ? 1.0 : static_cast<double>(fresh.size()) / static_cast<double>(cells.size());
  }

 private:
  using Place = std::pair<double, double>;  // whole numbers, which may be larger than integers hold
  static constexpr double kSide = 4.0;      // [m]
  std::vector<Place> spoken_of_;            // ascending
};

}  // namespace

double nats_of_a_miss(double share_in_common) {
  return kMissNats * std::clamp((share_in_common - kMissFrom) / (kMissWhole - kMissFrom), 0.0, 1.0);
}

JoinWeights::JoinWeights(const JoinProblem& problem) : problem_(problem), partners_(problem.maps.size()) {
  marks_.reserve(problem.pairs.size());
  for (std::size_t i = 0; i < problem.pairs.size(); ++i) {
    const PairCandidates& pair = problem.pairs[i];
    partners_[pair.fixed].push_back({pair.moving, i});
    partners_[pair.moving].push_back({pair.fixed, i});
    std::vector<Mark>& marks = marks_.emplace_back();
    for (const CandidateJoin& candidate : pair.candidates)
      marks.push_back(mark_of(ManyPointsTransform(candidate.T_fixed_moving), problem.maps[pair.fixed].extent,
                              problem.maps[pair.moving].extent));
  }
  for (std::vector<Partner>& partners : partners_)
    std::sort(partners.begin(), partners.end(),
              [](const Partner& a, const Partner& b) { return a.map < b.map; });
}

std::vector<std::size_t> JoinWeights::partners_of(std::size_t map) const {
  std::vector<std::size_t> others;
  for (const Partner& partner : partners_[map]) {
    if (!problem_.pairs[partner.pair].candidates.empty()) others.push_back(partner.map);
  }
  return others;
}

JoinWeights::Mark JoinWeights::mark_of(const ManyPointsTransform& T_fixed_moving, const MapExtent& fixed,
                                       const MapExtent& moving) {
  return {T_fixed_moving * moving.centre, T_fixed_moving.inverse() * fixed.centre, T_fixed_moving.cos(),
          T_fixed_moving.sin()};
}

std::vector<ManyPointsTransform> JoinWeights::poses_of(const NodeGroup& group) {
  std::vector<ManyPointsTransform> poses;
  poses.reserve(group.size());
  for (const PlacedNode& node : group) poses.emplace_back(node.T_group_map);
  return poses;
}

std::optional<std::size_t> JoinWeights::pair_of(std::size_t a, std::size_t b) const {
  const std::vector<Partner>& partners = partners_[a];
  const auto found =
      std::lower_bound(partners.begin(), partners.end(), b,
                       [](const Partner& partner, std::size_t map) { return partner.map < map; });
  return found == partners.end() || found->map != b ? std::nullopt : std::optional(found->pair);
}

std::vector<JoinWeights::Across> JoinWeights::pairs_across(const NodeGroup& a, const NodeGroup& b) const {
  const bool from_a = a.size() <= b.size();
  const NodeGroup &few = from_a ? a : b, &many = from_a ? b : a;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // of the larger group: map and place
  for (std::size_t i = 0; i < many.size(); ++i) places.emplace_back(many[i].map, i);
  std::sort(places.begin(), places.end());
  std::vector<Across> across;
  for (std::size_t i = 0; i < few.size(); ++i) {
    for (const Partner& partner : partners_[few[i].map]) {
      if (marks_[partner.pair].empty()) continue;
      const auto place =
          std::lower_bound(places.begin(), places.end(), std::pair(partner.map, std::size_t{0}));
      if (place == places.end() || place->first != partner.map) continue;
      across.push_back(from_a ? Across{i, place->second, partner.pair}
                              : Across{place->second, i, partner.pair});
    }
  }
  std::sort(across.begin(), across.end(),
            [](const Across& x, const Across& y) { return std::pair(x.a, x.b) < std::pair(y.a, y.b); });
  return across;
}

std::optional<JoinWeights::Agreement> JoinWeights::find_agreement(std::size_t index, std::size_t a,
                                                                  const ManyPointsTransform& T_a_b) const {
  const PairCandidates& pair = problem_.pairs[index];
  const ManyPointsTransform T = pair.fixed == a ? T_a_b : T_a_b.inverse();
  const MapExtent& fixed = problem_.maps[pair.fixed].extent;
  const MapExtent& moving = problem_.maps[pair.moving].extent;
  // As difference() to each candidate, without a sine or cosine for each.
  const Mark here = mark_of(T, fixed, moving);
  const double tolerance = agreement_tolerance(fixed, moving);
  const std::vector<Mark>& marks = marks_[index];
  std::optional<Agreement> best;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double turned = 2.0 * (1.0 - here.cos * marks[i].cos - here.sin * marks[i].sin);
    const auto squared = [&](const Point2& p, const Point2& q, double radius) {
      return (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y) + turned * radius * radius;
    };
    const double off = std::min(squared(here.moving_centre, marks[i].moving_centre, moving.radius),
                                squared(here.fixed_centre, marks[i].fixed_centre, fixed.radius));
    const double log_odds = pair.candidates[i].log_odds;
    if (!(off <= tolerance * tolerance) || (best && log_odds <= pair.candidates[best->candidate].log_odds))
      continue;
    best = Agreement{index, i, std::min(log_odds, kMaxLogOdds) + kPoseNats};
  }
  return best;
}

JoinWorth JoinWeights::worth_of(const NodeGroup& a, const NodeGroup& b, const SE2& T_a_b) const {
  std::vector<double> losses, doubts;  // against being unrelated, and against two places that look alike
  std::vector<Witness> witnesses;
  std::vector<ManyPointsTransform> poses_b = poses_of(b);  // in the frame of a
  const ManyPointsTransform from_b(T_a_b);
  for (ManyPointsTransform& pose : poses_b) pose = from_b * pose;
  for (const PlacedNode& in_a : a) {
    const ManyPointsTransform T_a_map(in_a.T_group_map), T_map_a = T_a_map.inverse();
    const Coverage* of_a = problem_.maps[in_a.map].coverage;
    for (std::size_t i = 0; i < b.size(); ++i) {
      const std::optional<std::size_t> pair = pair_of(in_a.map, b[i].map);
      if (!pair) continue;  // nobody has looked at it: it says nothing, for or against
      const ManyPointsTransform T = T_map_a * poses_b[i];
      const std::optional<Agreement> agreement = find_agreement(*pair, in_a.map, T);
      const Coverage* of_b = problem_.maps[b[i].map].coverage;
      const bool know_coverage = of_a != nullptr && of_b != nullptr;
      const double worth = agreement ? agreement->worth : kNone;
      // What is known beforehand is of this place and no other.
      const bool is_known = agreement && problem_.pairs[*pair].candidates[agreement->candidate].is_known;
      const double against_alike = is_known ? worth : worth - kPoseNats;
      if (against_alike < 0.0) {
        const double loss = -nats_of_a_miss(know_coverage ? of_a->share_in_common(*of_b, T) : 0.0);
        if (worth <= 0.0) losses.push_back(std::max(loss, worth));
        if (against_alike != kSaysNothing) doubts.push_back(std::max(loss, against_alike));
      }
      if (worth > 0.0) {
        witnesses.push_back({worth, std::max(0.0, against_alike), {}, is_known, in_a.map, b[i].map});
        if (know_coverage) witnesses.back().places = of_a->places_in_common(*of_b, T, T_a_map);
      }
    }
  }
  hear_given_poses_once(witnesses);
  std::stable_sort(witnesses.begin(), witnesses.end(),
                   [](const Witness& x, const Witness& y) { return x.worth > y.worth; });
  const double lost = sum_of_dependent(std::move(losses)) - kPoseNats;
  JoinWorth worth{lost, lost};
  double against_alike = sum_of_dependent(std::move(doubts)) + kAlikeNats;
  SpokenOf spoken_of;
  double dependence = 1.0;
  for (const Witness& witness : witnesses) {
    const double fresh = std::pow(spoken_of.add(witness.places), kFreshPower);
    worth.against_apart += fresh * witness.worth;
    worth.against_other_poses += (fresh + (1.0 - fresh) * dependence) * witness.worth;
    against_alike += fresh * witness.against_alike;
    dependence *= kDependence;
  }
  if (problem_.may_look_alike()) worth.against_apart = against_both(worth.against_apart, against_alike);
  return worth;
}

std::vector<JoinWeights::Edge> JoinWeights::edges_of(const NodeGroup& group) const {
  const std::vector<ManyPointsTransform> poses = poses_of(group);
  std::vector<Edge> edges;
  for (const Across& pair : pairs_across(group, group)) {
    if (pair.a >= pair.b) continue;
    const ManyPointsTransform T_a_b = poses[pair.a].inverse() * poses[pair.b];
    if (const auto agreement = find_agreement(pair.pair, group[pair.a].map, T_a_b))
      edges.push_back({pair.a, pair.b, *agreement});
  }
  return edges;
}

std::vector<UsedCandidate> JoinWeights::used_in(const NodeGroup& group) const {
  std::vector<UsedCandidate> used;
  for (const Edge& edge : edges_of(group)) used.push_back({edge.agreement.pair, edge.agreement.candidate});
  return used;
}

void JoinWeights::unite_fixed(const NodeGroup& group, DisjointSets& places) const {
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (!is_fixed(group[i].map)) continue;
    if (first) places.unite(*first, i);
    first = i;
  }
}

NodeGroups JoinWeights::connected(const NodeGroup& group) const {
  DisjointSets places(group.size());
  for (const Edge& edge : edges_of(group)) places.unite(edge.a, edge.b);
  unite_fixed(group, places);
  NodeGroups parts;
  for (const std::vector<std::size_t>& held_together : places.all()) {
    NodeGroup& part = parts.emplace_back();
    for (const std::size_t place : held_together) part.push_back(group[place]);
  }
  return parts;
}

std::vector<std::pair<NodeGroup, NodeGroup>> JoinWeights::halves(const NodeGroup& group) const {
  std::vector<Edge> edges = edges_of(group);
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& a, const Edge& b) { return a.agreement.worth > b.agreement.worth; });
  DisjointSets places(group.size());
  unite_fixed(group, places);
  std::vector<Edge> tree;
  for (const Edge& edge : edges) {
    if (places.are_one(edge.a, edge.b)) continue;
    places.unite(edge.a, edge.b);
    tree.push_back(edge);
  }
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> around(
      group.size());  // place, edge of the tree
  for (std::size_t i = 0; i < tree.size(); ++i) {
    around[tree[i].a].emplace_back(tree[i].b, i);
    around[tree[i].b].emplace_back(tree[i].a, i);
  }
  std::optional<std::size_t> fixed;  // fixed maps hold each other
  for (std::size_t i = 0; i < group.size(); ++i) {
    if (!is_fixed(group[i].map)) continue;
    if (fixed) {
      around[*fixed].emplace_back(i, tree.size());
      around[i].emplace_back(*fixed, tree.size());
    }
    fixed = i;
  }
  std::vector<std::pair<NodeGroup, NodeGroup>> all;
  for (std::size_t cut = 0; cut < tree.size(); ++cut) {
    std::vector<bool> is_first(group.size());
    std::vector<std::size_t> reached{tree[cut].a};
    is_first[tree[cut].a] = true;
    while (!reached.empty()) {
      const std::size_t from = reached.back();
      reached.pop_back();
      for (const auto& [place, edge] : around[from]) {
        if (edge == cut || is_first[place]) continue;
        is_first[place] = true;
        reached.push_back(place);
      }
    }
    std::pair<NodeGroup, NodeGroup> halves;
    for (std::size_t i = 0; i < group.size(); ++i)
      (is_first[i] ? halves.first : halves.second).push_back(group[i]);
    all.push_back(std::move(halves));
  }
  for (std::size_t i = 0; group.size() > 2 && i < group.size(); ++i) {
    // At an end of the tree it is cut off already.
    if (around[i].size() > 1 && !is_fixed(group[i].map)) all.push_back(taken_out(group, i));
  }
  return all;
}

NodeGroup JoinWeights::adjusted(NodeGroup group) const {
  if (group.size() < 3) return group;  // two maps lie as their candidate says
  const bool any_fixed =
      std::any_of(group.begin(), group.end(), [&](const PlacedNode& node) { return is_fixed(node.map); });
  std::vector<AdjustablePose> poses;
  for (std::size_t i = 0; i < group.size(); ++i)
    poses.push_back({group[i].T_group_map, problem_.maps[group[i].map].extent.centre,
                     any_fixed ? is_fixed(group[i].map) : i == 0});
  std::vector<RelativePose> measured;
  for (const Edge& edge : edges_of(group)) {
    const PairCandidates& pair = problem_.pairs[edge.agreement.pair];
    const bool in_order = pair.fixed == group[edge.a].map;
    const MapExtent &fixed = problem_.maps[pair.fixed].extent, &moving = problem_.maps[pair.moving].extent;
    measured.push_back(measured_between(in_order ? edge.a : edge.b, in_order ? edge.b : edge.a,
                                        pair.candidates[edge.agreement.candidate].T_fixed_moving, fixed,
                                        moving, agreement_tolerance(fixed, moving)));
  }
  const std::vector<SE2> adjusted = adjust_poses(poses, measured);
  for (std::size_t i = 0; i < group.size(); ++i) group[i].T_group_map = adjusted[i];
  return group;
}

std::pair<NodeGroup, NodeGroup> taken_out(const NodeGroup& group, std::size_t place) {
  NodeGroup rest = group;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(place));
  return {rest, {group[place]}};
}

}  // namespace gridmerge::internal
