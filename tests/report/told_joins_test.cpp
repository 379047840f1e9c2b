// SPDX-License-Identifier: Apache-2.0
#include "report/told_joins.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/io/file_error.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "io/support.hpp"
#include "report/fleet.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using Json = nlohmann::json;
using test::contains;
using test::fleet;
using test::fleet_names;
using test::message_of;

MergeRecord parse(const std::string& text) {
  return parse_transforms("transforms.json", text);
}

std::size_t refused_in(const MergeResult& result) {
  std::size_t count = 0;
  for (const Join& join : result.joins) count += join.outcome == JoinOutcome::refused ? 1 : 0;
  for (const RefusedCount& more : result.refused_more) count += more.count;
  return count;
}

TEST(ToldJoins, OfFiftyMapsAreAll) {
  const MergeResult result = fleet(50, 1);
  ASSERT_EQ(result.joins.size(), kMostToldInFull);
  const ToldJoins told = tell_joins(result);
  EXPECT_TRUE(told.in_full);
  EXPECT_EQ(told.objects.size(), result.joins.size());
  EXPECT_TRUE(told.rows.empty());
  EXPECT_TRUE(told.counts.empty());
  const Json json = Json::parse(transforms_json(fleet_names(50), result));
  EXPECT_EQ(json["joins"].size(), result.joins.size());
  EXPECT_FALSE(json.contains("refused"));
}

TEST(ToldJoins, OfManyMapsAreThoseThatMatter) {
  const MergeResult result = fleet(120, 1);
  const ToldJoins told = tell_joins(result);
  ASSERT_FALSE(told.in_full);
  std::set<std::size_t> objects(told.objects.begin(), told.objects.end());
  std::set<std::size_t> rows(told.rows.begin(), told.rows.end());
  ASSERT_GT(rows.size(), 0u);
  ASSERT_EQ(result.open_ways.size(), 1u);
  std::size_t others = 0;
  for (std::size_t i = 0; i < result.joins.size(); ++i) {
    const Join& join = result.joins[i];
    const bool is_open = join.fixed == result.open_ways[0].fixed && join.moving == result.open_ways[0].moving;
    const bool matters = join.outcome != JoinOutcome::refused || is_open;
    EXPECT_EQ(objects.count(i) > 0, matters);
    EXPECT_EQ(rows.count(i) > 0, !matters && join.probability >= 0.01);
    others += matters ? 0 : 1;
  }
  std::size_t counted = 0;
  for (const RefusedCount& refused : told.counts) counted += refused.count;
  EXPECT_EQ(counted, others);
}

TEST(ToldJoins, TellTheHypothesesThatMayBeTrueAndTheOneThatWasUsed) {
  Join join;
  const auto places = [](const std::vector<Hypothesis>& told) {
    std::vector<double> xs;
    for (const Hypothesis& one : told) xs.push_back(one.T_fixed_moving.x);
    return xs;
  };
  using Places = std::vector<double>;
  for (const double probability : {0.5, 0.2, 0.1, 0.05, 0.001, 0.0001}) {
    Hypothesis one;
    one.T_fixed_moving.x = static_cast<double>(join.match.hypotheses.size());
    one.probability = probability;
    join.match.hypotheses.push_back(one);
  }
  join.T_fixed_moving.x = 4.0;
  for (const JoinOutcome outcome : {JoinOutcome::refused, JoinOutcome::rejected, JoinOutcome::accepted}) {
    join.outcome = outcome;
    EXPECT_EQ(places(told_hypotheses(join, true)),
              outcome == JoinOutcome::refused ? (Places{0, 1, 2}) : (Places{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(places(told_hypotheses(join, false)),
              outcome == JoinOutcome::accepted ? (Places{0, 1, 2, 4}) : (Places{0, 1, 2}));
  }
  // The best is told, however unlikely.
  join.outcome = JoinOutcome::refused;
  for (Hypothesis& one : join.match.hypotheses) one.probability *= 0.001;
  EXPECT_EQ(places(told_hypotheses(join, false)), Places{0});
  join.match.hypotheses.clear();
  EXPECT_TRUE(told_hypotheses(join, false).empty());
}

TEST(ToldJoins, HaveRowsForTheMostProbableAlone) {
  MergeResult result = fleet(150, 1);
  for (Join& join : result.joins) {
    if (join.outcome == JoinOutcome::refused)
      join.probability = 0.02 + 1e-6 * static_cast<double>(join.moving);
  }
  const ToldJoins told = tell_joins(result);
  ASSERT_EQ(told.rows.size(), kMostRows);
  const std::set<std::size_t> rows(told.rows.begin(), told.rows.end());
  double least_told = 1.0, most_untold = 0.0;
  for (std::size_t i = 0; i < result.joins.size(); ++i) {
    const Join& join = result.joins[i];
    if (join.outcome != JoinOutcome::refused) continue;
    if (rows.count(i) > 0) least_told = std::min(least_told, join.probability);
    if (std::count(told.objects.begin(), told.objects.end(), i) == 0 && rows.count(i) == 0)
      most_untold = std::max(most_untold, join.probability);
  }
  EXPECT_GE(least_told, most_untold);
}

TEST(ToldJoins, AreReadAsTheyWereWritten) {
  const std::vector<std::string> names = fleet_names(120);
  const MergeResult written = fleet(120, 1);
  const std::string text = transforms_json(names, written);
  const MergeRecord read = parse(text);
  EXPECT_EQ(transforms_json(read.names, read.result), text);
  EXPECT_EQ(refused_in(read.result), refused_in(written));
  for (const Join& join : read.result.joins) {
    const auto original = std::find_if(written.joins.begin(), written.joins.end(), [&](const Join& other) {
      return other.fixed == join.fixed && other.moving == join.moving;
    });
    ASSERT_NE(original, written.joins.end());
    EXPECT_EQ(join.outcome, original->outcome);
    EXPECT_EQ(join.T_fixed_moving, original->T_fixed_moving);
    EXPECT_EQ(join.probability, original->probability);
    EXPECT_EQ(join.reason(), original->reason());
    if (join.used()) {
      EXPECT_EQ(deviation_of(join), deviation_of(*original));
    }
  }
  const ToldJoins told = tell_joins(read.result);
  EXPECT_EQ(told.counts, tell_joins(written).counts);
}

TEST(ToldJoins, KeepTheContractOfJoins) {
  const Json json = Json::parse(transforms_json(fleet_names(120), fleet(120, 1)));
  ASSERT_GT(json["joins"].size(), 100u);
  for (const Json& join : json["joins"]) {
    for (const char* key : {"fixed", "moving", "transform", "verdict", "probability"})
      EXPECT_TRUE(join.contains(key)) << key;
    EXPECT_EQ(join["verdict"] == "accepted", join.contains("sd"));
  }
  const std::vector<std::string> columns{"fixed", "moving", "reason", "probability", "x", "y", "theta"};
  EXPECT_EQ(json["refused"]["columns"], Json(columns));
}

TEST(ToldJoins, OfAThousandMapsTakeFewBytes) {
  const std::vector<std::string> names = fleet_names(1000);
  for (const std::size_t every : {1u, 24u}) {
    const std::string text = transforms_json(names, fleet(1000, every));
    EXPECT_LT(text.size(), 5'000'000u) << "one pair in " << every;
    EXPECT_EQ(parse(text).names, names);
  }
}

TEST(ToldJoins, ThatMakeNoSenseAreErrors) {
  const Json good = Json::parse(transforms_json(fleet_names(60), fleet(60, 1)));
  ASSERT_GT(good["refused"]["rows"].size(), 0u);
  const auto error_of = [&](const std::string& pointer, const Json& value) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    return message_of<FileError>([&] { parse(bad.dump()); });
  };
  const auto expect = [&](const std::string& pointer, const Json& value, const std::string& what) {
    EXPECT_TRUE(contains(error_of(pointer, value), what)) << error_of(pointer, value);
  };
  expect("/refused/rows/0/0", 60, "refused.rows[0][0] is no number of a map");
  expect("/refused/rows/0/0", -1, "refused.rows[0][0] is no whole number");
  expect("/refused/rows/0/1", good["refused"]["rows"][0][0], "refused.rows[0] is of a map and itself");
  expect("/refused/rows/0/2", "tired", "refused.rows[0][2] is unknown: 'tired'");
  expect("/refused/rows/0/2", "none", "refused.rows[0][2] is none");
  expect("/refused/rows/0/3", 1.5, "refused.rows[0][3] lies outside");
  expect("/refused/rows/0/6", 4.0, "refused.rows[0][6] lies outside");
  expect("/refused/rows/0", Json::array({1, 2}), "refused.rows[0] has no element 2");
  expect("/refused/columns/3", "odds", "refused.columns has no 'probability'");
  expect("/refused/columns", Json::array(), "refused.columns has no element 0");
  expect("/refused/count", 3, "refused.count is not the sum of the reasons");
  expect("/refused/reasons/ambiguous", 0, "refused.reasons.ambiguous is less than its rows");
  expect("/refused", 7, "refused is no object");
  expect("/joins/0/sd", -1.0, "joins[0].sd lies outside");
  for (const char* key : {"count", "reasons", "columns", "rows"}) {
    Json bad = good;
    bad["refused"].erase(key);
    const std::string error = message_of<FileError>([&] { parse(bad.dump()); });
    EXPECT_TRUE(contains(error, std::string("refused.") + key + " is missing")) << error;
  }
}

TEST(ToldJoins, MayHaveColumnsThatNobodyKnowsYet) {
  const Json good = Json::parse(transforms_json(fleet_names(60), fleet(60, 1)));
  Json wider = good;
  wider["refused"]["columns"].insert(wider["refused"]["columns"].begin(), "overlap");
  for (Json& row : wider["refused"]["rows"]) row.insert(row.begin(), 0.5);
  const MergeRecord read = parse(wider.dump()), usual = parse(good.dump());
  EXPECT_EQ(transforms_json(read.names, read.result), transforms_json(usual.names, usual.result));
}

/// Refused joins of many maps, of a probability each.
MergeResult refused_joins(const std::vector<double>& probabilities) {
  MergeResult result;
  for (const double probability : probabilities) {
    Join join;
    join.fixed = result.joins.size();
    join.moving = join.fixed + 1;
    join.probability = probability;
    join.match.reason = Reason::ambiguous;
    result.joins.push_back(join);
  }
  return result;
}

TEST(ToldJoins, AreToldInFullUpToTheComparisonsOfFiftyMaps) {
  MergeResult result = refused_joins({0.5, 0.25, 0.001});
  result.refused_more = {{Reason::several, kMostToldInFull - 3}};
  const ToldJoins all = tell_joins(result);
  EXPECT_TRUE(all.in_full);
  EXPECT_EQ(all.objects, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(all.rows.empty());
  EXPECT_EQ(all.counts, (std::vector<RefusedCount>{{Reason::several, kMostToldInFull - 3}}));
  result.refused_more[0].count += 1;
  const ToldJoins some = tell_joins(result);
  EXPECT_FALSE(some.in_full);
  EXPECT_TRUE(some.objects.empty());
  EXPECT_EQ(some.rows, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(some.counts,
            (std::vector<RefusedCount>{{Reason::ambiguous, 3}, {Reason::several, kMostToldInFull - 2}}));
}

TEST(ToldJoins, AreCountedByReasonInItsOrder) {
  MergeResult result = refused_joins({0.01, 0.0099});
  result.refused_more = {{Reason::over_budget, 1500},
                         {Reason::contradiction, 0},
                         {Reason::ambiguous, 4},
                         {Reason::nothing_to_compare, 2},
                         {Reason::ambiguous, 5}};
  result.joins[0].match.reason = Reason::too_little_overlap;
  const ToldJoins told = tell_joins(result);
  EXPECT_EQ(told.counts, (std::vector<RefusedCount>{{Reason::nothing_to_compare, 2},
                                                    {Reason::ambiguous, 10},
                                                    {Reason::too_little_overlap, 1},
                                                    {Reason::over_budget, 1500}}));
  EXPECT_EQ(told.rows, std::vector<std::size_t>{0}) << "of 0.01 or more";
}

TEST(ToldJoins, OfEquallyProbableOnesTheFirstHaveRows) {
  // A quarter each of 12000 has one of four probabilities, in turn: there is room for the most probable 3000
  // and for 2000 of the next.
  std::vector<double> probabilities;
  std::vector<std::size_t> expected;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 12000; ++i) {
    const std::size_t turn = 7919 * i % 4;
    probabilities.push_back(0.1 * static_cast<double>(1 + turn));
    if (turn == 3 || (turn == 2 && next++ < kMostRows - 3000)) expected.push_back(i);
  }
  ASSERT_EQ(expected.size(), kMostRows);
  EXPECT_TRUE(tell_joins(refused_joins(probabilities)).rows == expected);
  // As many as have room, and one more, which is the least probable.
  std::vector<double> exact(kMostRows, 0.5);
  EXPECT_EQ(tell_joins(refused_joins(exact)).rows.size(), kMostRows);
  exact.insert(exact.begin(), 0.01);
  const std::vector<std::size_t> rows = tell_joins(refused_joins(exact)).rows;
  ASSERT_EQ(rows.size(), kMostRows);
  EXPECT_EQ(rows.front(), 1u);
}

TEST(ToldJoins, OnesOfOpenWaysAreThoseOfTheSameTwoMapsInTheirOrder) {
  MergeResult result = refused_joins(std::vector<double>(kMostToldInFull + 1, 0.5));
  result.open_ways = {{7, 8, {}, 0.5}, {5, 4, {}, 0.5}, {2, 4, {}, 0.5}};
  result.joins[9].outcome = JoinOutcome::rejected;
  result.joins[3].outcome = JoinOutcome::known;
  const ToldJoins told = tell_joins(result);
  EXPECT_EQ(told.objects, (std::vector<std::size_t>{3, 7, 9}));
  EXPECT_EQ(told.rows.size(), result.joins.size() - 3);
}

TEST(ToldJoins, OfManyLikelyHypothesesThreeAreTold) {
  Join join;
  for (const double probability : {0.4, 0.01, 0.0099, 0.02, 0.03}) {
    Hypothesis one;
    one.T_fixed_moving.x = static_cast<double>(join.match.hypotheses.size());
    one.probability = probability;
    join.match.hypotheses.push_back(one);
  }
  std::vector<double> told;
  for (const Hypothesis& one : told_hypotheses(join, true)) told.push_back(one.T_fixed_moving.x);
  EXPECT_EQ(told, (std::vector<double>{0, 1, 3}));
}

TEST(Deviations, AreThoseOfTheHypothesisThatTheJoinHas) {
  Join join;
  EXPECT_EQ(deviation_of(join), std::nullopt);
  for (const double x : {1.0, 2.0, 2.0}) {
    Hypothesis one;
    one.T_fixed_moving.x = x;
    one.figures.sigma = 10.0 * x;
    join.match.hypotheses.push_back(one);
  }
  EXPECT_EQ(deviation_of(join), std::nullopt);  // none lies so
  join.T_fixed_moving.x = 2.0;
  EXPECT_EQ(deviation_of(join), 2.0 * 20.0);  // walls are known half as well as that
  join.match.hypotheses[1].figures.sigma = 0.0;
  join.match.hypotheses[2].figures.sigma = 0.25;
  EXPECT_EQ(deviation_of(join), 0.5);
  join.match.hypotheses[2].figures.sigma = 0.0;
  EXPECT_EQ(deviation_of(join), std::nullopt);
  set_deviation(join, 3.0);
  EXPECT_EQ(deviation_of(join), 3.0);
  EXPECT_EQ(join.match.hypotheses[0].figures.sigma, 10.0);
}

}  // namespace
}  // namespace gridmerge
