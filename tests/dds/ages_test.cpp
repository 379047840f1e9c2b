// SPDX-License-Identifier: Apache-2.0
#include "dds/ages.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <chrono>
#include <cstdint>
#include <string>

namespace gridmerge::internal {
namespace {

RC_GTEST_PROP(Times, AreReadAsTheyWereWritten, ()) {
  const auto nanoseconds = *rc::gen::inRange<std::int64_t>(0, std::int64_t{9'000'000'000} * 1'000'000'000);
  const TeamTime time{std::chrono::duration_cast<TeamTime::duration>(std::chrono::nanoseconds(nanoseconds))};
  RC_ASSERT(read_time(format_time(time)) == time);
}

TEST(Times, AreWrittenInSeconds) {
  EXPECT_EQ(format_time(TeamTime(std::chrono::milliseconds(1764224401250))), "1764224401.250000000");
  EXPECT_EQ(format_time(TeamTime()), "0.000000000");
}

TEST(Times, AreNothingElse) {
  for (const std::string text :
       {"", ".", "1", "1.", "1.0", "-1.000000000", "1.-00000000", " 1.000000000", "1.0000000000",
        "99999999999.000000000", "9000000001.000000000", "9999999999.999999999", "1e3.000000000", "nan",
        "1.000000000 ", "+1.000000000"})
    EXPECT_FALSE(read_time(text)) << text;
}

}  // namespace
}  // namespace gridmerge::internal
