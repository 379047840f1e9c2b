// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fixture.hpp"
#include "gridmerge/grid/resample.hpp"

namespace gridmerge::test {
namespace {

class RandomWalk : public CliTest {
 protected:
  RandomWalk()
      : whole(write_map(directory, "whole", downsample(draw_building(1), 2))),
        seen_again(write_map(directory, "again",
                             transform_grid(downsample(draw_building(1), 2), T_again_building, 0.1))) {}

  static std::vector<std::string> lines_of(const std::string& path) {
    std::ifstream file(path);
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }

  const SE2 T_again_building{2.0, 1.0, 0.5};
  const std::string whole;
  const std::string seen_again;
};

TEST_F(RandomWalk, AcceptsOneMapSeenTwice) {
  const Outcome outcome = run({"match", whole, seen_again, "--search", "random-walk", "--restarts", "2",
                               "--accept", "0.95", "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json.at("verdict"), "accepted");
  EXPECT_EQ(json.at("probability"), json.at("acceptance_index"));
  expect_near(json.at("transform"), inverse(T_again_building), 0.3, 0.02);
}

TEST_F(RandomWalk, RefusesAnotherBuilding) {
  const Outcome outcome = run({"match", whole, other, "--search", "random-walk"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.out.rfind("refused: the acceptance index is ", 0), 0U) << outcome.out;
}

TEST_F(RandomWalk, ASeedGivesTheSameWhateverTheThreads) {
  const auto transform = [&](const char* threads, const char* seed) {
    return Json::parse(run({"match", whole, other, "--search", "random-walk", "--restarts", "2", "--seed",
                            seed, "--threads", threads, "--json"})
                           .out)
        .at("transform");
  };
  EXPECT_EQ(transform("1", "7"), transform("2", "7"));
  EXPECT_NE(transform("1", "7"), transform("1", "8"));
}

TEST_F(RandomWalk, WritesItsTrace) {
  const std::string trace = (directory.path() / "trace.csv").string();
  const Outcome outcome = run({"match", whole, seen_again, "--search", "random-walk", "--restarts", "2",
                               "--c-lock", "0,7.5", "--accept", "0.9", "--trace", trace});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<std::string> lines = lines_of(trace);
  ASSERT_GT(lines.size(), 3U);
  EXPECT_EQ(lines[0], "match,walk,c_lock,step,delta,psi,agr,dis,x,y,theta,omega,ai,accepted,wide");
  EXPECT_EQ(lines[1].rfind("1,1,0,0,", 0), 0U) << lines[1];
  for (const std::string& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 14) << line;
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                          [](const auto& line) { return line.rfind("1,2,7.5,0,", 0) == 0; }));
}

TEST_F(RandomWalk, TheWholeTraceHasARowForEveryProposal) {
  const std::string trace = (directory.path() / "all.csv").string();
  run({"match", whole, seen_again, "--search", "random-walk", "--patience", "50", "--wide-share", "0.5",
       "--trace", trace, "--trace-all", "--start", "1.9,0.9,0.4"});
  const std::vector<std::string> lines = lines_of(trace);
  ASSERT_GT(lines.size(), 51U);
  EXPECT_EQ(lines[1].rfind("1,1,0,0,", 0), 0U) << lines[1];
  EXPECT_NE(lines[1].find(",1.9,0.9,0.4,"), std::string::npos) << lines[1];
  EXPECT_TRUE(
      std::any_of(lines.begin(), lines.end(), [](const auto& line) { return line.ends_with(",0,1"); }));
  EXPECT_TRUE(
      std::any_of(lines.begin(), lines.end(), [](const auto& line) { return line.ends_with(",0,0"); }));
}

TEST_F(RandomWalk, StartsWhereItIsTold) {
  const SE2 truth = inverse(T_again_building);
  const std::string start = std::to_string(truth.x + 0.3) + "," + std::to_string(truth.y) + "," +
                            std::to_string(truth.theta + 0.03);
  const Outcome near = run({"match", whole, seen_again, "--search", "random-walk", "--start", start,
                            "--wide-share", "0", "--accept", "0.95", "--json"});
  EXPECT_EQ(near.exit_code, 0) << near.err;
  expect_near(Json::parse(near.out).at("transform"), truth, 0.3, 0.02);
  expect_error(run({"match", whole, seen_again, "--search", "random-walk", "--start", "500,0,0"}), seen_again,
               "puts the maps apart");
}

TEST_F(RandomWalk, TakesEveryOptionOfTheWalk) {
  const auto transform = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"match", whole, seen_again, "--search", "random-walk", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 3) << outcome.err;
    return Json::parse(outcome.out).at("transform");
  };
  const auto walked = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--start", "-1.9,0.5,-0.4", "--patience", "200"});
    return transform(more);
  };
  const Json usual = walked({});
  EXPECT_EQ(walked({"--wide-share", "0.05", "--cooling", "1", "--memory", "10", "--first-step", "10",
                    "--least-common-cells", "400"}),
            usual);
  EXPECT_NE(walked({"--wide-share", "0.3"}), usual);
  EXPECT_NE(walked({"--temperature", "5", "--memory", "4"}), walked({"--temperature", "5"}));
  EXPECT_NE(walked({"--first-step", "5"}), usual);
  EXPECT_NE(walked({"--temperature", "5", "--cooling", "0.5"}), walked({"--temperature", "5"}));
  const Json from_lattice = transform({"--patience", "20"});
  EXPECT_EQ(transform({"--patience", "20", "--starts", "72x1x100"}), from_lattice);
  EXPECT_NE(transform({"--patience", "20", "--starts", "7x0x0"}), from_lattice);
  EXPECT_EQ(
      run({"match", whole, whole, "--search", "random-walk", "--least-common-cells", "1000000000"}).exit_code,
      3);
}

TEST_F(RandomWalk, ATraceThatCannotBeWrittenFailsFirst) {
  const std::string nowhere = (directory.path() / "nowhere" / "trace.csv").string();
  const Outcome outcome = run({"match", whole, other, "--search", "random-walk", "--trace", nowhere});
  expect_error(outcome, nowhere, "");
  expect_error(run({"match", whole, other, "--search", "random-walk", "--trace", other}), other,
               "is an input");
}

TEST_F(RandomWalk, MergesUpTheTree) {
  const std::string output = (directory.path() / "merged").string();
  const Outcome outcome = run({"merge", whole, seen_again, other, "-o", output, "--search", "random-walk",
                               "--restarts", "2", "--accept", "0.95"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
  std::ifstream file(std::filesystem::path(output) / "transforms.json");
  const Json json = Json::parse(file);
  EXPECT_EQ(json.at("components").at(0).at("members").size(), 2U);
  EXPECT_EQ(json.at("left_out"), Json::array({other}));
}

TEST_F(RandomWalk, MergeWritesItsTraceBesideItsResults) {
  const std::string output = (directory.path() / "traced").string();
  const std::string trace = output + "/trace.csv";
  const Outcome outcome = run({"merge", "-o", output, "--trace", trace, "--search", "random-walk", "--c-lock",
                               "7.5", "--accept", "0.9", whole, seen_again, other});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  const std::vector<std::string> lines = lines_of(trace);
  EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                          [](const auto& line) { return line.rfind("2,1,7.5,0,", 0) == 0; }));
  expect_error(run({"merge", "-o", output, "--trace", output + "/report.html", "--search", "random-walk",
                    whole, other}),
               "report.html", "the merge itself writes");
}

TEST_F(RandomWalk, EvaluatesPairs) {
  const std::string table = directory.write(
      "pairs.tsv", "fixed\tmoving\tx\ty\ttheta\ttolerance\n" + whole + "\t" + whole + "\t0\t0\t0\t0.5\n");
  const Outcome outcome =
      run({"evaluate", "--search", "random-walk", "--c-lock", "0", table, "--json", "-", "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out).at("pairs").at("accepted_correct"), 1);
}

TEST_F(RandomWalk, MapsWithNothingToCompareAreRefused) {
  const std::string all_free = write_map(directory, "free", make_grid(20, 20, 0.1, {}, Cell::free));
  const std::string a_cell = write_map(directory, "cell", make_grid(1, 1, 0.1, {}, Cell::occupied));
  for (const auto& [a, b] :
       {std::pair{whole, all_free}, std::pair{all_free, whole}, std::pair{all_free, all_free},
        std::pair{whole, a_cell}, std::pair{a_cell, a_cell}}) {
    const Outcome outcome = run({"match", a, b, "--search", "random-walk", "--quiet", "--json"});
    EXPECT_EQ(outcome.exit_code, 3) << a << " " << b << outcome.err;
    EXPECT_TRUE(Json::accept(outcome.out));
  }
}

TEST_F(RandomWalk, ResolutionsTooFarApartAreAnErrorThatNamesTheMaps) {
  OccupancyGrid map = make_grid(20, 20, 0.0001, {}, Cell::free);
  map.at(3, 3) = Cell::occupied;
  const std::string fine = write_map(directory, "fine", map);
  expect_error(run({"match", whole, fine, "--search", "random-walk"}), fine, "resolutions");
  const std::string output = (directory.path() / "out").string();
  expect_error(run({"merge", whole, fine, "-o", output, "-q", "--search", "random-walk"}), fine,
               "resolutions");
}

class WrongWalk : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WrongWalk, IsAUsageError) {
  std::vector<std::string> words{"match", "a.yaml", "b.yaml"};
  words.insert(words.end(), GetParam().begin(), GetParam().end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
}

using Words = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(
    Cli, WrongWalk,
    testing::Values(Words{"--search", "random"}, Words{"--search", "random-walk", "--c-lock", "-1"},
                    Words{"--search", "random-walk", "--c-lock", "nan"},
                    Words{"--search", "random-walk", "--c-lock", "0,-2"},
                    Words{"--search", "random-walk", "--restarts", "0"},
                    Words{"--search", "random-walk", "--restarts", "1.5"},
                    Words{"--search", "random-walk", "--seed", "-1"},
                    Words{"--search", "random-walk", "--seed", "18446744073709551616"},
                    Words{"--search", "random-walk", "--temperature", "-1"},
                    Words{"--search", "random-walk", "--temperature", "nan"},
                    Words{"--search", "random-walk", "--restarts", "1", "--c-lock", "0,1"},
                    Words{"--temperature", "1"}, Words{"--search", "random-walk", "--accept", "1.01"},
                    Words{"--c-lock", "7.5"}, Words{"--restarts", "2"}, Words{"--seed", "3"},
                    Words{"--trace", "trace.csv"}, Words{"--start", "0,0,0"}, Words{"--wide-share", "0.1"},
                    Words{"--search", "random-walk", "--wide-share", "1.5"},
                    Words{"--search", "random-walk", "--wide-share", "-0.1"},
                    Words{"--search", "random-walk", "--cooling", "0"},
                    Words{"--search", "random-walk", "--cooling", "1.1"},
                    Words{"--search", "random-walk", "--memory", "3"},
                    Words{"--search", "random-walk", "--first-step", "100"},
                    Words{"--search", "random-walk", "--first-step", "nan"},
                    Words{"--search", "random-walk", "--patience", "0"},
                    Words{"--search", "random-walk", "--patience", "-5"},
                    Words{"--search", "random-walk", "--least-common-cells", "-1"},
                    Words{"--search", "random-walk", "--starts", "72x3"},
                    Words{"--search", "random-walk", "--starts", "0x1x100"},
                    Words{"--search", "random-walk", "--starts", "72x-1x100"},
                    Words{"--search", "random-walk", "--starts", "72x1x-100"},
                    Words{"--search", "random-walk", "--starts", "72x1xnan"},
                    Words{"--search", "random-walk", "--starts", "9999x9999x1"},
                    Words{"--search", "random-walk", "--starts", "7.5x1x100"},
                    Words{"--search", "random-walk", "--start", "0,0"},
                    Words{"--search", "random-walk", "--start", "0,0,0", "--starts", "72x1x100"},
                    Words{"--search", "random-walk", "--trace-all"}));

}  // namespace
}  // namespace gridmerge::test
