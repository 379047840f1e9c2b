// SPDX-License-Identifier: Apache-2.0
#include "evaluate/tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "match/verdict.hpp"

namespace gridmerge {

using namespace internal;
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

TEST(CaseTable, ShowsAnyNameOnALine) {
  Evaluation evaluation = sample();
  evaluation.matches[0].fixed = "a\x1b[2J.yaml";
  evaluation.matches[0].moving = "b\x1b.yaml";
  evaluation.matches[0].tier = "\x1b";
  evaluation.sets[0].name = "s\x1b";
  const std::string text = case_table(evaluation) + summary_table(evaluation, 0.95);
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
  EXPECT_NE(text.find("a\\x1b[2J.yaml b\\x1b.yaml\n"), std::string::npos) << text;
}

TEST(CaseTable, LetsNoProbabilityLookHigherThanItIs) {
  Evaluation evaluation = sample();
  evaluation.matches[0].verdict = Verdict::refused;
  evaluation.matches[0].probability = 0.949999;
  EXPECT_NE(case_table(evaluation).find("refused  0.9499 "), std::string::npos) << case_table(evaluation);
  evaluation.matches[0].probability = 0.57;  // no less than four digits say
  EXPECT_NE(case_table(evaluation).find("refused  0.5700 "), std::string::npos) << case_table(evaluation);
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

TEST(SummaryTable, SweepsTheProbability) {
  const std::string table = summary_table(sample(), 0.9);
  std::istringstream rows(table.substr(table.find("at least")));
  std::string line;
  std::getline(rows, line);
  // A correct one at 0.97, one without an error at 0, and a negative at 0.93, from each threshold on.
  const std::vector<std::vector<double>> expected{
      {0.0, 1, 1, 1}, {0.25, 1, 0, 1}, {0.5, 1, 0, 1},  {0.75, 1, 0, 1},  {0.8, 1, 0, 1},
      {0.9, 1, 0, 1}, {0.95, 1, 0, 0}, {0.99, 0, 0, 0}, {0.999, 0, 0, 0}, {0.9999, 0, 0, 0}};
  for (const std::vector<double>& row : expected) {
    std::getline(rows, line);
    const std::size_t mark = line.find("used");
    EXPECT_EQ(mark != std::string::npos, row[0] == 0.9) << line;
    if (mark != std::string::npos) line.replace(mark, 4, "");
    std::istringstream words(line);
    for (const double value : row) {
      double found = -1.0;
      words >> found;
      EXPECT_EQ(found, value) << line;
    }
  }
  std::getline(rows, line);
  EXPECT_EQ(line, "area under the ROC of the probability: 1.0000");
  EXPECT_NE(table.find("\nseconds per match: median 0.500, 90 % 0.500, max 0.500\n\n"), std::string::npos)
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

/// The cells of a line of tab-separated text.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, '\t');) cells.push_back(cell);
  return cells;
}

TEST(FeaturesTable, HasARowForEachHypothesisWithEveryFigureAndTerm) {
  Evaluation evaluation = sample();
  Hypothesis hypothesis{{1.5, -2.0, 0.25}, 7.0, 0.5};
  for (std::size_t i = 0; i < pose_figures().size(); ++i)
    hypothesis.figures.*pose_figures()[i].value = 0.125 * static_cast<double>(i + 1);
  evaluation.matches[0].hypotheses = {{hypothesis, 0.5}, {hypothesis, 0.75}};  // the tolerance is 0.5
  evaluation.matches[2].hypotheses = {{hypothesis, {}}};
  std::istringstream lines(features_table(evaluation));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(cells_of(line));
  ASSERT_EQ(rows.size(), 4U);
  const std::vector<std::string>& head = rows[0];
  EXPECT_EQ(head.size(), 9 + pose_figures().size() + verdict_terms().size() + rank_terms().size());
  const auto cell = [&](std::size_t row, const std::string& name) {
    const auto found = std::find(head.begin(), head.end(), name);
    return found == head.end() ? "no column" : rows[row].at(static_cast<std::size_t>(found - head.begin()));
  };
  const std::vector<std::string> names{"a.yaml", "a.yaml", "a.yaml"}, numbers{"1", "2", "1"},
      truths{"right", "wrong", "negative"}, errors{"0.5", "0.75", "-1"};
  for (std::size_t row = 1; row <= 3; ++row) {
    EXPECT_EQ(rows[row].size(), head.size());
    EXPECT_EQ(cell(row, "fixed"), names[row - 1]);
    EXPECT_EQ(cell(row, "hypothesis"), numbers[row - 1]);
    EXPECT_EQ(cell(row, "truth"), truths[row - 1]);
    EXPECT_EQ(cell(row, "error"), errors[row - 1]);
    EXPECT_EQ(cell(row, "x"), "1.5");
    EXPECT_EQ(cell(row, "y"), "-2");
    EXPECT_EQ(cell(row, "theta"), "0.25");
    for (const PoseFigure& figure : pose_figures())
      EXPECT_EQ(std::stod(cell(row, figure.name)), hypothesis.figures.*figure.value) << figure.name;
    for (const VerdictTerm& term : verdict_terms())
      EXPECT_NEAR(std::stod(cell(row, std::string("term: ") + term.name)), term(hypothesis.figures), 1e-12);
    for (const RankTerm& term : rank_terms())
      EXPECT_NEAR(std::stod(cell(row, std::string("rank: ") + term.name)), term.value(hypothesis.figures),
                  1e-12);
  }
  EXPECT_EQ(cell(1, "tier"), "A");
  EXPECT_EQ(cell(3, "moving"), "other.yaml");
}

TEST(CaseTable, SaysByHowMuchAPairIsOff) {
  Evaluation evaluation = sample();
  evaluation.matches[0].error = 0.75;
  EXPECT_EQ(case_table(evaluation).find("accepted 0.9700  off by 0.75 m      0.250 s  a.yaml b.yaml\n"), 0U)
      << case_table(evaluation);
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
