// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "fixture.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "io/png.hpp"

namespace gridmerge::test {

using namespace internal;
namespace {

std::string pose_text(const SE2& T) {
  return fmt::format("{},{},{}", T.x, T.y, T.theta);
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class Measure : public CliTest {
 protected:
  const OccupancyGrid left_map = map_part(draw_building(1), {0, 0, 13, 13}, T_left_building);
  const OccupancyGrid right_map = map_part(draw_building(1), {5, 0, 18, 13}, T_right_building);
  const std::string truth = pose_text(T_left_right);
};

TEST_F(Measure, JsonHoldsTheMeasuresOfThePaper) {
  const Outcome outcome = run({"measure", left, right, "--pose", truth, "--c-lock", "7.5", "--json"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(outcome.out);
  expect_keys(json, {"fixed", "moving", "transform", "omega", "cells", "psi", "psi_terms", "agreement",
                     "disagreement", "delta", "c_lock", "acceptance_index", "common", "engine"});
  expect_keys(json.at("common"), {"occupied_occupied", "free_free", "contradicting"});
  const ImageSimilarity expected = measure_similarity(left_map, right_map, T_left_right);
  EXPECT_EQ(json.at("omega"), count_equal_cells(left_map, right_map, T_left_right));
  EXPECT_EQ(json.at("cells"), left_map.cells.size());
  EXPECT_EQ(json.at("psi"), expected.psi());
  EXPECT_EQ(json.at("psi_terms"), (Json{{"fixed_moving_occupied", expected.fixed_to_moving_occupied.mean()},
                                        {"fixed_moving_free", expected.fixed_to_moving_free.mean()},
                                        {"moving_fixed_occupied", expected.moving_to_fixed_occupied.mean()},
                                        {"moving_fixed_free", expected.moving_to_fixed_free.mean()}}));
  EXPECT_EQ(json.at("agreement"), expected.agreement);
  EXPECT_EQ(json.at("disagreement"), expected.disagreement);
  EXPECT_EQ(json.at("common").at("contradicting"), expected.disagreement);
  EXPECT_EQ(json.at("delta"), expected.delta(7.5));
  EXPECT_EQ(json.at("c_lock"), 7.5);
  EXPECT_EQ(json.at("acceptance_index"), expected.acceptance_index());
  EXPECT_GT(json.at("engine").at("probability"), 0.9);
  EXPECT_GT(json.at("engine").at("figures").at("score"), 100.0);
}

TEST_F(Measure, TellsPeopleTheSame) {
  const Outcome outcome = run({"measure", left, right, "--pose", truth});
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* word : {"T_fixed_moving", "omega", "psi", "moving-fixed, free", "agreement", "Delta",
                           "acceptance index", "the engine says", "walls_met"}) {
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << outcome.out;
  }
}

TEST_F(Measure, OmegaOfSeveralMapsCountsAllOfThem) {
  const Outcome outcome = run({"measure", left, right, left, "--pose", truth, "--pose", "0.4,0,0", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  expect_keys(json, {"fixed", "omega", "cells", "pairs"});
  const std::vector<PlacedMap> all{{&left_map, {}}, {&right_map, T_left_right}, {&left_map, {0.4, 0.0, 0.0}}};
  EXPECT_EQ(json.at("omega"), count_equal_cells(left_map, all));
  EXPECT_EQ(json.at("pairs").size(), 2U);
  EXPECT_EQ(json.at("pairs").at(1).at("moving"), left);
  expect_near(json.at("pairs").at(1).at("transform"), {0.4, 0.0, 0.0}, 1e-12, 1e-12);
}

TEST_F(Measure, DrawsTheDistanceMapsOfThePose) {
  const auto dmap = [&](const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> words{"measure", left, right, "--pose", truth, "--dmap", file, "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run(words).exit_code, 0);
    return read_file(file);
  };
  const PngImage image = decode_png(dmap(directory.file("d.png"), {}));
  EXPECT_EQ(image.width, left_map.width);
  EXPECT_EQ(image.height, left_map.height);

  const OccupancyGrid drawn = draw_on_lattice(left_map, {&right_map, T_left_right});
  const DistanceMapPasses expected = trace_distance_map(drawn, Cell::free);
  const auto first_line = [&](const DistanceMap& map) {
    std::string text;
    for (int column = 0; column < map.width; ++column) {
      const std::uint16_t distance = map.at(column, map.height - 1);
      if (column > 0) text += ',';
      text += distance == kNoDistance ? "inf" : std::to_string(distance);
    }
    return text;
  };
  const std::string csv = directory.file("d.csv");
  for (const auto& [pass, map] : {std::pair{"start", &expected.start},
                                  {"forward", &expected.forward},
                                  {"backward", &expected.backward}}) {
    const std::string text = dmap(csv, {"--dmap-of", "1", "--dmap-class", "free", "--dmap-pass", pass});
    EXPECT_EQ(text.substr(0, text.find('\n')), first_line(*map)) << pass;
    EXPECT_EQ(count_lines(text), static_cast<std::size_t>(left_map.height));
  }
}

TEST_F(Measure, ATermWithoutCellsIsNull) {
  const std::string all_free = write_map(directory, "free", make_grid(30, 30, 0.1, {}, Cell::free));
  const Outcome outcome = run({"measure", left, all_free, "--pose", "-3,3,0", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json terms = Json::parse(outcome.out).at("psi_terms");
  EXPECT_TRUE(terms.at("fixed_moving_occupied").is_null());
  EXPECT_TRUE(terms.at("moving_fixed_occupied").is_null());
  EXPECT_FALSE(terms.at("moving_fixed_free").is_null());
  EXPECT_NE(run({"measure", left, all_free, "--pose", "-3,3,0"}).out.find("undefined"), std::string::npos);
  const std::string blank = write_map(directory, "blank", make_grid(30, 30, 0.1));
  EXPECT_EQ(run({"measure", blank, blank, "--pose", "0,0,0", "--json"}).exit_code, 0);
}

TEST_F(Measure, TellsThatNoKnownCellIsInCommon) {
  const std::string blank = write_map(directory, "blank", make_grid(30, 30, 0.1));
  const Outcome outcome = run({"measure", left, blank, "--pose", "-3,3,0"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\n  no known cell in common: the maps say nothing of this pose\n"),
            std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("0.0000\n  the engine"), std::string::npos) << outcome.out;
  EXPECT_EQ(run({"measure", left, right, "--pose", truth}).out.find("in common:"), std::string::npos);
}

TEST_F(Measure, PosesThatPutTheMapsApartAreAnError) {
  for (const char* pose : {"100,0,0", "1e5,0,0", "1e300,0,0"})
    expect_error(run({"measure", left, right, "--pose", pose}), right, "puts the maps apart");
  expect_error(run({"measure", left, left, right, "--pose", "0,0,0", "--pose", "0,500,1"}), right,
               "moving map 2 puts the maps apart");
}

TEST_F(Measure, WritesNothingWhenItFails) {
  const std::string file = directory.file("d.png");
  run({"measure", left, right, "--pose", "100,0,0", "--dmap", file});
  EXPECT_FALSE(std::filesystem::exists(file));
  expect_error(run({"measure", left, right, "--pose", truth, "--dmap", directory.file("no/d.png")}),
               "no/d.png", "");
}

}  // namespace
}  // namespace gridmerge::test
