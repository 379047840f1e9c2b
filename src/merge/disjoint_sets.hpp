// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace gridmerge::internal {

/// Sets of the numbers below a count, each a set of its own at first. To ask and to unite takes O(log count),
/// amortised.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// The least number of the set that has this one.
  std::size_t least_of(std::size_t number) {
    while (parent_[number] != number) number = parent_[number] = parent_[parent_[number]];
    return number;
  }

  bool are_one(std::size_t a, std::size_t b) { return least_of(a) == least_of(b); }

  void unite(std::size_t a, std::size_t b) {
    const auto [first, second] = std::minmax({least_of(a), least_of(b)});
    parent_[second] = first;
  }

  /// Ascending by their least numbers, each ascending. O(count log count).
  std::vector<std::vector<std::size_t>> all() {
    std::vector<std::vector<std::size_t>> sets;
    std::vector<std::size_t> place(parent_.size());  // of the set, by its least number
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      const std::size_t least = least_of(i);
      if (least == i) {
        place[i] = sets.size();
        sets.emplace_back();
      }
      sets[place[least]].push_back(i);
    }
    return sets;
  }

 private:
  std::vector<std::size_t> parent_;  // no greater than the number itself
};

}  // namespace gridmerge::internal
