// SPDX-License-Identifier: Apache-2.0
#include "preselect/proposals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <tuple>
#include <vector>

namespace gridmerge::internal {
namespace {

std::vector<Descriptor> drawn(std::size_t count, int largest, std::mt19937& random) {
  std::uniform_int_distribution<int> value(-largest, largest);
  std::vector<Descriptor> all(count);
  for (Descriptor& descriptor : all) {
    for (std::int16_t& v : descriptor) v = static_cast<std::int16_t>(value(random));
  }
  return all;
}

/// All pairs, sorted.
std::vector<Proposal> literal(const std::vector<Descriptor>& fixed, const std::vector<Descriptor>& moving,
                              std::size_t most) {
  std::vector<Proposal> all;
  for (int i = 0; i < std::ssize(fixed); ++i) {
    for (int j = 0; j < std::ssize(moving); ++j) {
      for (int quarters = 0; quarters < 4; ++quarters) {
        const Descriptor turned = quarter_turned(fixed[i], quarters);
        std::int32_t product = 0;
        for (std::size_t k = 0; k < kDescriptorSize; ++k) product += turned[k] * moving[j][k];
        if (product > 0) all.push_back({product, i, j, quarters});
      }
    }
  }
  std::sort(all.begin(), all.end(), [](const Proposal& a, const Proposal& b) {
    return std::tuple(b.product, a.fixed, a.moving, a.quarters) <
           std::tuple(a.product, b.fixed, b.moving, b.quarters);
  });
  all.resize(std::min(all.size(), most));
  return all;
}

TEST(MostAlike, AreTheFirstOfAllPairs) {
  std::mt19937 random(5);
  for (const int largest : {1, 400}) {  // products of small values are equal for most pairs
    const std::vector<Descriptor> fixed = drawn(23, largest, random), moving = drawn(31, largest, random);
    for (const std::size_t most : {1, 2, 48, 1000, 5000}) {
      const std::vector<Proposal> found = most_alike(fixed, moving, most),
                                  expected = literal(fixed, moving, most);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(
            std::tuple(found[i].product, found[i].fixed, found[i].moving, found[i].quarters),
            std::tuple(expected[i].product, expected[i].fixed, expected[i].moving, expected[i].quarters))
            << i << " of " << most;
      }
    }
  }
}

TEST(MostAlike, OfNoKeypointsAreNone) {
  std::mt19937 random(5);
  const std::vector<Descriptor> some = drawn(3, 9, random);
  EXPECT_TRUE(most_alike({}, some, 48).empty());
  EXPECT_TRUE(most_alike(some, {}, 48).empty());
  EXPECT_TRUE(most_alike(some, some, 0).empty());
  EXPECT_FALSE(most_alike(some, some, 48).empty());
}

}  // namespace
}  // namespace gridmerge::internal
