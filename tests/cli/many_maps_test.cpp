// SPDX-License-Identifier: Apache-2.0
// Of many maps likely pairs alone are matched.
#include <regex>

#include "fixture.hpp"
#include "gridmerge/grid/resample.hpp"

namespace gridmerge::test {
namespace {

/// Two maps each of 26 floors: more than those of which all pairs are matched.
class ManyMapsTest : public testing::Test {
 protected:
  ManyMapsTest() {
    for (unsigned floor = 1; floor <= 26; ++floor) {
      const OccupancyGrid building = downsample(draw_building(floor), 4);
      const double turn = 0.1 * floor;
      for (const Window& window : {Window{0, 0, 11, 13}, Window{4, 0, 18, 13}}) {
        const std::string name = "map_" + std::to_string(100 + maps.size());
        maps.push_back(write_map(directory, name, map_part(building, window, {floor - 9.0, 2.0, turn})));
      }
    }
  }

  Outcome merge(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"merge"};
    arguments.insert(arguments.end(), maps.begin(), maps.end());
    arguments.insert(arguments.end(), {"--search", "quick", "--max-missed", "0.9"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  /// transforms.json but for its times.
  std::string answer(const std::string& output) const {
    return std::regex_replace(read_file(directory.file(output + "/transforms.json")),
                              std::regex(R"re("seconds": *[0-9.eE+-]+)re"), "");
  }

  const TemporaryDirectory directory;
  std::vector<std::string> maps;
};

TEST_F(ManyMapsTest, ShardsOfTheChosenPairsAndAMergeAreOneMachine) {
  const Outcome plain = merge({"-o", directory.file("plain"), "--threads", "1"});
  ASSERT_LE(plain.exit_code, 3) << plain.err;
  const Json merged = Json::parse(read_file(directory.file("plain/transforms.json")));
  std::size_t compared = merged.at("joins").size();
  if (merged.contains("refused")) compared += merged.at("refused").at("count").get<std::size_t>();
  EXPECT_GT(compared, 0u);
  EXPECT_LT(compared, maps.size() * (maps.size() - 1) / 2);

  const auto shard = [&](const std::string& which) {
    return merge({"--cache", directory.file("matches"), "--shard", which});
  };
  std::size_t rounds = 0;
  for (std::string first, second; rounds < 30; ++rounds) {
    const Outcome one = shard("1/2"), two = shard("2/2");
    ASSERT_EQ(one.exit_code, 0) << one.err;
    ASSERT_EQ(two.exit_code, 0) << two.err;
    if (one.out == first && two.out == second) break;
    first = one.out;
    second = two.out;
  }
  EXPECT_LT(rounds, 30u);
  const Outcome last =
      merge({"--cache", directory.file("matches"), "-o", directory.file("of_shards"), "--verbose"});
  EXPECT_NE(last.err.find("matches of the cache, 0 made"), std::string::npos) << last.err;
  EXPECT_EQ(answer("of_shards"), answer("plain"));
}

}  // namespace
}  // namespace gridmerge::test
