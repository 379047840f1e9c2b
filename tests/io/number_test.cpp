// SPDX-License-Identifier: Apache-2.0
#include "io/number.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace gridmerge {

using namespace internal;
namespace {

TEST(ParseNumber, TakesWhatYamlAuthorsWrite) {
  EXPECT_EQ(parse_number("0.05"), 0.05);
  EXPECT_EQ(parse_number("-3"), -3.0);
  EXPECT_EQ(parse_number("+3"), 3.0);
  EXPECT_EQ(parse_number("1e-2"), 0.01);
  EXPECT_EQ(parse_number("2.5E+1"), 25.0);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("5."), 5.0);
}

TEST(ParseNumber, RefusesAllElse) {
  for (const char* text :
       {"",     " ",  "+",   "-",    ".",   "+-1",  "--1",  "1 ",       " 1",    "1m",    "1,5",
        "0x10", "1e", "nan", "-NaN", "inf", ".inf", ".nan", "infinity", "1e999", "1_000", "one"}) {
    EXPECT_FALSE(parse_number(text)) << "'" << text << "'";
  }
}

TEST(FormatNumber, IsShortAndAlwaysHasAPoint) {
  EXPECT_EQ(format_number(0.05), "0.05");
  EXPECT_EQ(format_number(0.0), "0.0");
  EXPECT_EQ(format_number(-5.0), "-5.0");
  EXPECT_EQ(format_number(1e-6), "1.0e-06");
  EXPECT_EQ(format_number(1.5e-9), "1.5e-09");
  EXPECT_EQ(format_number(1e300), "1.0e+300");
}

RC_GTEST_PROP(FormatNumber, ReadsBackToTheSameBits, (std::uint64_t bits)) {
  const auto value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  const auto read = parse_number(format_number(value));
  RC_ASSERT(read.has_value());
  RC_ASSERT(std::bit_cast<std::uint64_t>(*read) == bits);
}

}  // namespace
}  // namespace gridmerge
