// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/tables.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace gridmerge {
namespace {

using Json = nlohmann::json;

Evaluation sample() {
  MatchOutcome right;
  right.fixed = "a.yaml";
  right.moving = "b.yaml";
  right.tier = "A";
  right.verdict = Verdict::accepted;
  right.probability = 0.97;
  right.error = 0.25;
  right.tolerance = 0.5;
  right.seconds = 0.25;
  MatchOutcome blank = right;  // a map with nothing to go by
  blank.moving = "blank.yaml";
  blank.tier = "C";
  blank.verdict = Verdict::refused;
  blank.probability = 0.0;
  blank.error.reset();
  blank.seconds = 0.5;
  MatchOutcome negative;
  negative.fixed = "a.yaml";
  negative.moving = "other.yaml";
  negative.verdict = Verdict::accepted;
  negative.probability = 0.93;
  negative.seconds = 0.5;
  return {{right, blank, negative}, {{"s", 4, 2, 1, 1}}};
}

TEST(EvaluationJson, HasExactlyTheKeysOfTheContract) {
  EXPECT_EQ(Json::parse(evaluation_json(sample())), Json::parse(R"({
    "pairs": {"total": 2, "accepted_correct": 1, "accepted_wrong": 0, "refused": 1, "best_correct": 1},
    "negatives": {"total": 1, "accepted": 1},
    "sets": {"total": 1, "maps": 4, "maps_correct": 2, "maps_wrong": 1, "maps_left_out": 1, "complete": 0},
    "seconds": {"median": 0.5, "p90": 0.5, "max": 0.5},
    "cases": [
      {"fixed": "a.yaml", "moving": "b.yaml", "verdict": "accepted", "probability": 0.97, "error": 0.25,
       "tolerance": 0.5, "correct": true, "seconds": 0.25},
      {"fixed": "a.yaml", "moving": "blank.yaml", "verdict": "refused", "probability": 0.0, "error": null,
       "tolerance": 0.5, "correct": false, "seconds": 0.5},
      {"fixed": "a.yaml", "moving": "other.yaml", "verdict": "accepted", "probability": 0.93, "error": null,
       "tolerance": null, "correct": null, "seconds": 0.5}]})"));
}

TEST(EvaluationJson, OfNothingHasTheSameKeys) {
  const Json json = Json::parse(evaluation_json({}));
  const Json full = Json::parse(evaluation_json(sample()));
  for (const auto& [key, value] : full.items()) {
    ASSERT_TRUE(json.contains(key)) << key;
    if (key == "cases") continue;
    for (const auto& [inner, number] : value.items())
      EXPECT_EQ(json[key].at(inner), 0) << key << "." << inner;
  }
  EXPECT_TRUE(json["cases"].empty());
}

TEST(EvaluationJson, IsJsonEvenWhenAFileNameIsNotUtf8) {
  Evaluation evaluation = sample();
  evaluation.matches[0].fixed = "caf\xe9.yaml";
  EXPECT_TRUE(Json::accept(evaluation_json(evaluation)));
}

TEST(SummaryTable, CountsByTierAndMarksTheThresholdInUse) {
  const std::string table = summary_table(sample(), 0.9);
  EXPECT_NE(table.find("pairs             2          1          0          1          1\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("  A               1          1          0          0          1\n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("negatives         1                     1          0           \n"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("0.9            used          1          0          1\n"), std::string::npos) << table;
  EXPECT_NE(table.find("sets              1          0          4          2          1          1\n"),
            std::string::npos)
      << table;
}

TEST(SummaryTable, AddsTheThresholdInUse) {
  EXPECT_NE(summary_table(sample(), 0.95).find("0.95           used"), std::string::npos);
  EXPECT_NE(summary_table(sample(), 0.965).find("0.965          used"), std::string::npos);
}

TEST(SummaryTable, LeavesOutWhatWasNotAsked) {
  Evaluation evaluation = sample();
  evaluation.matches.clear();
  EXPECT_EQ(summary_table(evaluation, 0.9).find("pairs"), std::string::npos);
  evaluation = sample();
  evaluation.sets.clear();
  EXPECT_EQ(summary_table(evaluation, 0.9).find("sets"), std::string::npos);
  EXPECT_EQ(summary_table({}, 0.9), "nothing to evaluate\n");
}

TEST(CaseTable, HasALineForEachMatchAndSet) {
  EXPECT_EQ(case_table(sample()),
            "accepted 0.9700  correct            0.250 s  a.yaml b.yaml\n"
            "refused  0.0000  no hypothesis      0.500 s  a.yaml blank.yaml\n"
            "accepted 0.9300  unrelated          0.500 s  a.yaml other.yaml\n"
            "set s: 4 maps, 2 correct, 1 wrong, 1 left out\n");
}

}  // namespace
}  // namespace gridmerge
