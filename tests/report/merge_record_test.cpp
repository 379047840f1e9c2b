// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/report/merge_record.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/io/map_file.hpp"
#include "io/support.hpp"
#include "merge/drawing.hpp"
#include "report/page.hpp"
#include "report/results.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using Json = nlohmann::json;
using test::contains;
using test::map_from;
using test::message_of;

const std::vector<OccupancyGrid> kMaps{map_from({"#..", ".##"}, 0.05),        map_from({"#", "."}, 0.1),
                                       map_from({".#.", "...", " .#"}, 0.05), map_from({"..", "#."}, 0.05),
                                       map_from({"..", "#."}, 0.05),          map_from({".#", "#."}, 0.05)};
const std::vector<std::string> kNames{"a.yaml", "b \"<&>\n.yaml", "c.yaml", "d.yaml", "e.yaml", "f.yaml"};

/// Two components and two maps that were left out, with all that a record can hold.
MergeResult any_result() {
  MergeResult result =
      test::merged(kMaps, {{{0, {}, 1.0 / 3.0}, {2, {1.25, -3.0, 0.5}, 0.875, PoseDeviation{0.125, 0.25}}},
                           {{3, {7.0, 8.0, 3.0}}, {5, {7.0 / 3.0, 8.0, -3.0}}}});
  result.components[1].in_world_frame = true;
  Join refused;
  refused.moving = 1;
  refused.T_fixed_moving = {1e-7, 0.1, 3.0};
  refused.probability = 0.0625;
  refused.match.reason = Reason::too_little_overlap;
  refused.acceptance_index = 0.8125;
  refused.agreement = 13;
  refused.disagreement = 3;
  refused.overlap = 0.1;
  refused.match.hypotheses = {{{1e-7, 0.1, 3.0}, 10.0, 0.0625}, {{7.0, 8.0, -1.0}, -9.5, 0.0}};
  result.joins.push_back(refused);
  for (const JoinOutcome outcome : {JoinOutcome::known, JoinOutcome::rescued, JoinOutcome::rejected}) {
    refused.moving += 1;
    refused.outcome = outcome;
    if (outcome == JoinOutcome::rejected) refused.match.verdict = Verdict::accepted;
    result.joins.push_back(refused);
  }
  result.left_out.back().reason = Reason::contradicts_others;
  result.plan = PlanPlacement{"plan <1>.png",
                              1.0 / 3.0,
                              {{{0, 2}, {4.0, 0.1, 1.0}, 1.5, 0.125, Reason::ambiguous},
                               {{1}, {}, 1.0, 0.0, Reason::nothing_to_compare},
                               {{3, 5}, {7.0, 8.0, 3.0}, 1.25, 0.9375, Reason::none},
                               {{4}, {1.0, 2.0, -1.0}, 0.75, 0.5, Reason::several}},
                              0.05};
  result.open_ways = {{0, 1, {-4.0, 1.0 / 3.0, 2.5}, 0.375}, {1, 3, {}, 0.125}};
  result.not_compared = {9, 1.0 / 3.0};
  return result;
}

MergeRecord parse(const std::string& text) {
  return parse_transforms("transforms.json", text);
}

const Json& any_json() {
  static const Json json = Json::parse(transforms_json(kNames, any_result()));
  return json;
}

TEST(MergeRecord, HoldsWhatWasWritten) {
  const MergeResult written = any_result();
  const std::string text = transforms_json(kNames, written);
  const MergeRecord read = parse(text);
  EXPECT_EQ(read.names, kNames);
  EXPECT_EQ(transforms_json(read.names, read.result), text);
  EXPECT_EQ(read.result.components[0].members[1].T_component_map,
            written.components[0].members[1].T_component_map);
  EXPECT_EQ(read.result.joins[2].match.hypotheses[0].T_fixed_moving, (SE2{1e-7, 0.1, 3.0}));
  ASSERT_TRUE(read.result.not_compared);
  EXPECT_EQ(read.result.not_compared->pairs, 9u);
  EXPECT_EQ(read.result.not_compared->expected_joins, 1.0 / 3.0);
  EXPECT_TRUE(read.result.components[0].fused.grid.cells.empty());
}

TEST(MergeRecord, WhatCouldNotBeReadIsNotWritten) {
  for (const std::string& bad : {std::string(), std::string("a\0b", 3)}) {
    std::vector<std::string> names = kNames;
    names[1] = bad;
    EXPECT_THROW(transforms_json(names, any_result()), std::invalid_argument);
  }
  MergeResult result = any_result();
  result.components.emplace_back();  // without members
  EXPECT_THROW(transforms_json(kNames, result), std::invalid_argument);
}

TEST(MergeRecord, KeepsNamesOfAnyBytes) {
  std::vector<std::string> names{"\xe9/a.yaml", "\xe8/a.yaml", "\\xe9/a.yaml", "caf\xc3\xa9", "\xff", "f\\"};
  MergeResult result = any_result();
  EXPECT_EQ(parse(transforms_json(names, result)).names, names);
  result.plan->name = "caf\xe9.png";
  const std::string text = transforms_json(names, result);
  const Json json = Json::parse(text);
  EXPECT_EQ(json.at("names"), "escaped");
  EXPECT_EQ(json.at("maps").at(0), "\\xe9/a.yaml");
  EXPECT_EQ(json.at("components").at(0).at("members").at(0).at("source"), "\\xe9/a.yaml");
  EXPECT_EQ(json.at("maps").at(2), "\\\\xe9/a.yaml");
  const MergeRecord read = parse(text);
  EXPECT_EQ(read.names, names);
  EXPECT_EQ(read.result.plan->name, result.plan->name);
  EXPECT_EQ(transforms_json(read.names, read.result), text);

  // Of names that are UTF-8 nothing is escaped, unless the plan's is not.
  EXPECT_FALSE(any_json().contains("names"));
  names = {"a\\b", "b", "c", "d", "e", "f"};
  EXPECT_EQ(Json::parse(transforms_json(names, any_result())).at("maps").at(0), "a\\b");
  EXPECT_EQ(parse(transforms_json(names, result)).names, names);

  Json wrong = json;
  wrong["names"] = "plain";
  EXPECT_EQ(message_of<FileError>([&] { parse(wrong.dump()); }), "transforms.json: names is not 'escaped'");
  wrong = Json::parse(transforms_json(kNames, any_result()));
  wrong["names"] = "escaped";
  wrong["plan"]["source"] = "\\x";
  EXPECT_EQ(message_of<FileError>([&] { parse(wrong.dump()); }),
            "transforms.json: plan.source has an escape that is none: '\\x'");
}

TEST(MergeRecord, ProbabilitiesGoFromNothingToCertainty) {
  MergeResult result = any_result();
  for (const double probability : {0.0, 1.0}) {
    for (Join& join : result.joins) join.probability = join.match.probability = probability;
    const std::string text = transforms_json(kNames, result);
    EXPECT_EQ(transforms_json(kNames, parse(text).result), text) << probability;
  }
  for (const double probability : {-0.001, 1.001}) {
    result.joins[0].probability = probability;
    EXPECT_ANY_THROW(parse(transforms_json(kNames, result))) << probability;
  }
}

TEST(MergeRecord, KeepsOfARefusedJoinOnlyWhatMayBeTrue) {
  MergeResult result = any_result();
  Join& refused = result.joins[2];
  ASSERT_EQ(refused.outcome, JoinOutcome::refused);
  refused.match.hypotheses.clear();
  for (int i = 0; i < 8; ++i) refused.match.hypotheses.push_back({{1.0 * i, 0.0, 0.0}, 1.0, 0.25});
  refused.match.hypotheses[1].probability = 0.0099;
  const MergeRecord read = parse(transforms_json(kNames, result));
  const auto& kept = read.result.joins[2].match.hypotheses;
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[0].T_fixed_moving.x, 0.0);
  EXPECT_EQ(kept[1].T_fixed_moving.x, 2.0);
  EXPECT_EQ(read.result.joins[3].match.hypotheses.size(), 2u) << "of a join that was used all are kept";
}

TEST(MergeRecord, KeepsThatTheBudgetRefusesAJoin) {
  MergeResult result = any_result();
  Join& refused = result.joins[2];
  ASSERT_EQ(refused.outcome, JoinOutcome::refused);
  refused.over_budget = true;
  refused.match.verdict = Verdict::accepted;
  refused.match.reason = Reason::none;
  const std::string text = transforms_json(kNames, result);
  EXPECT_TRUE(contains(text, "\"reason\":\"over_budget\"")) << text;
  const MergeRecord read = parse(text);
  EXPECT_EQ(read.result.joins[2].reason(), Reason::over_budget);
  EXPECT_EQ(transforms_json(read.names, read.result), text);
}

TEST(MergeRecord, ReadsWhatEarlierVersionsWrote) {
  Json json = any_json();
  json["left_out_reasons"] = Json::array();
  for (const Json& one : json["left_out_maps"]) json["left_out_reasons"].push_back(one["reason"]);
  json.erase("left_out_maps");
  for (Json& join : json["joins"]) {
    join["reason"] = join["by_themselves"]["reason"];
    join.erase("by_themselves");
  }
  json.erase("open_ways");
  json.erase("not_compared");
  EXPECT_EQ(parse(json.dump()).result.plan->resolution, 0.05);
  json["plan"].erase("resolution");
  const MergeRecord read = parse(json.dump());
  EXPECT_EQ(read.result.plan->resolution, 0.0);
  EXPECT_EQ(read.result.left_out, any_result().left_out);
  EXPECT_EQ(read.result.joins[4].match.reason, Reason::too_little_overlap);
}

TEST(MergeRecord, TheFrameIsThatOfAMapWhereOneHoldsIt) {
  MergeResult result = any_result();
  EXPECT_TRUE(any_json()["components"][1]["frame"].is_null());
  result.components[1].members[1].T_component_map = {};
  const Json json = Json::parse(transforms_json(kNames, result));
  EXPECT_EQ(json["components"][1]["frame"], "f.yaml");
  EXPECT_TRUE(parse(json.dump()).result.components[1].in_world_frame);
  Json wrong = json;
  wrong["components"][1]["members"][1]["transform"]["x"] = 1.0;
  EXPECT_TRUE(
      contains(message_of<FileError>([&] { parse(wrong.dump()); }), "is not the frame of its members"));
}

TEST(MergeRecord, OfNothing) {
  EXPECT_TRUE(parse(transforms_json({}, {})).names.empty());
}

TEST(MergeRecord, PassesOverKeysThatItDoesNotKnow) {
  Json json = any_json();
  json["joins"][0]["weather"] = {{"fine", true}};
  json["year"] = 2026;
  EXPECT_EQ(parse(json.dump()).result.joins.size(), any_result().joins.size());
}

TEST(MergeRecord, EveryKeyIsNeeded) {
  const Json whole = any_json().flatten();
  for (const auto& [pointer, value] : whole.items()) {
    const Json::json_pointer place(pointer);
    Json json = any_json();
    Json& parent = json.at(place.parent_pointer());
    if (!parent.is_object() || pointer == "/expected_false_joins" || pointer.ends_with("/omega") ||
        pointer == "/plan/resolution")
      continue;  // earlier versions lack it
    parent.erase(place.back());
    EXPECT_THROW(parse(json.dump()), FileError) << pointer;
  }
}

TEST(MergeRecord, EveryValueHasItsType) {
  const Json whole = any_json().flatten();
  for (const auto& [pointer, value] : whole.items()) {
    for (const Json& wrong : {Json(true), Json::array({1}), Json::object(), Json("wrong"), Json(-1e300)}) {
      Json json = any_json();
      json[Json::json_pointer(pointer)] = wrong;
      const bool may_be_any_number = pointer.ends_with("/score") && wrong.is_number();
      const bool may_be_any_text = pointer == "/plan/source" && wrong.is_string();
      if (may_be_any_number || may_be_any_text) continue;
      EXPECT_THROW(parse(json.dump()), FileError) << pointer << " " << wrong;
    }
  }
}

TEST(MergeRecord, SaysWhatIsWrongAndWhere) {
  const auto complaint = [](const std::string& pointer, const Json& value) {
    Json json = any_json();
    json[Json::json_pointer(pointer)] = value;
    return message_of<FileError>([&] { parse(json.dump()); });
  };
  EXPECT_EQ(complaint("/joins/2/transform/x", "far"), "transforms.json: joins[2].transform.x is no number");
  EXPECT_TRUE(
      contains(complaint("/joins/0/fixed", "z.yaml"), "joins[0].fixed is none of the maps: 'z.yaml'"));
  EXPECT_TRUE(contains(complaint("/joins/0/fixed", "c.yaml"), "joins[0] is of a map and itself"));
  EXPECT_TRUE(contains(complaint("/open_ways/0/moving", "a.yaml"), "open_ways[0] is of a map and itself"));
  EXPECT_TRUE(contains(complaint("/joins/0/outcome", "maybe"), "is unknown: 'maybe'"));
  EXPECT_TRUE(contains(complaint("/joins/0/verdict", "refused"), "does not go with the outcome"));
  EXPECT_TRUE(contains(complaint("/joins/0/agreement", 1.5), "whole number"));
  EXPECT_TRUE(contains(complaint("/joins/0/probability", 1.5), "outside"));
  EXPECT_TRUE(contains(complaint("/joins/0/transform/theta", 3.2), "outside"));
  EXPECT_TRUE(contains(complaint("/left_out/0", "a.yaml"), "in two places: 'a.yaml'"));
  EXPECT_TRUE(contains(complaint("/left_out", {"e.yaml", "b \"<&>\n.yaml"}), "order of the maps"));
  EXPECT_TRUE(contains(complaint("/left_out_maps", Json::array()), "does not go with left_out"));
  EXPECT_TRUE(contains(complaint("/maps", std::vector<std::string>(101, "a.yaml")),
                       "maps[100] is there too often: 'a.yaml'"));
  EXPECT_TRUE(contains(complaint("/maps/1", ""), "no name"));
  EXPECT_TRUE(contains(complaint("/plan/parts/0/maps/0", "z.yaml"), "none of the maps: 'z.yaml'"));
  EXPECT_TRUE(contains(complaint("/plan/parts/0/maps/0", "d.yaml"), "in two parts: 'd.yaml'"));
  EXPECT_TRUE(contains(complaint("/plan/parts/0/maps", Json::array()), "is empty"));
  EXPECT_TRUE(contains(complaint("/plan/parts/2/reason", "several"), "does not go with the parts"));
  EXPECT_TRUE(contains(complaint("/plan/scale", nullptr), "plan.scale does not go with the parts"));
  EXPECT_TRUE(contains(complaint("/plan/scale", 1e7), "outside"));
  EXPECT_TRUE(contains(complaint("/plan/probability", 0.5), "is not that of the surest part"));
  EXPECT_TRUE(contains(complaint("/plan/component", "merged.yaml"), "does not hold the maps on the plan"));
  EXPECT_TRUE(contains(complaint("/plan/maps/0", "a.yaml"), "plan.maps does not go with the parts"));
  EXPECT_TRUE(contains(complaint("/maps/1", std::string("a\0b", 3)), "no name"));
  EXPECT_TRUE(contains(complaint("/maps/6", "g.yaml"), "'g.yaml' is in no component"));
  EXPECT_TRUE(contains(complaint("/components/0/map", "../merged.yaml"), "is not 'merged.yaml'"));
  EXPECT_TRUE(contains(complaint("/components/0/frame", "c.yaml"), "not the frame of its members"));
  EXPECT_TRUE(contains(complaint("/components/0/members", Json::array()), "fewer than two"));
}

TEST(MergeRecord, MembersStandInTheOrderOfTheMaps) {
  const std::vector<OccupancyGrid> maps(4, kMaps[0]);
  const std::vector<std::string> names{"a", "b", "c", "d"};
  const SE2 apart{1.0, 0.0, 0.0};
  const Json sound = Json::parse(
      transforms_json(names, test::merged(maps, {{{0, {}}, {1, apart}, {2, apart}, {3, apart}}})));
  EXPECT_EQ(parse(sound.dump()).result.components.at(0).members.size(), 4u);
  for (const std::size_t i : {1u, 2u, 3u}) {
    Json swapped = sound;
    std::swap(swapped["components"][0]["members"][i - 1], swapped["components"][0]["members"][i]);
    EXPECT_EQ(
        message_of<FileError>([&] { parse(swapped.dump()); }),
        "transforms.json: components[0].members[" + std::to_string(i) + "] is not in the order of the maps");
  }
}

TEST(MergeRecord, WhatWasLeftOutStandsInTheOrderOfTheMaps) {
  const std::vector<OccupancyGrid> maps(4, kMaps[0]);
  const Json sound = Json::parse(transforms_json({"a", "b", "c", "d"}, test::merged(maps, {})));
  EXPECT_EQ(parse(sound.dump()).result.left_out.size(), 4u);
  for (const std::size_t i : {1u, 2u, 3u}) {
    Json swapped = sound;
    std::swap(swapped["left_out"][i - 1], swapped["left_out"][i]);
    EXPECT_EQ(message_of<FileError>([&] { parse(swapped.dump()); }),
              "transforms.json: left_out[" + std::to_string(i) + "] is not in the order of the maps");
    swapped = sound;
    std::swap(swapped["left_out_maps"][i - 1], swapped["left_out_maps"][i]);
    EXPECT_EQ(
        message_of<FileError>([&] { parse(swapped.dump()); }),
        "transforms.json: left_out_maps[" + std::to_string(i - 1) + "].source does not go with left_out");
  }
}

TEST(MergeRecord, WhatIsNoJson) {
  for (const char* text : {"", "{", "[", "nul", "{\"maps\": [\"\xff\"]}", "[1, 2]", "\"text\"", "1e999"})
    EXPECT_THROW(parse(text), FileError) << text;
  EXPECT_THROW(parse(std::string(100000, '[')), FileError);
  EXPECT_EQ(message_of<FileError>([] { parse("[]"); }), "transforms.json: the text is no object");
}

TEST(MergeRecord, IsReadFromItsFolder) {
  const test::TemporaryDirectory directory;
  EXPECT_TRUE(contains(message_of<FileError>([&] { read_merge_record(directory.path()); }),
                       directory.path().string() + ": holds no transforms.json"));
  directory.write("transforms.json", transforms_json(kNames, any_result()));
  EXPECT_EQ(read_merge_record(directory.path()).names, kNames);
  EXPECT_EQ(read_transforms(directory.file("transforms.json")).names, kNames);
  EXPECT_TRUE(
      contains(message_of<FileError>([&] { read_transforms(directory.file("other.json")); }), "other.json"));
}

TEST(FuseAgain, GivesTheMergedMaps) {
  const test::TemporaryDirectory directory;
  const MergeResult result = any_result();
  for (std::size_t i = 0; i < 2; ++i)
    save_map(result.components[i].fused.grid, directory.file(component_file(i)));
  MergeRecord record = parse(transforms_json(kNames, result));
  EXPECT_TRUE(fuse_again(record, kMaps, directory.path()).empty());
  EXPECT_EQ(report_page({record.names, kMaps, record.result}), report_page({kNames, kMaps, result}));
}

TEST(FuseAgain, TellsWhichHaveBeenChanged) {
  const test::TemporaryDirectory directory;
  const MergeResult result = any_result();
  for (std::size_t i = 0; i < 2; ++i)
    save_map(result.components[i].fused.grid, directory.file(component_file(i)));
  std::vector<OccupancyGrid> maps = kMaps;
  maps[5].cells.assign(maps[5].cells.size(), Cell::occupied);
  MergeRecord record = parse(transforms_json(kNames, result));
  EXPECT_EQ(fuse_again(record, maps, directory.path()), std::vector<std::size_t>{1});
}

TEST(FuseAgain, NeedsTheMergedMaps) {
  const test::TemporaryDirectory directory;
  MergeRecord record = parse(transforms_json(kNames, any_result()));
  EXPECT_TRUE(contains(message_of<FileError>([&] { fuse_again(record, kMaps, directory.path()); }),
                       directory.file("merged.yaml")));
}

}  // namespace
}  // namespace gridmerge
