// SPDX-License-Identifier: Apache-2.0
#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class Info : public CliTest {
 protected:
  // 4 x 3 cells of 0.5 m: 2 occupied, 3 free, in the 3 x 2 cells at the lower left.
  std::string write_small_map() const {
    OccupancyGrid map = make_grid(4, 3, 0.5, {1.5, -2.0, 0.0});
    map.at(0, 0) = map.at(2, 1) = Cell::occupied;
    map.at(1, 0) = map.at(1, 1) = map.at(2, 0) = Cell::free;
    return write_map(directory, "small", map);
  }
};

TEST_F(Info, TellsPeople) {
  const Outcome outcome = run({"info", write_small_map()});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, directory.file("small.yaml") +
                             "\n"
                             "  size        4 x 3 cells, 2.00 m x 1.50 m\n"
                             "  resolution  0.5 m\n"
                             "  origin      x 1.500 m, y -2.000 m, yaw 0.0000 rad (0.00 deg)\n"
                             "  occupied    2 (16.7 %)\n"
                             "  free        3 (25.0 %)\n"
                             "  unknown     7 (58.3 %)\n"
                             "  known area  1.50 m x 1.00 m\n");
}

TEST_F(Info, TellsPrograms) {
  const std::string small = write_small_map();
  const Outcome outcome = run({"info", "--json", small, left});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(count_lines(outcome.out), 1u) << "as match --json";
  const Json json = Json::parse(outcome.out);
  expect_keys(json, {"maps"});
  ASSERT_EQ(json.at("maps").size(), 2u);
  EXPECT_EQ(json.at("maps").at(0), (Json{{"source", small},
                                         {"width", 4},
                                         {"height", 3},
                                         {"resolution", 0.5},
                                         {"origin", {{"x", 1.5}, {"y", -2.0}, {"theta", 0.0}}},
                                         {"occupied", 2},
                                         {"free", 3},
                                         {"unknown", 7},
                                         {"known_size", {{"width", 1.5}, {"height", 1.0}}},
                                         {"warnings", Json::array()}}));
  EXPECT_EQ(json.at("maps").at(1).at("source"), left);
}

TEST_F(Info, ShowsWarningsAsPartOfTheResult) {
  const std::string blank = write_map(directory, "blank", make_grid(5, 5, 0.1));
  const Outcome outcome = run({"info", "--quiet", blank});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("warning     the map has no known cell"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("known area  0.00 m x 0.00 m"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(run({"info", "--json", blank}).out);
  EXPECT_EQ(json.at("maps").at(0).at("warnings"), Json::array({"the map has no known cell"}));
}

TEST_F(Info, ReadsABareImageWithItsResolution) {
  write_small_map();
  const std::string image = directory.file("small.pgm");
  expect_error(run({"info", image}), image, "resolution");
  const Outcome outcome = run({"info", image, "--resolution", "0.25"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find("resolution  0.25 m"), std::string::npos);
}

TEST_F(Info, AFileNameThatIsNotUtf8IsNoObstacle) {
  const std::string odd = write_map(directory, "caf\xe9", make_grid(5, 5, 0.1, {}, Cell::free));
  EXPECT_TRUE(Json::accept(run({"info", "--json", odd}).out));
}

}  // namespace
}  // namespace gridmerge::test
