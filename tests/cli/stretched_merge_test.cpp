// SPDX-License-Identifier: Apache-2.0
// merge --transform.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>

#include "fixture.hpp"
#include "g2o_vertices.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/report/merge_record.hpp"
#include "view.hpp"

namespace gridmerge::test {
namespace {

/// Three maps of one building, the second of which was written with a false resolution.
class StretchedMerge : public CliTest {
 protected:
  StretchedMerge() {
    const OccupancyGrid building = draw_building(1);
    maps.push_back(write_map(directory, "true_1", building));
    OccupancyGrid large = map_part(building, {0, 0, 18, 13}, T_left_building);
    large.resolution *= kScale;
    large.origin = {kScale * large.origin.x, kScale * large.origin.y, large.origin.theta};
    maps.push_back(write_map(directory, "large", large));
    maps.push_back(write_map(directory, "true_2", map_part(building, {0, 0, 18, 13}, T_right_building)));
  }

  std::vector<std::string> merge_call(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"merge"};
    words.insert(words.end(), maps.begin(), maps.end());
    words.insert(words.end(), {"-o", output});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  Json members() const {
    return Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
  }

  /// transforms.json without its times.
  std::string answer() const {
    return std::regex_replace(read_file(output + "/transforms.json"),
                              std::regex(R"re("seconds": *[0-9.eE+-]+)re"), "");
  }

  static constexpr double kScale = 1.03;
  const std::string output = directory.file("out");
  std::vector<std::string> maps;
};

// What `view` refines is what its page shows: the stretched maps.
TEST_F(StretchedMerge, AMapRefinedWhereItLiesStaysThere) {
  ASSERT_EQ(run(merge_call({"--transform", "similarity"})).exit_code, 0);
  RunningProgram server({"view", output});
  const HttpClient client(port_of(server.read_line()));
  const Json found = members();
  const Json merge = data_of_page(read_file(output + "/report.html")).at("merge");
  for (const std::size_t moving : {0u, 1u, 2u}) {
    Json question{{"merge", merge},
                  {"moving", moving},
                  {"transform", found.at(moving).at("transform")},
                  {"fixed", Json::array()}};
    for (std::size_t i = 0; i < 3; ++i) {
      if (i != moving) question["fixed"].push_back({{"map", i}, {"transform", found.at(i).at("transform")}});
    }
    const auto answer = client.post("/refine", question.dump(), kJson);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->status, 200) << answer->body;
    EXPECT_LT(Json::parse(answer->body).at("moved").get<double>(), 0.03) << moving;
  }
}

TEST_F(StretchedMerge, FindsTheScaleAndTellsIt) {
  const Outcome outcome =
      run(merge_call({"--transform", "similarity", "--export", "open-rmf", "--export", "g2o"}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string open_rmf = read_file(output + "/open_rmf.yaml");
  EXPECT_NE(open_rmf.find("    scale: 0.98"), std::string::npos) << open_rmf;
  EXPECT_NE(open_rmf.find("    residual: 0.000000\n"), std::string::npos) << open_rmf;
  EXPECT_NE(read_file(output + "/merged.g2o").find("these are the rigid parts"), std::string::npos);
  EXPECT_NE(outcome.out.find(", scale 0.98"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(", scale 1.0"), std::string::npos) << outcome.out;
  double sum = 0.0;
  const Json found = members();
  ASSERT_EQ(found.size(), 3u);
  for (const Json& member : found) {
    expect_keys(member, {"source", "transform", "probability", "sd", "deformation"});
    const Json& deformation = member.at("deformation");
    expect_keys(deformation, {"kind", "scale", "matrix", "frame", "spacing", "columns", "rows", "shifts"});
    EXPECT_EQ(deformation.at("kind"), "similarity");
    const double scale = deformation.at("scale");
    const Json& matrix = deformation.at("matrix");
    EXPECT_NEAR(matrix.at(0).at(0), scale, 1e-4);  // its turn is in the transform
    EXPECT_NEAR(matrix.at(1).at(0), 0.0, 1e-4);
    sum += std::log(scale);
  }
  EXPECT_NEAR(sum, 0.0, 1e-9);
  const auto scale_of = [&](std::size_t i) {
    return found.at(i).at("deformation").at("scale").get<double>();
  };
  EXPECT_NEAR(scale_of(0) / scale_of(1), kScale, 2e-3);
  EXPECT_NEAR(scale_of(2) / scale_of(1), kScale, 2e-3);
}

TEST_F(StretchedMerge, ItsScalesAreReadAgain) {
  ASSERT_EQ(run(merge_call({"--transform", "affine"})).exit_code, 0);
  for (const Json& member : members()) EXPECT_EQ(member.at("deformation").at("kind"), "affine");
  MergeRecord record = read_merge_record(output);
  std::vector<OccupancyGrid> grids;
  for (const std::string& map : maps) grids.push_back(load_map(map).grid);
  EXPECT_TRUE(fuse_again(record, grids, output).empty());
  const std::string page = read_file(output + "/report.html");
  ASSERT_EQ(run({"report", output}).exit_code, 0);
  EXPECT_EQ(read_file(output + "/report.html"), page);
}

TEST_F(StretchedMerge, RefusesADamagedRecord) {
  ASSERT_EQ(run(merge_call({"--transform", "similarity"})).exit_code, 0);
  const std::string path = output + "/transforms.json";
  Json json = Json::parse(read_file(path));
  json["components"][0]["members"][1]["deformation"]["scale"] = 1.25;
  std::ofstream(path) << json.dump();
  expect_error(run({"report", output}), "transforms.json",
               "components[0].members[1].deformation.scale is not that of its lattice");
}

TEST_F(StretchedMerge, SaysWhenNothingIsGained) {
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  const std::string expected = answer(), pixels = read_file(output + "/merged.pgm");
  for (const char* kind : {"rigid", "similarity", "affine"}) {
    const Outcome outcome = run({"merge", left, right, "-o", output, "--transform", kind});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("no map is stretched") != std::string::npos, kind != std::string("rigid"))
        << outcome.out;
    EXPECT_EQ(answer(), expected) << kind;
    EXPECT_EQ(read_file(output + "/merged.pgm"), pixels) << kind;
  }
}

TEST_F(StretchedMerge, ElasticHasTwoNames) {
  ASSERT_EQ(run(merge_call({"--elastic"})).exit_code, 0);
  const std::string expected = answer(), pixels = read_file(output + "/merged.pgm");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--transform", "elastic"}, {"--elastic", "--transform", "elastic"}}) {
    ASSERT_EQ(run(merge_call(words)).exit_code, 0);
    EXPECT_EQ(answer(), expected);
    EXPECT_EQ(read_file(output + "/merged.pgm"), pixels);
  }
}

TEST_F(StretchedMerge, RefusesWhatMakesNoSense) {
  const auto message = [&](const std::vector<std::string>& words) {
    const Outcome outcome = run(merge_call(words));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    EXPECT_FALSE(std::filesystem::exists(output));
    return outcome.err;
  };
  const auto expect_in = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect_in(message({"--transform", "projective"}), "--transform: projective not in {");
  expect_in(message({"--transform", ""}), "--transform");
  expect_in(message({"--transform", "affine", "--elastic"}), "--elastic: contradicts --transform affine");
  expect_in(message({"--elastic", "--transform", "rigid"}), "--elastic: contradicts --transform rigid");
  expect_in(message({"--transform", "affine", "--strategy", "tree"}), "--transform: needs --strategy joint");
}

TEST_F(StretchedMerge, RigidIsTheDefaultAndTheTreesTransform) {
  ASSERT_EQ(run(merge_call({})).exit_code, 0);
  const std::string expected = answer(), pixels = read_file(output + "/merged.pgm");
  ASSERT_EQ(run(merge_call({"--transform", "rigid"})).exit_code, 0);
  EXPECT_EQ(answer(), expected);
  EXPECT_EQ(read_file(output + "/merged.pgm"), pixels);
  for (const Json& member : members()) EXPECT_FALSE(member.contains("deformation"));
  EXPECT_NE(run(merge_call({"--transform", "rigid", "--strategy", "tree"})).exit_code, 2);
}

// Matches do not depend on it, so all transforms share a cache.
TEST_F(StretchedMerge, IsTheSameWithACache) {
  ASSERT_EQ(run(merge_call({"--transform", "similarity"})).exit_code, 0);
  const std::string expected = answer(), pixels = read_file(output + "/merged.pgm");
  const std::string cache = directory.file("matches");
  ASSERT_EQ(run(merge_call({"--cache", cache})).exit_code, 0);
  EXPECT_NE(answer(), expected);
  const Outcome cached = run(merge_call({"--transform", "similarity", "--cache", cache, "--verbose"}));
  ASSERT_EQ(cached.exit_code, 0) << cached.err;
  EXPECT_NE((cached.out + cached.err).find(", 0 made"), std::string::npos) << cached.out << cached.err;
  EXPECT_EQ(answer(), expected);
  EXPECT_EQ(read_file(output + "/merged.pgm"), pixels);
}

TEST_F(StretchedMerge, IsTheSameByShards) {
  const std::string cache = directory.file("matches");
  int last = 3;
  for (const char* shard : {"1/2", "2/2", "1/2"})
    last = run({"merge", maps[0], maps[1], maps[2], "--transform", "similarity", "--shard", shard, "--cache",
                cache})
               .exit_code;
  ASSERT_EQ(last, 0);
  const Outcome cached = run(merge_call({"--transform", "similarity", "--cache", cache, "--verbose"}));
  ASSERT_EQ(cached.exit_code, 0) << cached.err;
  EXPECT_NE((cached.out + cached.err).find(", 0 made"), std::string::npos) << cached.out << cached.err;
  const std::string found = answer();
  ASSERT_EQ(run(merge_call({"--transform", "similarity"})).exit_code, 0);
  EXPECT_EQ(answer(), found);
}

TEST_F(StretchedMerge, AFixedMapHasTheTrueScale) {
  ASSERT_EQ(run(merge_call({"--transform", "similarity", "--fix", maps[0]})).exit_code, 0);
  const Json found = members();
  ASSERT_EQ(found.size(), 3u);
  EXPECT_FALSE(found.at(0).contains("deformation"));
  EXPECT_NEAR(found.at(1).at("deformation").at("scale"), 1.0 / kScale, 2e-3);
  EXPECT_NEAR(found.at(2).at("deformation").at("scale"), 1.0, 2e-3);
}

TEST_F(StretchedMerge, ExportsTheBestRigidPoses) {
  ASSERT_EQ(run(merge_call({"--transform", "similarity", "--export", "g2o"})).exit_code, 0);
  const Json found = members();
  const std::map<std::size_t, SE2> vertices = g2o_vertices(read_file(output + "/merged.g2o"));
  for (const auto& [id, pose] : vertices) expect_near(found.at(id).at("transform"), pose, 1e-6, 1e-6);
  EXPECT_EQ(vertices.size(), 3u);
}

// The stretched maps hang on the plan, which has the only scale that is drawn.
TEST_F(StretchedMerge, HangsOnAPlan) {
  OccupancyGrid drawing = draw_building(1);
  drawing.resolution *= 0.8;
  const std::string plan = write_map(directory, "plan", drawing);
  const Outcome outcome =
      run(merge_call({"--transform", "similarity", "--plan", plan, "--plan-scale", "1.1:1.4"}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("3 of 3 maps hang on it"), std::string::npos) << outcome.out;
  const Json found = members();
  ASSERT_EQ(found.size(), 3u);
  const auto scale_of = [&](std::size_t i) {
    return found.at(i).at("deformation").at("scale").get<double>();
  };
  EXPECT_NEAR(scale_of(0) / scale_of(1), kScale, 2e-3);
  EXPECT_TRUE(
      Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("frame").is_null());
}

}  // namespace
}  // namespace gridmerge::test
