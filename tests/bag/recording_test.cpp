// SPDX-License-Identifier: Apache-2.0
// Bags that other people's writers made: tests/bag/make_bags.py.
#include <gtest/gtest.h>

#include <string>

#include "gridmerge/bag/bag.hpp"
#include "gridmerge/grid/message_values.hpp"

namespace gridmerge {
namespace {

constexpr int kWidth = 7, kHeight = 5;

// As values() of make_bags.py.
std::vector<std::int8_t> values(int robot, int time) {
  constexpr std::int8_t kThree[] = {-1, 0, 100};
  std::vector<std::int8_t> values;
  for (int cell = 0; cell < kWidth * kHeight; ++cell)
    values.push_back(robot == 1 ? kThree[(cell + time) % 3]
                                : static_cast<std::int8_t>((cell * 3 + time) % 102 - 1));
  return values;
}

OccupancyGrid grid(int robot, const std::vector<std::int8_t>& values) {
  return grid_of_percentages(kWidth, kHeight, 0.05, {-1.25 * robot, 2.5 + robot, 0.5 * robot}, values);
}

void expect_equal(const OccupancyGrid& found, const OccupancyGrid& expected) {
  EXPECT_EQ(found.width, expected.width);
  EXPECT_EQ(found.height, expected.height);
  EXPECT_EQ(found.resolution, expected.resolution);
  EXPECT_EQ(found.origin.x, expected.origin.x);
  EXPECT_EQ(found.origin.y, expected.origin.y);
  EXPECT_NEAR(found.origin.theta, expected.origin.theta, 1e-12);
  EXPECT_EQ(found.cells, expected.cells);
  ASSERT_EQ(found.probability.size(), expected.probability.size());
  for (std::size_t i = 0; i < found.probability.size(); ++i) {
    if (expected.cells[i] != Cell::unknown) {
      EXPECT_EQ(found.probability[i], expected.probability[i]) << i;
    }
  }
}

class Recording : public testing::TestWithParam<const char*> {
 protected:
  const std::string path_ = std::string(GRIDMERGE_TEST_DATA "/") + GetParam();
};

TEST_P(Recording, HasItsTopics) {
  const Bag bag(path_);
  ASSERT_EQ(bag.topics().size(), 4u);
  EXPECT_EQ(bag.topics()[0].name, "/chatter");
  EXPECT_EQ(bag.topics()[0].type, "std_msgs/msg/String");
  EXPECT_EQ(bag.topics()[0].messages, 3u);
  EXPECT_EQ(bag.topics()[1].name, "/tb1/map");
  EXPECT_EQ(bag.topics()[1].type, "nav_msgs/msg/OccupancyGrid");
  EXPECT_EQ(bag.topics()[1].messages, 3u);
  EXPECT_EQ(bag.topics()[2].name, "/tb1/map_updates");
  EXPECT_EQ(bag.topics()[2].type, "map_msgs/msg/OccupancyGridUpdate");
  EXPECT_EQ(bag.topics()[2].messages, 1u);
  EXPECT_EQ(bag.topics()[3].name, "/tb2/map");
}

TEST_P(Recording, HasItsMapsAtEachTime) {
  const Bag bag(path_);
  BagMaps maps(bag, "/tb2/map");
  for (int time = 1; time <= 3; ++time) {
    const auto map = maps.next();
    ASSERT_TRUE(map);
    EXPECT_EQ(map->time, time * 1'000'000'000LL + 2);
    EXPECT_EQ(map->frame_id, "tb2/map");
    expect_equal(map->grid, grid(2, values(2, time)));
  }
  EXPECT_FALSE(maps.next());
}

TEST_P(Recording, EndsWithTheLastMapAndItsUpdates) {
  std::vector<std::int8_t> last = values(1, 3);
  const std::int8_t update[] = {100, 0, 100, 0, -1, 0};
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      last[(1 + row) * kWidth + 2 + column] = update[row * 3 + column];
  expect_equal(load_any_map(path_ + "#/tb1/map").grid, grid(1, last));
  expect_equal(load_any_map(path_ + "#tb2/map").grid, grid(2, values(2, 3)));
}

INSTANTIATE_TEST_SUITE_P(OfOtherWriters, Recording,
                         testing::Values("db3", "db3/db3.db3", "db3_messages",
                                         "db3_messages/db3_messages.db3", "db3_file",
                                         "db3_file/db3_file.db3.zstd", "mcap_plain",
                                         "mcap_plain/mcap_plain.mcap", "mcap_storage", "mcap_file",
                                         "mcap_file/mcap_file.mcap.zstd", "none.mcap", "lz4.mcap",
                                         "zstd.mcap", "no_chunks.mcap", "no_index.mcap", "no_summary.mcap"));

}  // namespace
}  // namespace gridmerge
