// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "merge/component.hpp"

namespace gridmerge::internal {

/// Matches maps that were left alone with what a whole group has seen: a map may share little with each of
/// them, and much with all.
class GroupMatches {
 public:
  explicit GroupMatches(MatchOptions options);

  /// Tells which meetings are worth a match, each of a group (index into the first argument) and a map (of
  /// the problem). Groups that meet nobody are null.
  using WorthMeeting =
      std::function<std::vector<bool>(const std::vector<std::unique_ptr<PreparedMap>>& groups,
                                      const std::vector<std::pair<std::size_t, std::size_t>>& meetings)>;

  /// The problem with what groups say of maps that lie alone, where they say it surely enough: that becomes
  /// the candidates of the member that has most in common with the map. Its other pairs with the group then
  /// neither speak for it nor against it, since the group has spoken for all. The same problem where no group
  /// says anything. Of the maps that lie alone those are asked about of which nothing is known beforehand.
  /// With `worth_meeting` only those that it names are matched, and thoroughly only those of which the quick
  /// look thinks something. Matches are kept for the next call, those
  /// that it does not need are forgotten. Runs in the calling TBB arena. O(maps alone * groups) times
  /// match().
  JoinProblem heard(const JoinProblem& problem, const ConsistentSet& consistent_set,
                    const std::vector<MergeInput>& inputs, const WorthMeeting& worth_meeting = {});

  /// Of a map that has changed, or of all whose index has.
  void forget() { kept_.clear(); }

 private:
  /// Which maps lie how, and which one they were matched with.
  using Key = std::vector<double>;

  MatchOptions options_;
  std::map<Key, MatchResult> kept_;
};

}  // namespace gridmerge::internal
