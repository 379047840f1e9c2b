// SPDX-License-Identifier: Apache-2.0
#include "dds/reserve.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <string>

namespace gridmerge::internal {
namespace {

/// What is kept of the publisher of this number: a map whose frame and participant are named after it.
Reserve::Kept kept(std::size_t number, dds_time_t written = 100) {
  Reserve::Kept one;
  one.writer.handle = number;
  one.writer.participant = std::to_string(number);
  one.map.frame = "map";
  one.map.grid.cells.assign(number, Cell::free);
  one.written = written;
  return one;
}

HeardPart part(int x) {
  HeardPart part;
  part.frame = "map";
  part.x = x;
  part.grid.cells.assign(1, Cell::free);
  return part;
}

TEST(Reserve, KeepsTheNewestMapsOfSoManyPublishers) {
  Reserve reserve;
  for (std::size_t number = 1; number <= Reserve::kMaxKept + 2; ++number) reserve.keep(kept(number));
  EXPECT_EQ(reserve.cells(), 3u + 4u + 5u + 6u);
  reserve.keep(kept(4));  // takes the place of its own, and is the newest
  EXPECT_EQ(reserve.cells(), 3u + 4u + 5u + 6u);
  for (const std::size_t number : {4u, 6u, 5u, 3u}) EXPECT_EQ(reserve.take_newest()->writer.handle, number);
  EXPECT_FALSE(reserve.take_newest().has_value());
}

TEST(Reserve, KeepsTheNewestUpdatesOfAMap) {
  constexpr int kParts = static_cast<int>(Reserve::kMaxParts);
  Reserve reserve;
  EXPECT_FALSE(reserve.keep("1", part(0), 101));
  reserve.keep(kept(1));
  for (int x = 0; x < kParts + 2; ++x) EXPECT_TRUE(reserve.keep("1", part(x), 101 + x));
  EXPECT_EQ(reserve.cells(), 1 + Reserve::kMaxParts);
  const std::optional<Reserve::Kept> one = reserve.take_newest();
  ASSERT_EQ(one->parts.size(), Reserve::kMaxParts);
  EXPECT_EQ(one->parts.front().x, 2);
  EXPECT_EQ(one->parts.back().x, kParts + 1);
}

TEST(Reserve, KeepsNoUpdateThatItsMapHas) {
  Reserve reserve;
  reserve.keep(kept(1, 100));
  EXPECT_TRUE(reserve.keep("1", part(0), 99));
  EXPECT_TRUE(reserve.keep("1", part(1), 0));  // whose publisher does not say when it was written
  const std::optional<Reserve::Kept> one = reserve.take_newest();
  ASSERT_EQ(one->parts.size(), 1u);
  EXPECT_EQ(one->parts.front().x, 1);
}

}  // namespace
}  // namespace gridmerge::internal
