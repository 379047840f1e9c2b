// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "gridmerge/report/merge_record.hpp"
#include "report/json_lines.hpp"
#include "report/results.hpp"

namespace gridmerge {

using namespace internal;

namespace {

MatchResult any_match() {
  MatchResult match;
  match.verdict = Verdict::accepted;
  match.T_fixed_moving = {1.25, -3.0, 0.52};
  match.probability = 0.998;
  match.acceptance_index = 0.964;
  match.agreement = 11372;
  match.disagreement = 422;
  match.overlap = 0.57;
  match.seconds = 0.021;
  match.hypotheses = {{{1.25, -3.0, 0.52}, 512.3, 0.998}, {{0.1, 1.0 / 3.0, -1e-7}, -4.0, 0.0}};
  return match;
}

TEST(MatchJson, IsTheDocumentedText) {
  EXPECT_EQ(
      match_json("a.yaml", "b.yaml", any_match()),
      R"({"fixed":"a.yaml","moving":"b.yaml","verdict":"accepted","reason":null,)"
      R"("transform":{"x":1.25,"y":-3.0,"theta":0.52},)"
      R"("probability":0.998,"acceptance_index":0.964,"agreement":11372,"disagreement":422,)"
      R"("overlap":0.57,"seconds":0.021,)"
      R"("hypotheses":[{"transform":{"x":1.25,"y":-3.0,"theta":0.52},"score":512.3,"probability":0.998},)"
      R"({"transform":{"x":0.1,"y":0.3333333333333333,"theta":-1e-07},"score":-4.0,"probability":0.0}]})"
      "\n");
}

TEST(MatchJson, HasScalesWhereTheyWereLookedFor) {
  MatchResult match = any_match();
  match.scale = 0.75;
  match.hypotheses[0].scale = 0.75;
  const nlohmann::json json = nlohmann::json::parse(match_json("a.yaml", "b.yaml", match, true));
  EXPECT_EQ(json["scale"], 0.75);
  EXPECT_EQ(json["hypotheses"][0]["scale"], 0.75);
  EXPECT_EQ(json["hypotheses"][1]["scale"], 1.0);
  EXPECT_FALSE(nlohmann::json::parse(match_json("a.yaml", "b.yaml", match)).contains("scale"));
}

TEST(MatchJson, OfARefusedPairWithNothingToGoBy) {
  EXPECT_EQ(
      match_json("a", "b", {}),
      R"({"fixed":"a","moving":"b","verdict":"refused","reason":"nothing_to_compare",)"
      R"("transform":{"x":0.0,"y":0.0,"theta":0.0},)"
      R"("probability":0.0,"acceptance_index":0.0,"agreement":0,"disagreement":0,"overlap":0.0,"seconds":0.0,)"
      R"("hypotheses":[]})"
      "\n");
}

TEST(MatchJson, HasNoNegativeZero) {
  MatchResult match;
  match.T_fixed_moving = {-0.0, -0.0, -0.0};
  EXPECT_EQ(match_json("a", "b", match).find("-0"), std::string::npos);
}

TEST(MatchJson, RefusesWhatIsNotFinite) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MatchResult match = any_match();
    match.probability = value;
    EXPECT_THROW(match_json("a", "b", match), std::invalid_argument);
    match = any_match();
    match.hypotheses[1].T_fixed_moving.theta = value;
    EXPECT_THROW(match_json("a", "b", match), std::invalid_argument);
  }
}

TEST(MatchJson, TakesAnyName) {
  for (const std::string& name : test::kHostileNames) {
    const std::string text = match_json(name, "b", any_match());
    EXPECT_EQ(text.find('\n'), text.size() - 1) << "one line";
    const auto json = nlohmann::json::parse(text);  // throws for what is no UTF-8
    if (name.find('\xff') == std::string::npos) {
      EXPECT_EQ(json["fixed"], name);
    }
  }
  EXPECT_EQ(nlohmann::json::parse(match_json("\xff.yaml", "b", {}))["fixed"], "\xef\xbf\xbd.yaml");
}

JointMeasure any_measure() {
  PoseMeasure pair;
  pair.T_fixed_moving = {1.25, -3.0, 0.5};
  pair.cells = 100;
  pair.similarity.omega = 75;
  pair.similarity.fixed_to_moving_occupied = {3, 2};
  pair.similarity.moving_to_fixed_occupied = {1, 4};
  pair.similarity.agreement = 12;
  pair.similarity.disagreement = 4;
  pair.common = {2, 10, 4};
  pair.engine.probability = 0.125;
  return {75, 100, {pair}};
}

TEST(MeasureJson, HasTheDocumentedKeys) {
  const std::string text = measure_json("a.yaml", {"b.yaml"}, any_measure(), 7.5);
  const std::string documented =
      R"({"fixed":"a.yaml","moving":"b.yaml","transform":{"x":1.25,"y":-3.0,"theta":0.5},"omega":75,"cells":100,)"
      R"("psi":1.75,"psi_terms":{"fixed_moving_occupied":1.5,"fixed_moving_free":null,)"
      R"("moving_fixed_occupied":0.25,"moving_fixed_free":null},"agreement":12,"disagreement":4,"delta":-58.25,)"
      R"("c_lock":7.5,"acceptance_index":0.75,)"
      R"("common":{"occupied_occupied":2,"free_free":10,"contradicting":4},)"
      R"("engine":{"probability":0.125,"figures":{"score":0.0,)";
  EXPECT_EQ(text.substr(0, documented.size()), documented);
  EXPECT_EQ(nlohmann::json::parse(text).at("engine").at("figures").size(), pose_figures().size());
}

TEST(MeasureJson, OfSeveralMapsListsEach) {
  JointMeasure joint = any_measure();
  joint.omega = 60;
  joint.pairs.push_back(joint.pairs.front());
  const auto json = nlohmann::json::parse(measure_json("a", {"b", "c"}, joint, 0.0));
  EXPECT_EQ(json.at("omega"), 60);
  EXPECT_EQ(json.at("pairs").at(1).at("omega"), 75);
  EXPECT_EQ(json.at("pairs").at(1).at("moving"), "c");
  EXPECT_THROW(measure_json("a", {"b"}, joint, 0.0), std::out_of_range);
}

TEST(TransformsJson, OmegaThatCannotBeCountedIsNull) {
  const std::vector<OccupancyGrid> maps(2, make_grid(1, 1, 1.0, {}, Cell::free));
  MergeResult result = test::merged(maps, {{{0, {}}, {1, {}}}});
  result.components[0].fused.omega = std::nullopt;
  const auto json = nlohmann::json::parse(transforms_json({"a", "b"}, result));
  EXPECT_TRUE(json.at("components").at(0).at("omega").is_null());
  EXPECT_TRUE(json.at("components").at(0).at("omega_share").is_null());
}

TEST(TransformsJson, IsTheDocumentedText) {
  const std::vector<OccupancyGrid> maps(4, make_grid(1, 1, 1.0, {}, Cell::free));
  MergeResult result = test::merged(maps, {{{0, {}}, {2, {1.25, -3.0, 0.52}}}});
  Join refused;
  refused.moving = 1;
  refused.T_fixed_moving = {0.5, 0.25, 3.0};
  refused.probability = 0.125;
  refused.match.reason = Reason::ambiguous;
  refused.acceptance_index = 0.75;
  refused.agreement = 12;
  refused.disagreement = 4;
  refused.overlap = 0.25;
  refused.match.hypotheses = {{{0.5, 0.25, 3.0}, 10.5, 0.125}};
  result.joins.front().outcome = JoinOutcome::rescued;
  result.joins.front().match.verdict = Verdict::refused;
  result.joins.front().match.reason = Reason::too_little_overlap;
  result.joins.insert(result.joins.begin(), refused);
  result.components[0].members[1].probability = 0.875;
  result.components[0].members[1].sd = PoseDeviation{0.125, 0.0625};
  result.left_out.front().reason = Reason::ambiguous;
  result.open_ways = {{1, 3, {4.0, 0.5, -1.5}, 0.25}};
  result.components[0].fused = {make_grid(5, 4, 1.0), 0, 0, EqualCells{5, 20}};
  EXPECT_EQ(transforms_json({"a.yaml", "b.yaml", "c.yaml", "d.yaml"}, result), R"({
  "maps": [
    "a.yaml",
    "b.yaml",
    "c.yaml",
    "d.yaml"
  ],
  "components": [
    {
      "map": "merged.yaml",
      "frame": "a.yaml",
      "members": [
        {
          "source": "a.yaml",
          "transform": {
            "x": 0.0,
            "y": 0.0,
            "theta": 0.0
          },
          "probability": null,
          "sd": null
        },
        {
          "source": "c.yaml",
          "transform": {
            "x": 1.25,
            "y": -3.0,
            "theta": 0.52
          },
          "probability": 0.875,
          "sd": {
            "position": 0.125,
            "theta": 0.0625
          }
        }
      ],
      "omega": 5,
      "cells": 20,
      "omega_share": 0.25
    }
  ],
  "joins": [
    {"fixed":"a.yaml","moving":"b.yaml","transform":{"x":0.5,"y":0.25,"theta":3.0},"verdict":"refused","probability":0.125,"outcome":"refused","reason":"ambiguous","by_themselves":{"verdict":"refused","reason":"ambiguous"},"acceptance_index":0.75,"agreement":12,"disagreement":4,"overlap":0.25,"hypotheses":[{"transform":{"x":0.5,"y":0.25,"theta":3.0},"score":10.5,"probability":0.125}]},
    {
      "fixed": "a.yaml",
      "moving": "c.yaml",
      "transform": {
        "x": 1.25,
        "y": -3.0,
        "theta": 0.52
      },
      "verdict": "accepted",
      "probability": 0.75,
      "outcome": "rescued",
      "reason": null,
      "by_themselves": {
        "verdict": "refused",
        "reason": "too_little_overlap"
      },
      "acceptance_index": 0.0,
      "agreement": 0,
      "disagreement": 0,
      "overlap": 0.0,
      "hypotheses": []
    }
  ],
  "left_out": [
    "b.yaml",
    "d.yaml"
  ],
  "left_out_maps": [
    {
      "source": "b.yaml",
      "reason": "ambiguous"
    },
    {
      "source": "d.yaml",
      "reason": "nothing_to_compare"
    }
  ],
  "open_ways": [
    {
      "fixed": "b.yaml",
      "moving": "d.yaml",
      "transform": {
        "x": 4.0,
        "y": 0.5,
        "theta": -1.5
      },
      "probability": 0.25
    }
  ],
  "expected_false_joins": null
}
)");
}

TEST(TransformsJson, NamesTheMapOfEveryComponent) {
  const std::vector<OccupancyGrid> maps(4, make_grid(1, 1, 1.0, {}, Cell::free));
  const MergeResult result = test::merged(maps, {{{0, {}}, {2, {}}}, {{1, {}}, {3, {}}}});
  const auto json = nlohmann::json::parse(transforms_json({"a", "b", "c", "d"}, result));
  EXPECT_EQ(json["components"][0]["map"], "merged.yaml");
  EXPECT_EQ(json["components"][1]["map"], "merged_2.yaml");
  EXPECT_EQ(json["components"][1]["members"][0]["source"], "b");
}

TEST(TransformsJson, OfNothing) {
  EXPECT_EQ(transforms_json({}, {}),
            "{\n  \"maps\": [],\n  \"components\": [],\n  \"joins\": [],\n  \"left_out\": [],\n  "
            "\"left_out_maps\": [],\n  \"open_ways\": [],\n  \"expected_false_joins\": null\n}\n");
}

TEST(TransformsJson, EveryMapNeedsAName) {
  MergeResult result;
  result.left_out = {{0}, {1}};
  EXPECT_THROW(transforms_json({"a"}, result), std::out_of_range);
}

}  // namespace
}  // namespace gridmerge
