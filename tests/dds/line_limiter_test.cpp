// SPDX-License-Identifier: Apache-2.0
#include "dds/line_limiter.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "dds/restarts.hpp"

namespace gridmerge::internal {
namespace {

using std::chrono::seconds;
using Lines = std::vector<std::string>;

class Limited : public testing::Test {
 protected:
  Lines lines;
  const LineLimiter::Clock::time_point begin{seconds(1000)};
  LineLimiter limiter{1, [this](const std::string& line) { lines.push_back(line); }};
};

TEST_F(Limited, LinesOfAKindAreWrittenOnceAndCounted) {
  limiter.write("a", "a 1", begin);
  for (int i = 2; i <= 500; ++i) limiter.write("a", "a " + std::to_string(i), begin + seconds(i / 10));
  limiter.write("b", "b", begin);
  EXPECT_EQ(lines, (Lines{"a 1", "b"}));
  limiter.tell_more(begin + seconds(59));
  EXPECT_EQ(lines.size(), 2u);
  limiter.tell_more(begin + seconds(60));
  EXPECT_EQ(lines, (Lines{"a 1", "b", "a 500 (499 more like it in 60 s)"}));
  // What goes on is a line per minute; what comes again later is as at first.
  limiter.write("a", "a 501", begin + seconds(61));
  limiter.write("b", "b again", begin + seconds(61));
  limiter.tell_more(begin + seconds(120));
  EXPECT_EQ(lines.back(), "a 501 (1 more like it in 60 s)");
  EXPECT_EQ(lines.at(3), "b again");
  limiter.write("a", "a 502", begin + seconds(300));
  EXPECT_EQ(lines.back(), "a 502");
}

TEST_F(Limited, ALineMayStandForSeveral) {
  limiter.write("a", "a", begin, 3);
  limiter.tell_more(begin + seconds(60));
  EXPECT_EQ(lines, (Lines{"a", "a (2 more like it in 60 s)"}));
}

TEST_F(Limited, SoManyKindsAreToldApart) {
  constexpr std::size_t kKinds = LineLimiter::kMaxKinds + 100;
  for (std::size_t i = 0; i < kKinds; ++i) limiter.write("kind " + std::to_string(i), "line", begin);
  EXPECT_EQ(lines.size(), LineLimiter::kMaxKinds + 1);
}

TEST(KindOfLine, IsItsWordsWithoutNumbers) {
  EXPECT_EQ(kind_of_line("malformed packet received from vendor 1.16 state parse:DATA <52545053>"),
            "malformed packet received");
  EXPECT_EQ(kind_of_line("ddsi_udp_conn_write to udp/10.78.0.2:9411 failed with retcode -1"),
            "ddsi_udp_conn_write to failed");
  EXPECT_EQ(kind_of_line("12 34"), "");
}

TEST(Restarts, AreManyWithinAMinute) {
  Restarts restarts;
  const Restarts::Clock::time_point begin{seconds(1000)};
  for (int i = 0; i < 10; ++i) restarts.count(begin + seconds(30 * i));
  EXPECT_EQ(restarts.total(), 10u);
  EXPECT_FALSE(restarts.are_many(begin + seconds(270)));
  for (int i = 0; i < 3; ++i) restarts.count(begin + seconds(271 + i));
  EXPECT_TRUE(restarts.are_many(begin + seconds(273)));
  EXPECT_FALSE(restarts.are_many(begin + seconds(331)));
}

}  // namespace
}  // namespace gridmerge::internal
