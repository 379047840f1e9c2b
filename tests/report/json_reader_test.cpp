// SPDX-License-Identifier: Apache-2.0
#include "report/json_reader.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "report/record_values.hpp"

namespace gridmerge::internal {
namespace {

std::string message_of(const std::string& text, void (*read)(const JsonReader&)) {
  const nlohmann::json value = parse_json(text);
  try {
    read(JsonReader(value));
  } catch (const JsonError& error) {
    return error.what();
  }
  return "";
}

TEST(JsonReader, NumbersLieWithinTheirBoundsBothIncluded) {
  const auto in_unit = [](const JsonReader& json) { json.number_in(-1.0, 1.0); };
  for (const char* text : {"1", "-1", "1.0", "0", "-0.0", "1e-300"})
    EXPECT_EQ(message_of(text, in_unit), "") << text;
  for (const char* text : {"1.0000001", "-1.0000001", "2", "1e308"})
    EXPECT_EQ(message_of(text, in_unit), "the text lies outside [-1, 1]") << text;
  for (const char* text : {"\"1\"", "null", "true", "[1]", "{}"})
    EXPECT_EQ(message_of(text, in_unit), "the text is no number") << text;
}

TEST(JsonReader, CountsAreWholeAndAtMostTwoToThe53) {
  const auto count = [](const JsonReader& json) { json.count(); };
  for (const char* text : {"0", "1", "9007199254740991", "9007199254740992"})
    EXPECT_EQ(message_of(text, count), "");
  for (const char* text : {"-1", "9007199254740993", "18446744073709551615", "1.0", "1e3", "\"1\"", "null"})
    EXPECT_EQ(message_of(text, count), "the text is no whole number from 0 to 2^53") << text;
  EXPECT_EQ(JsonReader(parse_json("9007199254740992")).count(), std::int64_t{1} << 53);
}

TEST(JsonReader, SharesMayBeRoundedByABillionth) {
  const auto share = [](const JsonReader& json) { read_share(json); };
  for (const char* text : {"0", "1", "0.5", "-0.99e-9", "1.00000000099"})
    EXPECT_EQ(message_of(text, share), "") << text;
  for (const char* text : {"-1.01e-9", "1.00000000101", "-1", "2"})
    EXPECT_NE(message_of(text, share), "") << text;
}

TEST(JsonReader, ReasonsAreThoseThatOutputsName) {
  for (int i = 0; i <= static_cast<int>(Reason::over_budget); ++i) {
    const auto reason = static_cast<Reason>(i);
    EXPECT_EQ(read_reason(JsonReader(nlohmann::json(name_of(reason)))), reason);
  }
  const auto read = [](const JsonReader& json) { read_reason(json); };
  EXPECT_EQ(message_of("\"tired\"", read), "the text is unknown: 'tired'");
}

TEST(JsonReader, PosesLieWithinReach) {
  const auto pose = [](const JsonReader& json) { json.transform(10.0); };
  EXPECT_EQ(message_of(R"({"x": 10, "y": -10, "theta": 3.141592653589793})", pose), "");
  EXPECT_EQ(message_of(R"({"x": 10.1, "y": 0, "theta": 0})", pose), "x lies outside [-10, 10]");
  EXPECT_EQ(message_of(R"({"x": 0, "y": -10.1, "theta": 0})", pose), "y lies outside [-10, 10]");
  EXPECT_NE(message_of(R"({"x": 0, "y": 0, "theta": 3.15})", pose), "");
  EXPECT_EQ(message_of(R"({"x": 0, "y": 0})", pose), "theta is missing");
  EXPECT_EQ(message_of("[0, 0, 0]", pose), "the text is no object");
}

TEST(JsonReader, NamesThePlace) {
  const auto deep = [](const JsonReader& json) { json.at("a").at(1).at("b").text(); };
  EXPECT_EQ(message_of(R"({"a": [0, {"b": "text"}]})", deep), "");
  EXPECT_EQ(message_of(R"({"a": [0, {"b": 1}]})", deep), "a[1].b is no text");
  EXPECT_EQ(message_of(R"({"a": [0, {}]})", deep), "a[1].b is missing");
  EXPECT_EQ(message_of(R"({"a": [0]})", deep), "a has no element 1");
  EXPECT_EQ(message_of(R"({"a": {}})", deep), "a is no list");
}

}  // namespace
}  // namespace gridmerge::internal
