// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "gridmerge/match/match.hpp"

namespace gridmerge::internal {

/// What pairs of maps say of each other, kept from one merge to the next. Maps go by a number of the
/// caller's.
class PairMatches {
 public:
  using MapId = std::size_t;
  using Pair = std::pair<MapId, MapId>;  ///< fixed, moving
  using Make = std::function<MatchResult(const Pair&)>;
  using Progress = std::function<void(std::size_t, std::size_t)>;  ///< done, of all

  /// Makes those of the pairs that it does not hold, or holds as outdated, as the maps are now, several at a
  /// time. When the work is cancelled, or `make` throws, what is done by then is kept. Runs in the calling
  /// TBB arena.
  void add(std::vector<Pair> pairs, const Make& make, const Progress& progress);

  /// Takes a match of the pair as its maps are now.
  void keep(const Pair& pair, MatchResult match);

  bool holds(MapId a, MapId b) const;
  /// Whether it holds the pair as its maps are now.
  bool is_up_to_date(MapId a, MapId b) const;

  /// The last match, outdated or not. Throws std::out_of_range for a pair that it does not hold.
  MatchResult between(MapId fixed, MapId moving) const;

  /// Calls `take` with the pair, as it was matched, and the match of each that is up to date.
  void for_each(const std::function<void(const Pair&, const MatchResult&)>& take) const;

  /// The map has changed: what is held of it serves until add() replaces it.
  void outdate(MapId id);

  /// What is held of a map is of no use any more.
  void forget(MapId id);

 private:
  /// A match as it was made.
  struct Made {
    MapId fixed;
    MatchResult match;
    bool is_outdated = false;
  };

  std::map<Pair, Made> made_;  // by the lower number and the higher one
};

}  // namespace gridmerge::internal
