// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// A match of two maps that a merge needs.
struct DueMatch {
  std::size_t fixed = 0;                           ///< as Merger::add() called it
  std::size_t moving = 0;                          ///< likewise
  SearchMethod search = SearchMethod::exhaustive;  ///< how it is to be made
};

/// Where a merge of many maps keeps what it finds when it compares each two maps roughly, in parts: for
/// processes that merge the same maps, and would each compare them. The functions are called by one thread.
struct ComparisonStore {
  /// The part of this name, which tells the maps and the engine, if it is there.
  std::function<std::optional<std::vector<float>>(const std::string&)> find;
  /// Takes a part that was not there.
  std::function<void(const std::string&, const std::vector<float>&)> keep;
  /// At which share of the parts to begin, in [0, 1): processes at work at once each make others first.
  double begin = 0.0;
};

/// merge() for maps that come one after the other, or grow: pairs that have not changed are not matched
/// again. The result is the same as that of merge() with all the maps that are in it, in the order in which
/// they were added.
class GRIDMERGE_EXPORT Merger {
 public:
  /// What add() calls a map; it is not given again when the map is removed.
  using MapId = std::size_t;

  /// Throws std::invalid_argument for invalid options.
  explicit Merger(MergeOptions options = {});
  /// Holds these maps, with ids in their order, and what merge() takes beside them. Throws
  /// std::invalid_argument for an invalid grid, option or known pose, naming the map by its index, and for
  /// more known poses than maps.
  explicit Merger(const std::vector<OccupancyGrid>& maps, const MergeOptions& options = {},
                  const std::vector<std::optional<KnownPose>>& known_poses = {});
  ~Merger();
  /// The maps and their matches move; what is left may only be assigned to or end.
  Merger(Merger&&) noexcept;
  /// Likewise.
  Merger& operator=(Merger&&) noexcept;

  /// Takes in one more map, with what is known of its pose; nothing is matched before solve(). Throws
  /// std::invalid_argument for an invalid map or pose, and is then as before.
  MapId add(OccupancyGrid map, std::optional<KnownPose> known_pose = {});

  /// Another map in the place of one that was added, of the same robot, in the same frame. Its pairs are
  /// matched again. Throws std::out_of_range for an unknown id, and as add().
  void update(MapId id, OccupancyGrid map);

  /// As update(), for a map that is little different: what its pairs said stays until search_again(). Where
  /// the maps lie is adjusted to the new map all the same, so this is how a map follows a robot that
  /// explores, at the cost of a joint solution instead of k - 1 matches. A map that was left out stays left
  /// out until search_again() or update(). Throws as update().
  void grow(MapId id, OccupancyGrid map);

  /// The map's pairs are matched again by the next solve(). Throws std::out_of_range for an unknown id.
  void search_again(MapId id);

  /// What is known of a map's pose. Throws as update().
  void set_known_pose(MapId id, std::optional<KnownPose> known_pose);

  /// Throws std::out_of_range for an unknown id.
  void remove(MapId id);

  /// The maps that are in it, in the order in which they were added: MergeResult speaks of them by their
  /// place in this list.
  std::vector<MapId> maps() const;

  /// Those that it was given; its matches keep as many hypotheses as a merge needs.
  const MergeOptions& options() const;

  /// What is known of a map's pose. Throws std::out_of_range for an unknown id.
  std::optional<KnownPose> known_pose(MapId id) const;

  /// What the maps hold as they are now, in the order of maps(): content_id() of each, which is worked out
  /// once.
  std::vector<std::string> contents() const;

  /// From now on comparisons of maps are taken from the store, and kept there; from no store if it has
  /// neither function. Gives the store before. Throws std::invalid_argument for one with one function, or a
  /// `begin` outside [0, 1).
  ComparisonStore keep_comparisons(ComparisonStore store);

  /// The matches that solve() would make next, the most worthwhile first, for who makes them elsewhere: on
  /// other machines, say. They come in rounds, because pairs are looked at quickly first, and thoroughly
  /// where that leaves their maps apart:
  ///
  ///     for (auto due = merger.due(); !due.empty(); due = merger.due())
  ///       for (const DueMatch& one : due)
  ///         merger.hand_in(one, match(map[one.fixed], map[one.moving], merger.match_options(one.search)));
  ///     merger.solve();  // finds no pair left to be matched
  ///
  /// Of a second round the first look's joint solution is worked out, and kept for solve(). What maps that
  /// lie alone say to merged groups is matched by solve() itself.
  std::vector<DueMatch> due();

  /// Makes a match that is due, of the maps as they are, and hands nothing in: for who makes some of them
  /// here. Runs in the calling TBB arena, as match() of prepared maps; may be called by several threads at
  /// once. Throws std::out_of_range for an unknown id, and std::invalid_argument for the random walk.
  MatchResult make(const DueMatch& due) const;

  /// Takes a match that was made elsewhere, as if solve() had made it: of the two maps as they were added
  /// last, with match_options(). Also serves for a match that is not due any more. Throws std::out_of_range
  /// for an unknown id, and std::invalid_argument for two equal ids, a search that no look takes, a match
  /// that validate() refuses, and a likely hypothesis without `sigma`.
  void hand_in(const DueMatch& made, MatchResult match);

  /// The matches that are made and still hold, for who wants to go on elsewhere: hand_in() takes them.
  std::vector<std::pair<DueMatch, MatchResult>> matches() const;

  /// How a match is made; without a progress callback.
  MatchOptions match_options(SearchMethod search) const;

  /// Matches the pairs that are new or have changed, and merges: seconds to minutes for many maps. When it is
  /// cancelled (with_cancellation()) the matches made by then are kept, and the next call goes on with them.
  /// Throws std::invalid_argument when a merged map would exceed kMaxGridCells.
  MergeResult solve();

  /// As solve(), for who wants an answer soon and better ones later: looks at all new pairs quickly, but
  /// again, thoroughly, at no more than so many of those whose maps that leaves apart. What was said
  /// thoroughly of other pairs before search_again() still serves. Maps are matched with merged groups only
  /// when no pair is left to be looked at. Called until is_complete(), the last result is that of solve().
  /// Throws as that.
  MergeResult solve_soon(std::size_t most_thorough);

  /// Whether the last call looked at all that solve() looks at.
  bool is_complete() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace gridmerge
