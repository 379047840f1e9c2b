// SPDX-License-Identifier: Apache-2.0
#include "report/page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "gridmerge/version.hpp"
#include "io/support.hpp"
#include "merge/drawing.hpp"
#include "report/cells.hpp"
#include "report/fleet.hpp"
#include "report/page_data.hpp"
#include "report/results.hpp"
#include "report/told_joins.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using Json = nlohmann::json;
using test::contains;
using test::map_from;

const std::vector<OccupancyGrid> kMaps{map_from({"#..", ".##"}, 0.05), map_from({"#", "."}, 0.1),
                                       map_from({".#.", "...", " .#"}, 0.05), make_grid(3, 2, 0.5)};
const std::vector<std::string> kNames{"a.yaml", "b.yaml", "c.yaml", "d.yaml"};

MergeResult two_of_four() {
  MergeResult result =
      test::merged(kMaps, {{{0, {}}, {2, {1.25, -3.0, 0.5}, 0.875, PoseDeviation{0.125, 0.25}}}});
  Join refused;
  refused.moving = 1;
  refused.probability = 0.0625;
  refused.T_fixed_moving = {0.5, 0.25, 3.0};
  refused.match.reason = Reason::ambiguous;
  refused.acceptance_index = 0.8125;
  refused.agreement = 13;
  refused.disagreement = 3;
  refused.overlap = 0.375;
  refused.match.hypotheses = {{{0.5, 0.25, 3.0}, 10.0, 0.0625}, {{7.0, 8.0, -1.0}, 9.5, 0.03125}};
  result.joins.push_back(refused);
  result.left_out.front().reason = Reason::ambiguous;
  return result;
}

struct Parts {
  std::string data;  // the text of the data block
  std::string rest;  // the page without it
};

Parts take_apart(const std::string& page) {
  const std::string start = R"(<script type="application/json" id="report-data">)";
  const std::size_t begin = page.find(start) + start.size();
  const std::size_t end = page.find("</script>", begin);
  return {page.substr(begin, end - begin), page.substr(0, begin) + page.substr(end)};
}

Json data_of(const std::string& page) {
  return Json::parse(take_apart(page).data);
}

Json transform(double x, double y, double theta) {
  return {{"x", x}, {"y", y}, {"theta", theta}};
}

TEST(ReportPage, TellsWhatStaysOpen) {
  MergeResult result = two_of_four();
  result.open_ways = {{0, 3, {1.0, 2.0, 0.5}, 0.375}};
  const Json data = data_of(report_page({kNames, kMaps, result}));
  ASSERT_EQ(data.at("open_ways").size(), 1u);
  EXPECT_EQ(
      data.at("open_ways")[0],
      (Json{{"fixed", 0}, {"moving", 3}, {"transform", transform(1.0, 2.0, 0.5)}, {"probability", 0.375}}));
  EXPECT_EQ(data.at("refused"), (Json{{"count", 0}, {"rows", Json::array()}}));
}

TEST(ReportPage, OfManyMapsHasTheJoinsThatMatter) {
  MergeResult result = test::fleet(120, 1);
  const std::vector<OccupancyGrid> maps(120, map_from({"#.", ".#"}, 0.1));
  const Deformation scaled = Deformation({-1.0, -1.0, 0.0}, 1.0, 5, 5, [] {
    std::vector<Point2> shifts;  // a hundredth of where they lie
    for (int i = 0; i < 25; ++i) shifts.push_back({0.01 * (i % 5 - 1), 0.01 * (i / 5 - 1)});
    return shifts;
  }());
  result.components[0].members[1].deformation = scaled;
  const Json data = data_of(report_page({test::fleet_names(120), maps, result}));
  const Json& members = data["components"][0]["members"];
  EXPECT_FALSE(members[0].contains("shape"));
  EXPECT_FALSE(members[1].contains("deformation"));
  EXPECT_EQ(members[1]["shape"]["kind"], name_of(scaled.kind()));
  const ToldJoins told = tell_joins(result);
  EXPECT_EQ(data.at("joins").size(), told.objects.size());
  ASSERT_EQ(data.at("refused").at("rows").size(), told.rows.size());
  const Join& join = result.joins[told.rows[0]];
  EXPECT_EQ(data.at("refused").at("rows")[0],
            Json::array({join.fixed, join.moving, name_of(join.reason()), join.probability,
                         join.T_fixed_moving.x, join.T_fixed_moving.y, join.T_fixed_moving.theta}));
  EXPECT_EQ(data.at("refused").at("count"), result.joins.size() - told.objects.size());
}

TEST(ReportPage, OfManyLargeMapsShowsThemCoarser) {
  // Cells that cannot be packed: 51 such maps would take 14 MB.
  OccupancyGrid noise = make_grid(1000, 1000, 0.1);
  std::mt19937 random(1);
  for (Cell& cell : noise.cells) cell = static_cast<Cell>(random() % 3);
  for (const std::size_t count : {50u, 51u}) {
    std::vector<OccupancyGrid> maps(count, map_from({"#.", ".#"}, 0.1));
    for (std::size_t i = 1; i < count; ++i) maps[i] = noise;
    const internal::Json shown = page_data({test::fleet_names(count), maps, MergeResult{}}).at("maps");
    std::size_t bytes = 0;
    for (const auto& map : shown) bytes += map.at("cells").get_ref<const std::string&>().size();
    EXPECT_EQ(shown[1].at("width"), count == 50 ? 1000 : 500);
    EXPECT_EQ(shown[1].at("resolution"), count == 50 ? 0.1 : 0.2);
    EXPECT_EQ(shown[0].at("width"), 2) << "small ones stay as they are";
    EXPECT_EQ(bytes <= 10'000'000, count == 51);
  }
}

TEST(ReportPage, HoldsTheMaps) {
  const Json data = data_of(report_page({kNames, kMaps, two_of_four()}));
  EXPECT_EQ(data.at("version"), kVersion);
  EXPECT_EQ(data.at("live"), false);
  ASSERT_EQ(data.at("maps").size(), 4u);
  const Json& map = data.at("maps").at(2);
  EXPECT_EQ(map.at("name"), "c.yaml");
  EXPECT_EQ(map.at("width"), 3);
  EXPECT_EQ(map.at("height"), 3);
  EXPECT_EQ(map.at("resolution"), 0.05);
  EXPECT_EQ(map.at("origin"), transform(0, 0, 0));
  EXPECT_EQ(test::cells_of(map), kMaps[2].cells);
  const Colour colour = map_colour(2);
  EXPECT_EQ(std::stoi(map.at("color").get<std::string>().substr(1), nullptr, 16),
            colour.red << 16 | colour.green << 8 | colour.blue);
}

TEST(ReportPage, AMapOfWhichNothingIsKnownHasNoCells) {
  const Json data = data_of(report_page({kNames, kMaps, two_of_four()}));
  const Json& map = data.at("maps").at(3);
  EXPECT_EQ(map.at("width"), 0);
  EXPECT_EQ(map.at("height"), 0);
  EXPECT_EQ(map.at("cells"), "");
}

TEST(ReportPage, HoldsTheComponents) {
  const MergeResult result = two_of_four();
  const Json data = data_of(report_page({kNames, kMaps, result}));
  ASSERT_EQ(data.at("components").size(), 1u);
  const Json& component = data.at("components").at(0);
  EXPECT_EQ(component.at("file"), "merged.yaml");
  EXPECT_EQ(component.at("frame"), 0);
  EXPECT_EQ(component.at("agreeing"), result.components[0].fused.agreeing);
  EXPECT_EQ(component.at("conflicting"), result.components[0].fused.conflicting);
  const OccupancyGrid fused = crop_to_known(result.components[0].fused.grid);
  EXPECT_EQ(test::cells_of(component), fused.cells);
  EXPECT_EQ(component.at("origin"), transform(fused.origin.x, fused.origin.y, 0.0));
  EXPECT_EQ(
      component.at("members"),
      Json::array({{{"map", 0}, {"transform", transform(0, 0, 0)}, {"probability", nullptr}, {"sd", nullptr}},
                   {{"map", 2},
                    {"transform", transform(1.25, -3.0, 0.5)},
                    {"probability", 0.875},
                    {"sd", {{"position", 0.125}, {"theta", 0.25}}}}}));
}

TEST(ReportPage, AComponentInTheWorldsFrameHasNoMapsFrame) {
  MergeResult result = two_of_four();
  result.components[0].in_world_frame = true;
  for (Member& member : result.components[0].members)
    member.T_component_map = SE2{100.0, 0.0, 0.0} * member.T_component_map;
  EXPECT_TRUE(data_of(report_page({kNames, kMaps, result})).at("components").at(0).at("frame").is_null());
}

TEST(ReportPage, HoldsTheJoins) {
  const Json joins = data_of(report_page({kNames, kMaps, two_of_four()})).at("joins");
  ASSERT_EQ(joins.size(), 2u);
  EXPECT_EQ(joins.at(0).at("outcome"), "accepted");
  EXPECT_TRUE(joins.at(0).at("reason").is_null());
  EXPECT_EQ(joins.at(1),
            Json({{"fixed", 0},
                  {"moving", 1},
                  {"outcome", "refused"},
                  {"reason", "ambiguous"},
                  {"by_themselves", {{"verdict", "refused"}, {"reason", "ambiguous"}}},
                  {"transform", transform(0.5, 0.25, 3.0)},
                  {"probability", 0.0625},
                  {"acceptance_index", 0.8125},
                  {"agreement", 13},
                  {"disagreement", 3},
                  {"overlap", 0.375},
                  {"hypotheses",
                   {{{"transform", transform(0.5, 0.25, 3.0)}, {"score", 10.0}, {"probability", 0.0625}},
                    {{"transform", transform(7.0, 8.0, -1.0)}, {"score", 9.5}, {"probability", 0.03125}}}}}));
}

TEST(ReportPage, SaysWhyMapsWereLeftOut) {
  EXPECT_EQ(
      data_of(report_page({kNames, kMaps, two_of_four()})).at("left_out"),
      Json::array({{{"map", 1}, {"reason", "ambiguous"}, {"explanation", "it fits in more than one way"}},
                   {{"map", 3},
                    {"reason", "nothing_to_compare"},
                    {"explanation", "there is too little in it, or in the others, to compare"}}}));
}

TEST(ReportPage, NamesAreDataWhateverTheyHold) {
  const std::string innocent = take_apart(report_page({kNames, kMaps, two_of_four()})).rest;
  std::vector<std::string> hostile = test::kHostileNames;
  hostile.insert(hostile.end(), {"</script><script>alert(1)</script>", "<!--<script>", "&lt;/script&gt;",
                                 "]]>", "<!--DATA-->", "<CONNECT>", "\xe2\x80\xa8"});
  for (const std::string& name : hostile) {
    const Parts page = take_apart(report_page({{name, name, name, name}, kMaps, two_of_four()}));
    EXPECT_EQ(page.rest, innocent);
    EXPECT_EQ(page.data.find_first_of("<>&"), std::string::npos);
    const std::string shown = Json::parse(page.data).at("maps").at(0).at("name");
    if (name.find('\xff') == std::string::npos) {
      EXPECT_EQ(shown, name);
    }
  }
}

TEST(ReportPage, WhatIsNoUtf8IsMarked) {
  const Json data = data_of(report_page({{"\xff", "b", "c", "d"}, kMaps, two_of_four()}));
  EXPECT_EQ(data.at("maps").at(0).at("name"), "\xef\xbf\xbd");
}

TEST(ReportPage, AFileFetchesNothing) {
  const std::string page = report_page({kNames, kMaps, two_of_four()});
  EXPECT_TRUE(contains(page, "default-src 'none'; script-src 'sha256-"));
  EXPECT_TRUE(contains(page, "connect-src 'none'; base-uri 'none'; form-action 'none'\">"));
  EXPECT_FALSE(contains(page, "unsafe"));
  EXPECT_TRUE(contains(page, "<noscript>"));
}

TEST(ReportPage, ALiveOneAsksItsServerAlone) {
  const std::string page = live_report_page({kNames, kMaps, two_of_four()}).html;
  EXPECT_TRUE(contains(page, "connect-src 'self'; "));
  Json data = data_of(page);
  EXPECT_EQ(data.at("live"), true);
  data["live"] = false;
  EXPECT_EQ(data, data_of(report_page({kNames, kMaps, two_of_four()})));
}

TEST(ReportPage, NamesItsMerge) {
  const auto name = [](const std::string& page) { return data_of(page).at("merge").get<std::string>(); };
  const MergeResult result = two_of_four();
  const std::string merge = name(report_page({kNames, kMaps, result}));
  EXPECT_EQ(merge.size(), 16u);
  const LiveReportPage served = live_report_page({kNames, kMaps, result}, 7);
  EXPECT_EQ(served.merge, merge) << "whoever serves it";
  EXPECT_EQ(name(served.html), merge);
  std::vector<std::string> names = kNames;
  std::swap(names[0], names[1]);
  EXPECT_NE(name(report_page({names, kMaps, result})), merge);
  std::vector<OccupancyGrid> maps = kMaps;
  maps[2].origin.x += 0.01;
  EXPECT_NE(name(report_page({kNames, maps, result})), merge);
  MergeResult moved = result;
  moved.components[0].members[1].T_component_map.x += 0.01;
  EXPECT_NE(name(report_page({kNames, kMaps, moved})), merge);
}

TEST(ReportPage, OfNothing) {
  const Json data = data_of(report_page({{}, {}, {}}));
  for (const char* list : {"maps", "components", "joins", "left_out"})
    EXPECT_EQ(data.at(list), Json::array());
}

TEST(ReportPage, EveryMapNeedsAName) {
  EXPECT_THROW(report_page({{"a"}, kMaps, two_of_four()}), std::out_of_range);
}

}  // namespace
}  // namespace gridmerge
