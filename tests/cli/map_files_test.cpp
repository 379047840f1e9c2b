// SPDX-License-Identifier: Apache-2.0
// Map files as people have them, through the program.
#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class MapFiles : public CliTest {
 protected:
  // The map in the file of this name with another text in its YAML.
  std::string changed(const std::string& map, const std::string& name, const std::string& from,
                      const std::string& to) const {
    std::string yaml = read_file(map);
    const std::size_t at = yaml.find(from);
    EXPECT_NE(at, std::string::npos) << yaml;
    yaml.replace(at, yaml.find('\n', at) - at, to);
    return directory.write(name, yaml);
  }

  Json info_of(const std::string& map, const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments = {"info", "--json", map};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return Json::parse(outcome.out).at("maps").at(0);
  }
};

TEST_F(MapFiles, UnknownIsUnknownUnderAnyFreeThreshold) {
  const Json as_saved = info_of(left);
  const std::string map = changed(left, "quarter.yaml", "free_thresh:", "free_thresh: 0.25");
  const Json info = info_of(map);
  EXPECT_EQ(info.at("unknown"), as_saved.at("unknown"));
  ASSERT_EQ(info.at("warnings").size(), 1u);
  EXPECT_NE(info.at("warnings").at(0).get<std::string>().find("free_thresh 0.25"), std::string::npos);
  const Json literal = info_of(map, {"--literal-thresholds"});
  EXPECT_EQ(literal.at("unknown"), 0);
  EXPECT_NE(run({"info", map}).out.find("load as unknown"), std::string::npos);
}

TEST_F(MapFiles, EvaluateReadsToTheLetterToo) {
  changed(left, "quarter.yaml", "free_thresh:", "free_thresh: 0.25");
  const std::string table = directory.write("negatives.tsv", "fixed\tmoving\nquarter.yaml\tother.yaml\n");
  const std::vector<std::string> arguments = {"evaluate", "--negatives", table};
  EXPECT_NE(run(arguments).err.find("free_thresh 0.25"), std::string::npos);
  std::vector<std::string> literal = arguments;
  literal.push_back("--literal-thresholds");
  const Outcome outcome = run(literal);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err.find("load as unknown"), std::string::npos) << outcome.err;
}

TEST_F(MapFiles, AnImagePathOfAnotherMachineIsNoObstacle) {
  const std::string map = changed(left, "moved.yaml", "image:", "image: /home/robot/maps/left.pgm");
  const Outcome outcome = run({"info", map});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("the image is not at '/home/robot/maps/left.pgm'"), std::string::npos)
      << outcome.out;
}

TEST_F(MapFiles, NorIsAYawThatIsNoNumber) {
  const std::string map = changed(left, "nan.yaml", "origin:", "origin: [1.0, 2.0, -nan]");
  const Json info = info_of(map);
  EXPECT_EQ(info.at("origin"), (Json{{"x", 1.0}, {"y", 2.0}, {"theta", 0.0}}));
  EXPECT_EQ(info.at("warnings").size(), 1u);
}

TEST_F(MapFiles, MergeTellsAKindOfWarningOnce) {
  std::vector<std::string> arguments = {"merge", "-o", directory.file("out")};
  for (const std::string name : {"a", "b", "c", "d", "e"})
    arguments.push_back(
        changed(name == "b" ? right : left, name + ".yaml", "free_thresh:", "free_thresh: 0.25"));
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::size_t told = 0;
  for (std::size_t at = outcome.err.find("lightness 205"); at != std::string::npos;
       at = outcome.err.find("lightness 205", at + 1))
    ++told;
  EXPECT_EQ(told, 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("and 1 more: 'gridmerge info' tells of each"), std::string::npos) << outcome.err;
}

TEST_F(MapFiles, SolidBlackOutsideCountsAsUnknown) {
  // Rooms in a corner of a large picture that is painted black, as hand-edited maps are.
  OccupancyGrid map = make_grid(600, 600, 0.05, {}, Cell::occupied);
  for (int y = 20; y < 140; ++y) {
    for (int x = 20; x < 260; ++x) {
      if ((x / 40 + y / 30) % 3 != 0) map.at(x, y) = Cell::free;
    }
  }
  const std::string black = write_map(directory, "black", map);
  EXPECT_NE(run({"info", black}).out.find("was the unseen painted black?"), std::string::npos);
  const Outcome outcome = run({"match", "--json", black, black});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  expect_near(Json::parse(outcome.out).at("transform"), {}, 1e-9, 1e-9);
}

TEST_F(MapFiles, AScaleThatIsOffIsHintedAt) {
  const std::string map = changed(right, "coarse.yaml", "resolution:", "resolution: 0.2");
  const std::string hint = "hint: " + map + " fits " + left + " at 0.5 times its scale";
  const Outcome match = run({"match", left, map});
  EXPECT_EQ(match.exit_code, 3);
  EXPECT_NE(match.out.find(hint), std::string::npos) << match.out;
  EXPECT_NE(match.out.find("is its resolution 0.1 m and not 0.2 m"), std::string::npos) << match.out;
  EXPECT_NE(run({"merge", left, map, "-o", directory.file("out")}).out.find(hint), std::string::npos);
  EXPECT_EQ(run({"match", left, other}).out.find("hint"), std::string::npos);
}

TEST_F(MapFiles, WhatIsNoMapIsNamedWithTheRemedy) {
  const std::string gif = directory.write("a.gif", "GIF89a");
  expect_error(run({"info", gif}), gif, "a GIF image, which is not read");
  const std::string pointer =
      directory.write("lfs.yaml", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
  expect_error(run({"merge", pointer, left, "-o", directory.file("out")}), pointer, "git lfs pull");
}

}  // namespace
}  // namespace gridmerge::test
