// SPDX-License-Identifier: Apache-2.0
#include "report/plan_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/support.hpp"
#include "report/json_reader.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;
using test::message_of;

const std::vector<std::string> kNames{"a", "b", "c", "a", "d"};

/// Of two components the second one hangs on the plan, in two parts.
MergeResult some_result() {
  MergeResult result;
  result.components.push_back({{{0, {}}, {1, {}}}, {}});
  result.components.push_back({{{2, {}}, {3, {}}, {4, {}}}, {}});
  result.plan = PlanPlacement{"plan.png",
                              1.25,
                              {{{0, 1}, {1.0, 2.0, 0.5}, 1.5, 0.125, Reason::ambiguous},
                               {{2}, {3.0, 4.0, -0.5}, 1.25, 0.75, Reason::none},
                               {{3, 4}, {5.0, 6.0, 0.25}, 1.26, 0.875, Reason::none}},
                              0.05};
  return result;
}

Json some_json() {
  const MergeResult result = some_result();
  return plan_json(kNames, *result.plan, component_on_plan(result));
}

/// What is said of it when it is read; "" if nothing.
std::string said_of(const Json& json) {
  const nlohmann::json value = nlohmann::json::parse(json.dump());
  MergeResult result = some_result();
  result.plan.reset();
  try {
    read_plan(JsonReader(value), kNames, result);
  } catch (const JsonError& error) {
    return error.what();
  }
  EXPECT_TRUE(result.plan);
  return "";
}

TEST(PlanJson, IsTheDocumentedText) {
  EXPECT_EQ(
      some_json().dump(),
      R"({"source":"plan.png","resolution":0.05,"scale":1.25,"probability":0.875,"component":"merged_2.yaml",)"
      R"("maps":["c","a","d"],"parts":[)"
      R"({"maps":["a","b"],"transform":{"x":1.0,"y":2.0,"theta":0.5},"scale":1.5,"probability":0.125,"reason":"ambiguous"},)"
      R"({"maps":["c"],"transform":{"x":3.0,"y":4.0,"theta":-0.5},"scale":1.25,"probability":0.75,"reason":null},)"
      R"({"maps":["a","d"],"transform":{"x":5.0,"y":6.0,"theta":0.25},"scale":1.26,"probability":0.875,"reason":null}]})");
}

TEST(PlanJson, IsReadAsItWasWritten) {
  const Json json = some_json();
  MergeResult read = some_result();
  read.plan.reset();
  const nlohmann::json value = nlohmann::json::parse(json.dump());
  read_plan(JsonReader(value), kNames, read);
  ASSERT_TRUE(read.plan);
  const PlanPlacement& plan = *read.plan;
  EXPECT_EQ(plan_json(kNames, plan, component_on_plan(read)), json);
  ASSERT_EQ(plan.parts.size(), 3u);
  // Of maps of one name the first is taken first.
  EXPECT_EQ(plan.parts[0].maps, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(plan.parts[1].maps, std::vector<std::size_t>{2});
  EXPECT_EQ(plan.parts[2].maps, (std::vector<std::size_t>{3, 4}));
  Json turned = json;
  turned["parts"][2]["maps"] = {"d", "a"};  // ascending, whatever the order
  const nlohmann::json other = nlohmann::json::parse(turned.dump());
  read_plan(JsonReader(other), kNames, read);
  EXPECT_EQ(read.plan->parts[2].maps, (std::vector<std::size_t>{3, 4}));
}

TEST(PlanJson, OfNothingOnThePlanThereIsNoScale) {
  MergeResult result = some_result();
  for (PlanPart& part : result.plan->parts) part.reason = Reason::several;
  EXPECT_EQ(component_on_plan(result), "");
  const Json json = plan_json(kNames, *result.plan, component_on_plan(result));
  for (const char* key : {"scale", "probability", "component"}) EXPECT_TRUE(json.at(key).is_null()) << key;
  EXPECT_EQ(json.at("maps"), Json::array());
  EXPECT_EQ(said_of(json), "");
  for (const char* key : {"scale", "probability"}) {
    Json more = json;
    more[key] = 0.5;
    EXPECT_EQ(said_of(more), std::string(key) + " does not go with the parts");
  }
  EXPECT_EQ(component_on_plan({}), "");
}

TEST(PlanJson, TheComponentIsThatOfAPartOnThePlan) {
  MergeResult result = some_result();
  EXPECT_EQ(component_on_plan(result), "merged_2.yaml");
  result.plan->parts[0].reason = Reason::none;
  EXPECT_EQ(component_on_plan(result), "merged.yaml");
  result.plan->parts = {{{4}, {}, 1.0, 0.5, Reason::none}};  // the last one of the last component
  EXPECT_EQ(component_on_plan(result), "merged_2.yaml");
  result.components.pop_back();  // it is alone
  EXPECT_EQ(component_on_plan(result), "");
}

TEST(PlanJson, WhatIsToldTwiceHasToBeTheSame) {
  const Json json = some_json();
  const auto with = [&](const char* key, const Json& value) {
    Json other = json;
    other[key] = value;
    return said_of(other);
  };
  EXPECT_EQ(said_of(json), "");
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(with("probability", 0.875 + sign * 0.9e-9), "");
    EXPECT_EQ(with("probability", 0.875 + sign * 1.1e-9), "probability is not that of the surest part");
  }
  EXPECT_EQ(with("probability", nullptr), "probability does not go with the parts");
  EXPECT_EQ(with("component", nullptr), "component does not hold the maps on the plan");
  EXPECT_EQ(with("maps", {"c", "a"}), "maps does not go with the parts");
  EXPECT_EQ(with("maps", {"c", "a", "d", "b"}), "maps does not go with the parts");
  EXPECT_EQ(with("maps", {"c", "a", "b"}), "maps does not go with the parts");
  EXPECT_EQ(with("maps", {"b", "a", "d"}), "maps does not go with the parts");
}

TEST(PlanJson, NumbersLieWithinTheirBounds) {
  const auto with = [](const std::string& pointer, double value) {
    Json json = some_json();
    json[Json::json_pointer(pointer)] = value;
    return said_of(json);
  };
  for (const char* pointer : {"/scale", "/parts/1/scale"}) {
    EXPECT_EQ(with(pointer, 1e-3), "");
    EXPECT_EQ(with(pointer, 1e3), "");
    EXPECT_TRUE(contains(with(pointer, 0.9e-3), "scale lies outside [0.001, 1000]"));
    EXPECT_TRUE(contains(with(pointer, 1.1e3), "scale lies outside [0.001, 1000]"));
  }
  EXPECT_EQ(with("/resolution", 0.0), "");
  EXPECT_TRUE(contains(with("/resolution", -0.1), "resolution lies outside"));
  EXPECT_TRUE(contains(with("/parts/0/probability", 1.1), "parts[0].probability lies outside"));
}

TEST(PlanJson, AMapIsInOnePart) {
  Json json = some_json();
  json["parts"][0]["maps"] = {"a", "a"};
  EXPECT_EQ(said_of(json), "parts[2].maps[0] is in two parts: 'a'");
  json["parts"][0]["maps"] = {"a", "x"};
  EXPECT_EQ(said_of(json), "parts[0].maps[1] is none of the maps: 'x'");
}

}  // namespace
}  // namespace gridmerge
