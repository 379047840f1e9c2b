// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/consistent_set.hpp"
#include "merge/map_store.hpp"
#include "merge/pair_looks.hpp"
#include "preselect/chance.hpp"
#include "preselect/signature.hpp"

namespace gridmerge::internal {

/// Whether all pairs of so many maps are looked at. Signatures alone miss a share of kHiddenShare of all
/// joins, so that no choice of pairs misses less.
inline bool takes_all_pairs(std::size_t maps, double max_missed) {
  return max_missed <= kHiddenShare || maps <= kFewMaps;
}

/// Core time of a pair if all pairs of many maps are matched: docs/scale.md, "Model", has what they follow
/// from [s].
inline constexpr double kSecondsOfAPair = 0.12;        // both looks
inline constexpr double kSecondsOfAQuickLook = 0.032;  // and no other

/// Chooses the pairs of many maps that are looked at, by signatures of the maps: in rounds, the likeliest
/// first, until those that are left hide at most a given share of all joins. A pair whose maps lie in one
/// component already can change little, and waits.
///
/// What is chosen depends on the maps and on what was chosen before, not on their order or on threads.
class PairChoice {
 public:
  using MapId = MapStore::MapId;
  using Pair = PairLooks::Pair;

  /// `max_missed`: the share of all joins that may be missed.
  explicit PairChoice(double max_missed);

  bool takes_all(std::size_t maps) const { return takes_all_pairs(maps, max_missed_); }

  /// The map is another one, or gone.
  void forget(MapId id);

  /// Where prepare() finds and keeps comparisons.
  /// Gives the store before.
  ComparisonStore keep_comparisons(ComparisonStore store) {
    return std::exchange(comparisons_, std::move(store));
  }

  /// The map has changed a little: it is chosen for as it was, and no store gets that.
  void outdate(MapId id) { outdated_.insert(id); }

  /// Makes the signatures that are missing, and compares them. `maps` are in canonical order. Runs in the
  /// calling TBB arena. O(maps^2) comparisons of signatures, kept until a map changes.
  void prepare(const MapStore& store, const std::vector<MapId>& maps);

  /// The pairs to be looked at next, given those that were chosen before and the solution that they made;
  /// none when the rest may be left. `round` counts from 0. The first map of a pair stands before the second
  /// one in `maps`. O(pairs log(pairs)).
  std::vector<Pair> next(std::size_t round, const MapStore& store, const std::set<Pair>& chosen,
                         const ConsistentSet& consistent_set) const;

  /// The pairs that are left, given those that were compared and the solution that they made. O(maps^2).
  NotCompared left(const std::set<Pair>& compared, const ConsistentSet& consistent_set) const;

  /// Of the pairs whose maps the first look leaves apart, those that get a second one.
  std::vector<Pair> worth_a_second_look(const std::vector<Pair>& apart, const PairLooks& looks,
                                        const ConsistentSet& consistent_set) const;

  /// Which meetings of a group and a map that lies alone are worth a match, by the group's signature.
  /// `joins` were made so far. Runs in the calling TBB arena.
  std::vector<bool> worth_meeting(const std::vector<std::unique_ptr<PreparedMap>>& groups,
                                  const std::vector<std::pair<std::size_t, std::size_t>>& meetings,
                                  std::size_t joins) const;

 private:
  struct Weighed {
    double weight;
    std::uint32_t a, b;  // places in maps_
  };
  /// Pairs that were not chosen.
  struct Rest {
    std::size_t pairs = 0;
    std::vector<Weighed> apart;  // those whose maps lie in no common group
    double found = 1.0;          // joins found by joins expected, of the pairs that were chosen
  };
  Rest rest_of(const std::set<Pair>& chosen, const ConsistentSet& consistent_set) const;

  /// Largest weight first. Returns the sum of the weights.
  static double order_by_weight(std::vector<Weighed>& pairs);

  float log_odds(std::size_t a, std::size_t b) const;
  std::vector<std::size_t> group_sizes(const ConsistentSet& consistent_set,
                                       std::vector<std::size_t>& group_of) const;
  std::vector<Pair> laid_on_each_other(const MapStore& store, const std::set<Pair>& chosen,
                                       const ConsistentSet& consistent_set) const;
  bool known_to_meet(const MapStore& store, std::size_t a, std::size_t b) const;

  ComparisonStore comparisons_;
  std::set<MapId> outdated_;  // whose signatures are of what they were
  double max_missed_;
  double max_shown_;         // share of all joins that may be missed although signatures show them
  std::vector<MapId> maps_;  // of prepare()
  std::map<MapId, std::unique_ptr<const Signature>> signatures_;
  std::vector<float> log_odds_;  // of each pair of maps_, a < b, in their order
  double shift_ = 0.0;
};

}  // namespace gridmerge::internal
