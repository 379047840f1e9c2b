// SPDX-License-Identifier: Apache-2.0
// Of many maps likely pairs alone are matched.
#include <fmt/format.h>

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

  Outcome merge_quickly(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"merge"};
    arguments.insert(arguments.end(), maps.begin(), maps.end());
    arguments.insert(arguments.end(), {"--search", "quick"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  Outcome merge(std::vector<std::string> more) const {
    more.insert(more.end(), {"--max-missed", "0.9"});
    return merge_quickly(more);
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
  const std::size_t pairs = maps.size() * (maps.size() - 1) / 2;
  EXPECT_LT(compared, pairs);
  const Json& left = merged.at("not_compared");
  EXPECT_EQ(left.at("pairs").get<std::size_t>(), pairs - compared);
  EXPECT_GT(left.at("expected_joins"), 0.0);
  EXPECT_NE(plain.out.find(fmt::format("not compared: {} pairs, which may hide {:.1f} more joins",
                                       pairs - compared, left.at("expected_joins").get<double>())),
            std::string::npos)
      << plain.out;
  EXPECT_EQ(plain.err.find("all 1326 pairs"), std::string::npos) << plain.err;

  const auto shard = [&](const std::string& which) {
    return merge({"--cache", directory.file("matches"), "--shard", which});
  };
  std::size_t rounds = 0;
  for (; rounds < 30; ++rounds) {
    const Outcome one = shard("1/2"), two = shard("2/2");
    for (const Outcome* each : {&one, &two}) {
      const bool is_missing = each->out.find(" missing, of other shards") != std::string::npos;
      ASSERT_EQ(each->exit_code, is_missing ? 3 : 0) << each->out << each->err;
    }
    if (one.exit_code == 0 || two.exit_code == 0) break;
  }
  EXPECT_LT(rounds, 30u);
  const Outcome last =
      merge({"--cache", directory.file("matches"), "-o", directory.file("of_shards"), "--verbose"});
  EXPECT_NE(last.err.find("matches of the cache, 0 made"), std::string::npos) << last.err;
  EXPECT_EQ(answer("of_shards"), answer("plain"));
}

TEST_F(ManyMapsTest, SayHowLongAllPairsTake) {
  // A shard of so many makes one match.
  const std::vector<std::string> shard{"--cache", directory.file("matches"), "--shard", "7/1326", "--threads",
                                       "1"};
  const auto err = [&](std::vector<std::string> more) {
    more.insert(more.end(), shard.begin(), shard.end());
    const Outcome outcome = merge_quickly(more);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    return outcome.err;
  };
  const std::string all = "gridmerge: all 1326 pairs of 52 maps are matched";
  const std::string text =
      ", which takes about 1 second of a thread for each of 1326 shards: --max-missed 0.25 matches likely "
      "pairs "
      "only\n";
  EXPECT_EQ(err({}), all + text);
  EXPECT_EQ(err({"--max-missed", "0.2"}), all + ", as --max-missed is not above 0.2" + text);
  EXPECT_EQ(err({"--quiet"}), "");
  EXPECT_EQ(err({"--all-pairs"}), "");
}

TEST_F(ManyMapsTest, AnEvaluationSaysThatItMatchesAllPairsOfASet) {
  const std::string image = "P5 2 2 255\n\xcd\xcd\xcd\xcd";  // nobody has seen anything
  std::string table = "set\tmap\tx\ty\ttheta\ttolerance\n";
  for (int i = 0; i < 51; ++i) {
    directory.write(fmt::format("unseen_{}.pgm", i), image);
    table += fmt::format("one\tunseen_{}.pgm\t{}\t0\t0\t1\n", i, i);
  }
  const Outcome outcome = run({"evaluate", "--sets", directory.write("sets.tsv", table), "--resolution",
                               "0.1", "--threads", "1", "--search", "quick"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(
      outcome.err.find("gridmerge: all 1275 pairs of 51 maps are matched, which takes about 41 seconds of a "
                       "thread: unlike merge, evaluate has no --max-missed\n"),
      std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace gridmerge::test
