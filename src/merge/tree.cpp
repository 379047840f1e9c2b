// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/tree.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "merge/joins.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// Maps whose poses relative to each other are known. The group's frame is that of its first member, the
/// lowest map.
struct Group {
  std::vector<Member> members;  // ascending
  std::optional<OccupancyGrid>
      fused;  // for comparisons; made when first asked for, and only of several members

  std::size_t first() const { return members.front().map; }
};

/// The groups of maps on their way up the tree.
class PairwiseTree {
 public:
  PairwiseTree(const std::vector<OccupancyGrid>& maps, const Matcher& matcher, const TreeOptions& options)
      : maps_(maps), matcher_(matcher), options_(options) {
    for (std::size_t map = 0; map < maps.size(); ++map) groups_.push_back({{Member{map, {}}}, std::nullopt});
  }

  void climb() {
    for (std::size_t span = 2; span / 2 < maps_.size(); span *= 2) {
      for (std::size_t begin = 0; begin < maps_.size(); begin += span) {
        // A joined group is another one than both that were refused before, so all others are due again.
        while (join_two(begin, begin + span)) {
        }
      }
    }
  }

  MergeResult result() {
    MergeResult result;
    result.joins = std::move(joins_);
    for (Group& group : groups_) {
      if (group.members.size() == 1) {
        result.left_out.push_back(left_out(group.first(), result.joins));
      } else {
        const std::vector<PlacedMap> inputs = placed(group);
        FusedMap fused = fuse(inputs, merged_resolution(options_.resolution, inputs));
        result.components.push_back({std::move(group.members), std::move(fused)});
      }
    }
    std::stable_sort(
        result.components.begin(), result.components.end(),
        [](const Component& a, const Component& b) { return a.members.size() > b.members.size(); });
    return result;
  }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;

  // Compares groups below the node of the tree above the maps [begin, end) until two join; false when none is
  // left to compare. All members of a group are below the same node, so a group's first member tells where it
  // is.
  bool join_two(std::size_t begin, std::size_t end) {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (groups_[i].first() < begin) continue;
      for (std::size_t j = i + 1; j < groups_.size() && groups_[j].first() < end; ++j) {
        if (!refused_.contains({groups_[i].first(), groups_[j].first()}) && compare(i, j)) return true;
      }
    }
    return false;
  }

  // Compares two groups, joins them if accepted, and says whether they were.
  bool compare(std::size_t fixed, std::size_t moving) {
    Group& fixed_group = groups_[fixed];
    Group& moving_group = groups_[moving];
    Join join = make_join(fixed_group.first(), moving_group.first(),
                          matcher_(grid_of(fixed_group), grid_of(moving_group)));
    const bool accepted = join.used();
    if (accepted) {
      absorb(fixed, moving, join.match.T_fixed_moving);
    } else {
      refused_.insert({fixed_group.first(), moving_group.first()});
    }
    joins_.push_back(std::move(join));
    if (options_.progress) options_.progress(joins_.size(), joins_.size() + open_comparisons());
    return accepted;
  }

  void absorb(std::size_t fixed, std::size_t moving, const SE2& T_fixed_moving) {
    // What either group was refused says nothing of the two together.
    std::erase_if(refused_, [gone = Pair{groups_[fixed].first(), groups_[moving].first()}](const Pair& pair) {
      return pair.first == gone.first || pair.second == gone.first || pair.first == gone.second ||
             pair.second == gone.second;
    });
    Group joined{std::move(groups_[fixed].members), std::nullopt};
    for (const Member& member : groups_[moving].members) {
      joined.members.push_back(Member{member.map, T_fixed_moving * member.T_component_map});
    }
    std::sort(joined.members.begin(), joined.members.end(),
              [](const Member& a, const Member& b) { return a.map < b.map; });
    groups_[fixed] = std::move(joined);
    groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(moving));
  }

  std::size_t open_comparisons() const { return groups_.size() * (groups_.size() - 1) / 2 - refused_.size(); }

  const OccupancyGrid& grid_of(Group& group) {
    if (group.members.size() == 1) return maps_[group.first()];
    if (!group.fused) {
      const std::vector<PlacedMap> inputs = placed(group);
      group.fused = fuse(inputs, fitting_resolution(finest_resolution(inputs), inputs)).grid;
    }
    return *group.fused;
  }

  std::vector<PlacedMap> placed(const Group& group) const {
    std::vector<PlacedMap> inputs;
    for (const Member& member : group.members) inputs.push_back({&maps_[member.map], member.T_component_map});
    return inputs;
  }

  const std::vector<OccupancyGrid>& maps_;
  const Matcher& matcher_;
  const TreeOptions& options_;
  std::vector<Group> groups_;  // ascending by first member
  std::set<Pair> refused_;     // two groups that exist, by their first members, the lower one first
  std::vector<Join> joins_;
};

}  // namespace

MergeResult merge_up_tree(const std::vector<OccupancyGrid>& maps, const Matcher& matcher,
                          const TreeOptions& options) {
  validate_merge(maps, options.resolution);
  MergeResult result;
  with_threads(options.threads, [&] {
    PairwiseTree tree(maps, matcher, options);
    tree.climb();
    result = tree.result();
  });
  return result;
}

}  // namespace gridmerge
