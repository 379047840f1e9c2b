// SPDX-License-Identifier: Apache-2.0
// A map and the updates that reach its sides, and beyond them.
#include "bag/growing_map.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bag/support.hpp"
#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using namespace internal;
using test::cells_of;
using test::map_message;
using test::row_of;
using test::update_message;
using test::UpdateFields;
using Values = std::vector<std::int8_t>;

// Four columns, three rows, all free.
std::string blank_map() {
  return map_message({.width = 4, .height = 3, .values = Values(12, 0)});
}

class GrowingMapTest : public testing::Test {
 protected:
  GrowingMapTest() { map_.take_map(blank_map()); }

  bool take(std::int32_t x, std::int32_t y, std::uint32_t width, std::uint32_t height) {
    return map_.take_update(update_message({x, y, width, height, Values(std::size_t{width} * height, 100)}));
  }

  std::vector<std::string> warnings() const {
    std::vector<std::string> texts;
    for (const MapWarning& warning : map_.warnings(map_.grid())) texts.push_back(warning.text);
    return texts;
  }

  GrowingMap map_{12};
};

TEST_F(GrowingMapTest, UpdatesReachItsSides) {
  EXPECT_TRUE(take(0, 0, 1, 1));
  EXPECT_TRUE(take(3, 0, 1, 2));
  EXPECT_TRUE(take(1, 2, 3, 1));
  EXPECT_EQ(map_.grid().cells, cells_of({100, 0, 0, 100, 0, 0, 0, 100, 0, 100, 100, 100}));
  EXPECT_TRUE(take(0, 0, 4, 3));
  EXPECT_EQ(map_.grid().cells, cells_of(Values(12, 100)));
}

TEST_F(GrowingMapTest, UpdatesBeyondItsSidesChangeNothing) {
  const std::int32_t most = std::numeric_limits<std::int32_t>::max();
  EXPECT_FALSE(take(-1, 0, 1, 1));
  EXPECT_FALSE(take(0, -1, 1, 1));
  EXPECT_FALSE(take(4, 0, 1, 1));
  EXPECT_FALSE(take(0, 3, 1, 1));
  EXPECT_FALSE(take(0, 0, 5, 1));
  EXPECT_FALSE(take(0, 0, 1, 4));
  EXPECT_FALSE(take(3, 0, 2, 1));
  EXPECT_FALSE(take(0, 2, 1, 2));
  EXPECT_FALSE(take(most, 0, 1, 1));
  EXPECT_FALSE(take(0, most, 1, 1));
  EXPECT_EQ(map_.grid().cells, cells_of(Values(12, 0)));
  EXPECT_EQ(warnings().front(), "10 updates reach beyond their map: they are passed over");
}

TEST_F(GrowingMapTest, UpdatesWithoutCellsFitAnywhereInIt) {
  EXPECT_TRUE(take(4, 3, 0, 0));
  EXPECT_TRUE(take(0, 0, 0, 3));
  EXPECT_TRUE(take(0, 0, 4, 0));
  EXPECT_FALSE(take(5, 0, 0, 0));
  EXPECT_EQ(map_.grid().cells, cells_of(Values(12, 0)));
}

TEST_F(GrowingMapTest, RowsOfAnUpdateGoToRowsOfTheMap) {
  EXPECT_TRUE(map_.take_update(update_message({1, 1, 3, 2, {100, 0, -1, 50, 100, 0}})));
  EXPECT_EQ(map_.grid().cells, cells_of({0, 0, 0, 0, 0, 100, 0, -1, 0, 50, 100, 0}));
}

TEST_F(GrowingMapTest, AnUpdateBeforeAnyMapIsNoneAndNoWarning) {
  GrowingMap empty(12);
  EXPECT_FALSE(empty.is_there());
  EXPECT_FALSE(empty.take_update(update_message({})));
  EXPECT_FALSE(empty.take_map(map_message({.width = 0, .height = 0, .values = {}})));
  EXPECT_FALSE(empty.is_there());
  EXPECT_FALSE(empty.take_update(update_message({.x = -1})));
  EXPECT_TRUE(empty.take_map(map_message(row_of({0, 100}))));
  EXPECT_TRUE(empty.is_there());
  const std::vector<MapWarning> warnings = empty.warnings(empty.grid());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].kind, MapWarningKind::no_cells);
  EXPECT_EQ(warnings[0].text, "1 messages have a map without cells: they are passed over");
}

TEST_F(GrowingMapTest, WhatIsDamagedOrEmptyChangesNothing) {
  EXPECT_TRUE(take(0, 0, 1, 1));
  EXPECT_THROW(map_.take_map("x"), ParseError);
  EXPECT_THROW(map_.take_update(update_message({0, 0, 2, 1, {100}})), ParseError);
  EXPECT_THROW(map_.take_map(map_message(row_of(Values(13, 0)))), ParseError)
      << "one cell more than it may have";
  EXPECT_FALSE(map_.take_map(map_message({.width = 0, .values = {}})));
  EXPECT_EQ(map_.frame_id(), "map");
  EXPECT_EQ(map_.grid().cells, cells_of({100, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST_F(GrowingMapTest, ANewMapReplacesTheOldOneWithItsUpdates) {
  EXPECT_TRUE(take(0, 0, 4, 3));
  test::MapFields other = row_of({-1, 0, 100});
  other.frame_id = "other";
  other.resolution = 0.1F;
  other.x = 3.0;
  EXPECT_TRUE(map_.take_map(map_message(other)));
  EXPECT_EQ(map_.frame_id(), "other");
  EXPECT_EQ(map_.grid().width, 3);
  EXPECT_EQ(map_.grid().height, 1);
  EXPECT_EQ(map_.grid().resolution, 0.1);
  EXPECT_EQ(map_.grid().origin.x, 3.0);
  EXPECT_EQ(map_.grid().cells, cells_of({-1, 0, 100}));
  EXPECT_FALSE(take(3, 0, 1, 1));
  EXPECT_TRUE(take(2, 0, 1, 1));
}

TEST_F(GrowingMapTest, ValuesAreStrangeBelowMinusOneAndAboveAHundred) {
  EXPECT_TRUE(map_.take_map(map_message(row_of({-1, 0, 1, 99, 100}))));
  EXPECT_EQ(warnings(), std::vector<std::string>{});
  EXPECT_TRUE(map_.take_map(map_message(row_of({0, 100, -2}))));
  EXPECT_EQ(warnings(),
            std::vector<std::string>{"1 values are neither -1 nor from 0 to 100: they are read as unknown"});
  EXPECT_TRUE(map_.take_map(map_message(row_of({0, 100, 101, -128, 127}))));
  EXPECT_EQ(warnings(),
            std::vector<std::string>{"3 values are neither -1 nor from 0 to 100: they are read as unknown"});
}

}  // namespace
}  // namespace gridmerge
