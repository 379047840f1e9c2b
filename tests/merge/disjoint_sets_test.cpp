// SPDX-License-Identifier: Apache-2.0
#include "merge/disjoint_sets.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace gridmerge::internal {
namespace {

using Sets = std::vector<std::vector<std::size_t>>;

TEST(DisjointSets, AscendByTheirLeastNumbers) {
  DisjointSets sets(6);
  EXPECT_EQ(sets.all(), (Sets{{0}, {1}, {2}, {3}, {4}, {5}}));
  sets.unite(5, 1);
  sets.unite(4, 2);
  sets.unite(3, 4);
  EXPECT_EQ(sets.all(), (Sets{{0}, {1, 5}, {2, 3, 4}}));
  EXPECT_EQ(sets.least_of(4), 2U);
  EXPECT_TRUE(sets.are_one(3, 2));
  EXPECT_FALSE(sets.are_one(3, 5));
  EXPECT_TRUE(DisjointSets(0).all().empty());
}

/// Beside labels that are changed one by one.
RC_GTEST_PROP(DisjointSets, AreThoseOfLabels, ()) {
  const auto count = *rc::gen::inRange<std::size_t>(1, 40);
  std::vector<std::size_t> labels(count);
  std::iota(labels.begin(), labels.end(), std::size_t{0});
  DisjointSets sets(count);
  for (auto unions = *rc::gen::inRange(0, 60); unions > 0; --unions) {
    const auto a = *rc::gen::inRange<std::size_t>(0, count), b = *rc::gen::inRange<std::size_t>(0, count);
    sets.unite(a, b);
    const auto [least, other] = std::minmax({labels[a], labels[b]});
    std::replace(labels.begin(), labels.end(), other, least);
  }
  for (std::size_t i = 0; i < count; ++i) RC_ASSERT(sets.least_of(i) == labels[i]);
}

}  // namespace
}  // namespace gridmerge::internal
