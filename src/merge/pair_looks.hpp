// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merger.hpp"
#include "match/looked_twice.hpp"
#include "merge/map_store.hpp"
#include "merge/pair_matches.hpp"

namespace gridmerge::internal {

/// What the pairs of a merge say of each other: a first look at those that are chosen, and a second one at
/// those of them whose maps the first leaves apart. What a pair's match is depends on the maps alone, not on
/// when they came, nor on who made it.
class PairLooks {
 public:
  using MapId = MapStore::MapId;
  using Pair = PairMatches::Pair;
  using Progress = PairMatches::Progress;

  /// `options` are valid, with as many hypotheses as are kept.
  explicit PairLooks(MatchOptions options);

  /// All pairs, for few maps: of many PairChoice chooses some. A pair that is not chosen says nothing, and is
  /// not looked at again. The first map of a pair stands before the second one in `maps`.
  static std::vector<Pair> choose_pairs(const std::vector<MapId>& maps);

  /// Whether there is a second look.
  bool looks_twice() const { return options_.search == SearchMethod::exhaustive; }

  SearchMethod first_search() const { return looks_twice() ? SearchMethod::quick : options_.search; }
  SearchMethod second_search() const { return SearchMethod::exhaustive; }

  /// How a match is made.
  MatchOptions match_options(SearchMethod search) const;

  /// Those of the pairs whose first look is missing or outdated.
  std::vector<Pair> due_for_the_first_look(std::vector<Pair> pairs) const;

  /// Those of the pairs whose second look is missing or outdated: first those that had none, then those of
  /// which the first look thinks most.
  std::vector<Pair> due_for_a_second_look(std::vector<Pair> pairs) const;

  /// Look at these pairs. Run in the calling TBB arena.
  void look(const std::vector<Pair>& pairs, const MapStore& maps, const Progress& progress);
  void look_again(const std::vector<Pair>& pairs, const MapStore& maps, const Progress& progress);

  /// A match that was made elsewhere, as if it had been made here. Throws std::invalid_argument for a search
  /// that is neither look's.
  void hand_in(const Pair& pair, SearchMethod search, MatchResult match);

  /// All that are made and up to date.
  std::vector<std::pair<DueMatch, MatchResult>> matches() const;

  /// Those of the pairs that have had a second look, up to date or not: the lower id and the higher one.
  std::set<Pair> seen_again(const std::vector<Pair>& pairs) const;

  /// Whether there was a first look at the pair.
  bool holds(MapId a, MapId b) const { return first_.holds(a, b); }

  /// By the second look if the pair is in `again`, and by the first if not.
  MatchResult between(MapId fixed, MapId moving, const std::set<Pair>& again) const;

  /// The map has changed a little: its matches serve, but second looks do not go on from first ones at the
  /// map that it was.
  void forget_found(MapId id);

  /// As those of PairMatches.
  void outdate(MapId id);
  void forget(MapId id);

 private:
  /// What the first look at the pair's maps, as they are now, has found; once.
  std::optional<QuickLook> take_found(const Pair& pair);

  MatchOptions options_;
  PairMatches first_;
  PairMatches second_;
  std::mutex keeping_;
  std::map<Pair, QuickLook> found_;  // by first looks that were made here, by the lower id and the higher one
};

}  // namespace gridmerge::internal
