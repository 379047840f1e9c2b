// SPDX-License-Identifier: Apache-2.0
// merge --elastic.
#include <fmt/format.h>

#include <cmath>
#include <regex>

#include "fixture.hpp"
#include "g2o_vertices.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/report/merge_record.hpp"

namespace gridmerge::test {
namespace {

/// Three maps of one building that drift has bent, apart from the library's own simulation.
class BentMerge : public CliTest {
 protected:
  BentMerge() {
    const OccupancyGrid building = draw_building(1);
    for (int i = 0; i < 3; ++i) {
      std::vector<Point2> shifts;
      for (int point = 0; point < 36; ++point)
        shifts.push_back(
            {0.5 * std::sin(1.7 * i + 2.3 * point), 0.5 * std::cos(2.9 * i * point + 1.1 * point)});
      const Deformation bend({-1.0, -4.0, 0.1}, 7.0, 6, 6, shifts);
      maps.push_back(write_map(directory, fmt::format("bent_{}", i), bent_map(building, bend)));
    }
  }

  std::vector<std::string> merge_call(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"merge"};
    words.insert(words.end(), maps.begin(), maps.end());
    words.insert(words.end(), {"-o", output});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  static double doubled(const std::string& out) {
    const std::string before = "merged.yaml: ", after = " % of the walls that several maps saw lie double";
    const std::size_t end = out.find(after), begin = out.rfind(before, end);
    EXPECT_NE(end, std::string::npos) << out;
    return end == std::string::npos ? -1.0 : std::stod(out.substr(begin + before.size()));
  }

  /// transforms.json, but for its times.
  std::string answer() const {
    return std::regex_replace(read_file(output + "/transforms.json"),
                              std::regex(R"re("seconds": *[0-9.eE+-]+)re"), "");
  }

  const std::string output = directory.file("out");
  std::vector<std::string> maps;
};

TEST_F(BentMerge, ElasticIsHintedAtAndHelps) {
  const Outcome rigid = run(merge_call({}));
  EXPECT_EQ(rigid.exit_code, 0) << rigid.err;
  EXPECT_GT(doubled(rigid.out), 15.0);
  EXPECT_NE(
      rigid.out.find(
          "; --elastic bends maps so that they fit better, and --transform similarity mends a false scale\n"),
      std::string::npos)
      << rigid.out;
  const Outcome elastic = run(merge_call({"--elastic", "--verbose"}));
  EXPECT_EQ(elastic.exit_code, 0) << elastic.err;
  EXPECT_LT(doubled(elastic.out), 10.0);
  EXPECT_NE(elastic.out.find(", bent by up to 0."), std::string::npos) << elastic.out;
  EXPECT_EQ(elastic.out.find("--elastic"), std::string::npos) << elastic.out;
  // Maps that fit say nothing.
  EXPECT_EQ(run({"merge", left, right, "-o", output}).out.find("lie double"), std::string::npos);
}

TEST_F(BentMerge, ItsDeformationsAreReadAgain) {
  ASSERT_EQ(run(merge_call({"--elastic"})).exit_code, 0);
  const Json json = Json::parse(read_file(output + "/transforms.json"));
  const Json& members = json.at("components").at(0).at("members");
  ASSERT_EQ(members.size(), 3u);
  for (const Json& member : members) {
    expect_keys(member, {"source", "transform", "probability", "sd", "deformation"});
    expect_keys(member.at("deformation"), {"kind", "frame", "spacing", "columns", "rows", "shifts"});
    EXPECT_EQ(member.at("deformation").at("kind"), "elastic");
  }
  EXPECT_TRUE(json.at("components").at(0).at("omega").is_null());
  // What was written is what comes of the maps and the record.
  MergeRecord record = read_merge_record(output);
  std::vector<OccupancyGrid> grids;
  for (const std::string& map : maps) grids.push_back(load_map(map).grid);
  EXPECT_TRUE(fuse_again(record, grids, output).empty());
}

TEST_F(BentMerge, NeedsTheJointStrategy) {
  const Outcome outcome = run(merge_call({"--elastic", "--strategy", "tree"}));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("--elastic: needs --strategy joint"), std::string::npos) << outcome.err;
}

// A match does not depend on --elastic, so merges with and without it share a cache.
TEST_F(BentMerge, IsTheSameWithACache) {
  ASSERT_EQ(run(merge_call({"--elastic"})).exit_code, 0);
  const std::string expected = answer(), pixels = read_file(output + "/merged.pgm");
  const std::string cache = directory.file("matches");
  ASSERT_EQ(run(merge_call({"--cache", cache})).exit_code, 0);
  EXPECT_NE(answer(), expected);
  const Outcome cached = run(merge_call({"--elastic", "--cache", cache, "--verbose"}));
  ASSERT_EQ(cached.exit_code, 0) << cached.err;
  EXPECT_NE((cached.out + cached.err).find(", 0 made"), std::string::npos) << cached.out << cached.err;
  EXPECT_EQ(answer(), expected);
  EXPECT_EQ(read_file(output + "/merged.pgm"), pixels);
}

TEST_F(BentMerge, ExportsTheBestRigidPoses) {
  ASSERT_EQ(run(merge_call({"--elastic", "--export", "g2o", "--export", "geojson"})).exit_code, 0);
  const Json members =
      Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
  const std::map<std::size_t, SE2> vertices = g2o_vertices(read_file(output + "/merged.g2o"));
  for (const auto& [id, pose] : vertices) {
    EXPECT_NEAR(pose.x, members.at(id).at("transform").at("x").get<double>(), 1e-6);
    EXPECT_NEAR(pose.y, members.at(id).at("transform").at("y").get<double>(), 1e-6);
    EXPECT_NEAR(pose.theta, members.at(id).at("transform").at("theta").get<double>(), 1e-6);
  }
  EXPECT_EQ(vertices.size(), 3u);
}

// Straight maps are merged as without it, to the byte.
TEST_F(BentMerge, LeavesStraightMapsAlone) {
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  const std::string expected = answer(), pixels = read_file(output + "/merged.pgm");
  const Outcome elastic = run({"merge", left, right, "-o", output, "--elastic"});
  ASSERT_EQ(elastic.exit_code, 0) << elastic.err;
  EXPECT_NE(elastic.out.find("no map is bent"), std::string::npos) << elastic.out;
  EXPECT_EQ(answer(), expected);
  EXPECT_EQ(read_file(output + "/merged.pgm"), pixels);
}

}  // namespace
}  // namespace gridmerge::test
