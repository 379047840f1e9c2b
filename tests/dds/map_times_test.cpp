// SPDX-License-Identifier: Apache-2.0
#include "dds/map_times.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gridmerge::internal {
namespace {

RobotStatus merged(const std::string& name, std::optional<std::size_t> component, std::uint64_t maps_heard) {
  RobotStatus status;
  status.name = name;
  status.component = component;
  status.maps_heard = maps_heard;
  return status;
}

TeamAnswer answer_of(std::vector<RobotStatus> robots, std::size_t components) {
  TeamAnswer answer;
  answer.robots = std::move(robots);
  answer.components.resize(components);
  return answer;
}

using Stamps = std::vector<Stamp>;

TEST(MapTimes, AreThoseOfTheMapsInEachComponent) {
  MapTimes times;
  for (const auto& [robot, seconds] : {std::pair("a", 5), {"b", 7}, {"c", 3}, {"d", 2}, {"alone", 1000}})
    times.hear_map(robot, {seconds, 0});
  const TeamAnswer answer = answer_of(
      {merged("a", 0, 1), merged("alone", {}, 1), merged("b", 0, 1), merged("c", 1, 1), merged("d", 1, 1)},
      2);
  EXPECT_EQ(times.newest_of(answer), (Stamps{{7, 0}, {3, 0}}));
}

TEST(MapTimes, AreOfWhatWasMergedAndNotOfWhatWasHeardSince) {
  MapTimes times;
  times.hear_map("a", {1, 0});
  times.hear_map("a", {2, 0});
  times.hear_part("a", {});  // of an unknown time
  times.hear_part("a", {4, 0});
  times.hear_map("a", {3, 0});  // its clock went back
  const Stamp expected[] = {{1, 0}, {2, 0}, {2, 0}, {4, 0}, {3, 0}};
  for (std::uint64_t heard = 1; heard <= 5; ++heard)
    EXPECT_EQ(times.newest_of(answer_of({merged("a", 0, heard)}, 1)), Stamps{expected[heard - 1]}) << heard;
  times.forget("a");
  times.hear_map("a", {9, 0});
  EXPECT_EQ(times.newest_of(answer_of({merged("a", 0, 1)}, 1)), (Stamps{{9, 0}}));
}

TEST(MapTimes, AreBoundedWhileNoAnswerComes) {
  MapTimes times;
  constexpr std::int32_t kMaps = 3 * MapTimes::kMaxKept;
  for (std::int32_t second = 1; second <= kMaps; ++second) times.hear_map("a", {second, 0});
  EXPECT_EQ(times.newest_of(answer_of({merged("a", 0, 1)}, 1)), (Stamps{{1, 0}}));
  EXPECT_EQ(times.newest_of(answer_of({merged("a", 0, kMaps)}, 1)), (Stamps{{kMaps, 0}}));
}

}  // namespace
}  // namespace gridmerge::internal
