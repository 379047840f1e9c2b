// SPDX-License-Identifier: Apache-2.0
#include "merge/pair_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>

#include "grid/logistic.hpp"
#include "grid/parallel.hpp"
#include "merge/comparisons.hpp"
#include "merge/prior.hpp"
#include "preselect/compare.hpp"

namespace gridmerge::internal {

namespace {

/// Rounds go down to the wanted share in steps: what a round joins spares pairs in the next.
constexpr double kFirstShare = 0.3;
constexpr double kShareStep = 1.0 / 3.0;
/// A round takes no pair of two maps that both have so many in it.
constexpr std::size_t kMostOfAMap = 12;
/// A pair of two groups that belong together is hidden from the signatures, and from all other pairs of
/// theirs, the less likely the more pairs there are: each shows it in so many cases.
constexpr double kShownByAnother = 0.4;
constexpr double kMostOthers = 8.0;
/// Maps that the answer lays on each other by so much of the smaller one are looked at, or nobody would see
/// that they do not fit; of a map at most so many.
constexpr double kLaidShare = 0.12;
constexpr std::size_t kMostLaid = 16;

/// Bounds of the joins that were found by the joins that signatures expected.
constexpr double kLeastFound = 0.1;
constexpr double kMostFound = 3.0;
/// Of the share of joins that signatures show and that may be missed, the part for pairs that get no look,
/// and no second look.
constexpr double kForTheFirstLook = 0.8;
constexpr double kForTheSecondLook = 0.1;
constexpr double kForGroups = 0.1;

double damping(std::size_t size_a, std::size_t size_b) {
  const double others = static_cast<double>(size_a) * static_cast<double>(size_b) - 1.0;
  return std::pow(1.0 - kShownByAnother, std::min(others, kMostOthers));
}

/// Where the pair of the maps a < b stands among all pairs, in the order (0, 1), (0, 2), ...
std::size_t place_of_pair(std::size_t a, std::size_t b, std::size_t maps) {
  return a * maps - a * (a + 1) / 2 + (b - a - 1);
}

double sum_of(const std::vector<double>& weights) {
  double sum = 0.0;
  for (const double weight : weights) sum += weight;
  return sum;
}

}  // namespace

double PairChoice::order_by_weight(std::vector<Weighed>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const Weighed& x, const Weighed& y) {
    return std::tuple(-x.weight, x.a, x.b) < std::tuple(-y.weight, y.a, y.b);
  });
  return std::accumulate(pairs.rbegin(), pairs.rend(), 0.0,
                         [](double sum, const Weighed& one) { return sum + one.weight; });
}

PairChoice::PairChoice(double max_missed)
    : max_missed_(max_missed), max_shown_(std::max(0.0, max_missed - kHiddenShare)) {}

void PairChoice::forget(MapId id) {
  signatures_.erase(id);
  outdated_.erase(id);
  maps_.clear();
}

float PairChoice::log_odds(std::size_t a, std::size_t b) const {
  return log_odds_[place_of_pair(a, b, maps_.size())];
}

void PairChoice::prepare(const MapStore& store, const std::vector<MapId>& maps) {
  if (maps == maps_) return;
  std::vector<const std::unique_ptr<const Signature>*> signatures;
  std::vector<std::unique_ptr<const Signature>*> missing;
  std::vector<MapId> missing_ids;
  for (const MapId id : maps) {
    std::unique_ptr<const Signature>& signature = signatures_[id];
    signatures.push_back(&signature);
    if (signature) continue;
    missing.push_back(&signature);
    missing_ids.push_back(id);
    outdated_.erase(id);
  }
  parallel_for(missing.size(), [&](std::size_t i) {
    *missing[i] =
        std::make_unique<const Signature>(make_signature(store.at(missing_ids[i]).prepared.known()));
  });
  std::vector<const Signature*> all;  // the smaller map of a pair comes first, and moves
  all.reserve(maps.size());
  for (const std::unique_ptr<const Signature>* signature : signatures) all.push_back(signature->get());
  const bool is_any_outdated =
      std::any_of(maps.begin(), maps.end(), [&](MapId id) { return outdated_.contains(id); });
  log_odds_ = compare_all(all, is_any_outdated ? ComparisonStore{} : comparisons_,
                          [&] { return store.contents_of(maps); });
  shift_ = shift_to_this_set(log_odds_);
  maps_ = maps;
}

std::vector<std::size_t> PairChoice::group_sizes(const ConsistentSet& consistent_set,
                                                 std::vector<std::size_t>& group_of) const {
  std::vector<std::size_t> sizes(maps_.size(), 1);
  group_of.resize(maps_.size());
  for (std::size_t i = 0; i < maps_.size(); ++i) group_of[i] = maps_.size() + i;
  for (std::size_t g = 0; g < consistent_set.groups.size(); ++g) {
    for (const PlacedNode& node : consistent_set.groups[g]) {
      sizes[node.map] = consistent_set.groups[g].size();
      group_of[node.map] = g;
    }
  }
  return sizes;
}

bool PairChoice::known_to_meet(const MapStore& store, std::size_t a, std::size_t b) const {
  const std::optional<KnownPose> of_a = store.known_pose(maps_[a]), of_b = store.known_pose(maps_[b]);
  if (!of_a || !of_b) return false;
  const MapExtent extent_a = store.at(maps_[a]).coverage.extent();
  const MapExtent extent_b = store.at(maps_[b]).coverage.extent();
  const Point2 at = of_a->T_world_map * extent_a.centre, other = of_b->T_world_map * extent_b.centre;
  const double sd = sd_between(*of_a, *of_b, extent_a, extent_b);
  return std::hypot(at.x - other.x, at.y - other.y) <=
         2.0 * (extent_a.radius + extent_b.radius) + kDeviationsOfKnown * sd;
}

PairChoice::Rest PairChoice::rest_of(const std::set<Pair>& chosen,
                                     const ConsistentSet& consistent_set) const {
  std::vector<std::size_t> group_of;
  const std::vector<std::size_t> sizes = group_sizes(consistent_set, group_of);
  Rest rest;
  double expected = 0.0;  // of the pairs that were looked at
  std::size_t i = 0;
  for (std::size_t a = 0; a < maps_.size(); ++a) {
    for (std::size_t b = a + 1; b < maps_.size(); ++b, ++i) {
      if (chosen.contains({maps_[a], maps_[b]})) {
        expected += logistic(log_odds_[i] + shift_);
        continue;
      }
      ++rest.pairs;
      if (group_of[a] == group_of[b]) continue;
      rest.apart.push_back({logistic(log_odds_[i] + shift_) * damping(sizes[a], sizes[b]),
                            static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
    }
  }
  // Signatures expect too much where all maps look alike, and too little where none do: what was found of the
  // pairs that were looked at tells.
  rest.found = std::clamp((static_cast<double>(consistent_set.used.size()) + 1.0) / (expected + 1.0),
                          kLeastFound, kMostFound);
  return rest;
}

NotCompared PairChoice::left(const std::set<Pair>& compared, const ConsistentSet& consistent_set) const {
  Rest rest = rest_of(compared, consistent_set);
  const double shown = order_by_weight(rest.apart) * rest.found;
  const double all = static_cast<double>(consistent_set.used.size()) + shown;
  return {rest.pairs, shown + kHiddenShare * all};
}

std::vector<PairChoice::Pair> PairChoice::next(std::size_t round, const MapStore& store,
                                               const std::set<Pair>& chosen,
                                               const ConsistentSet& consistent_set) const {
  auto [count, open, found] = rest_of(chosen, consistent_set);
  std::vector<Pair> pairs;
  if (round == 0) {
    std::erase_if(open, [&](const Weighed& one) {
      if (!known_to_meet(store, one.a, one.b)) return false;
      pairs.emplace_back(maps_[one.a], maps_[one.b]);
      return true;
    });
  }
  double rest = order_by_weight(open) * found;
  const double all = static_cast<double>(consistent_set.used.size()) + rest;
  const double share =
      std::max(kForTheFirstLook * max_shown_, kFirstShare * std::pow(kShareStep, static_cast<double>(round)));
  std::vector<std::size_t> taken(maps_.size());
  for (const Weighed& one : open) {
    if (rest <= share * all) break;
    if (taken[one.a] >= kMostOfAMap && taken[one.b] >= kMostOfAMap) continue;
    ++taken[one.a];
    ++taken[one.b];
    rest -= one.weight * found;
    pairs.emplace_back(maps_[one.a], maps_[one.b]);
  }
  if (pairs.empty() && share > kForTheFirstLook * max_shown_)
    return next(round + 1, store, chosen, consistent_set);
  return pairs.empty() ? laid_on_each_other(store, chosen, consistent_set) : pairs;
}

std::vector<PairChoice::Pair> PairChoice::laid_on_each_other(const MapStore& store,
                                                             const std::set<Pair>& chosen,
                                                             const ConsistentSet& consistent_set) const {
  std::vector<Pair> pairs;
  for (const NodeGroup& group : consistent_set.groups) {
    std::vector<std::size_t> looked_at(group.size());
    for (int turn = 0; turn < 2; ++turn) {  // those that were chosen are counted first
      for (std::size_t i = 0; i < group.size(); ++i) {
        for (std::size_t j = i + 1; j < group.size(); ++j) {
          const auto [a, b] = std::minmax(group[i].map, group[j].map);
          const bool is_chosen = chosen.contains({maps_[a], maps_[b]});
          if (turn == 0) {
            looked_at[i] += is_chosen ? 1 : 0;
            looked_at[j] += is_chosen ? 1 : 0;
            continue;
          }
          if (is_chosen || (looked_at[i] >= kMostLaid && looked_at[j] >= kMostLaid)) continue;
          const ManyPointsTransform T(inverse(group[i].T_group_map) * group[j].T_group_map);
          const Coverage& other = store.at(maps_[group[j].map]).coverage;
          if (store.at(maps_[group[i].map]).coverage.share_in_common(other, T) < kLaidShare) continue;
          ++looked_at[i];
          ++looked_at[j];
          pairs.emplace_back(maps_[a], maps_[b]);
        }
      }
    }
  }
  return pairs;
}

std::vector<PairChoice::Pair> PairChoice::worth_a_second_look(const std::vector<Pair>& apart,
                                                              const PairLooks& looks,
                                                              const ConsistentSet& consistent_set) const {
  std::map<MapId, std::size_t> place;
  for (std::size_t i = 0; i < maps_.size(); ++i) place[maps_[i]] = i;
  std::vector<std::size_t> group_of;
  const std::vector<std::size_t> sizes = group_sizes(consistent_set, group_of);
  std::vector<Weighed> open;
  for (const Pair& pair : apart) {
    const std::size_t a = place.at(pair.first), b = place.at(pair.second);
    const double after = log_odds_after_a_look(log_odds(a, b) + shift_,
                                               looks.between(pair.first, pair.second, {}).probability);
    open.push_back({logistic(after) * damping(sizes[a], sizes[b]), static_cast<std::uint32_t>(a),
                    static_cast<std::uint32_t>(b)});
  }
  double rest = order_by_weight(open);
  const double all = static_cast<double>(consistent_set.used.size()) + rest;
  std::vector<Pair> pairs;
  for (const Weighed& one : open) {
    if (rest <= kForTheSecondLook * max_shown_ * all) break;
    rest -= one.weight;
    pairs.emplace_back(maps_[one.a], maps_[one.b]);
  }
  return pairs;
}

std::vector<bool> PairChoice::worth_meeting(const std::vector<std::unique_ptr<PreparedMap>>& groups,
                                            const std::vector<std::pair<std::size_t, std::size_t>>& meetings,
                                            std::size_t joins) const {
  std::vector<Signature> of_groups(groups.size());
  parallel_for(groups.size(), [&](std::size_t g) {
    if (groups[g]) of_groups[g] = make_signature(groups[g]->known());
  });
  std::vector<float> log_odds(meetings.size());
  parallel_for(meetings.size(), [&](std::size_t i) {
    const Signature &group = of_groups[meetings[i].first],
                    &alone = *signatures_.at(maps_[meetings[i].second]);
    log_odds[i] = static_cast<float>(log_odds_of_joining(compare(group, alone), group, alone));
  });
  const double shift = shift_to_this_set(log_odds);
  std::vector<std::size_t> order(meetings.size());
  std::vector<double> weights(meetings.size());
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    order[i] = i;
    weights[i] = logistic(log_odds[i] + shift);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t x, std::size_t y) { return weights[x] > weights[y]; });
  double rest = sum_of(weights);
  const double all = rest + static_cast<double>(joins);
  std::vector<bool> worth(meetings.size());
  for (const std::size_t i : order) {
    if (rest <= kForGroups * max_shown_ * all) break;
    rest -= weights[i];
    worth[i] = true;
  }
  return worth;
}

}  // namespace gridmerge::internal
