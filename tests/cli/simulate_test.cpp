// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class Simulate : public CliTest {
 protected:
  std::string output(const std::string& name) const { return (directory.path() / name).string(); }

  static std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  const std::vector<std::string> small{"simulate", "--kind", "office", "--size",         "24x14", "--overlap",
                                       "0.5",      "--seed", "5",      "--angular-step", "1",     "--quiet"};

  std::vector<std::string> with(std::vector<std::string> words) const {
    words.insert(words.begin(), small.begin(), small.end());
    return words;
  }
};

TEST_F(Simulate, MakesMapsThatTheEngineMergesAndTheTruthConfirms) {
  const Outcome made = run(with({"-o", output("a")}));
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.err, "");
  EXPECT_NE(made.out.find("overlap 0."), std::string::npos) << made.out;
  const std::string folder = output("a");
  const Outcome evaluated = run({"evaluate", folder + "/pairs.tsv", "--negatives", folder + "/negatives.tsv",
                                 "--sets", folder + "/sets.tsv", "--json", "-", "--quiet"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  const Json json = Json::parse(evaluated.out);
  EXPECT_EQ(json.at("pairs").at("total"), 1);
  EXPECT_EQ(json.at("pairs").at("best_correct"), 1);
  EXPECT_EQ(json.at("negatives").at("total"), 2);
  EXPECT_EQ(json.at("negatives").at("accepted"), 0);
}

TEST_F(Simulate, ASeedGivesTheSameFiles) {
  run(with({"-o", output("a"), "--threads", "1"}));
  run(with({"-o", output("b"), "--threads", "2"}));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(output("a"))) {
    EXPECT_EQ(bytes_of(entry.path()), bytes_of(std::filesystem::path(output("b")) / entry.path().filename()));
    ++files;
  }
  EXPECT_EQ(files,
            2U * 2U + 2U + 2U + 4U + 1U);  // two robots, one elsewhere, the building, four tables, their list
}

TEST_F(Simulate, WhatCannotBeHadIsAnErrorAndWritesNothing) {
  for (const auto& [words, cause] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--longest-way", "2", "--overlap", "0.9", "--start", "2,7", "--start", "22,7"},
            "an overlap of 0.9"},
           {{"--start", "-3,7", "--start", "20,7"}, "no robot can stand at -3,7"}}) {
    std::vector<std::string> all{"simulate", "--kind",  "hall", "--size",
                                 "24x14",    "--quiet", "-o",   output("none")};
    all.insert(all.end(), words.begin(), words.end());
    expect_error(run(all), "", cause);
    EXPECT_FALSE(std::filesystem::exists(output("none")));
  }
}

TEST_F(Simulate, TriesItsFolderFirst) {
  const std::string file = directory.write("file", "");
  // The robots' starts are looked at when the building is there.
  const Outcome outcome = run(with({"-o", file + "/folder", "--start", "-3,7", "--start", "20,7"}));
  expect_error(outcome, file + "/folder", "cannot be created");
}

TEST_F(Simulate, LeavesMapsOfTheUserAloneAndSaysSoBeforeTheWork) {
  directory.write("mine/robot_2.yaml", "mine");
  directory.write("mine/pairs.tsv", "fixed\tmoving\nrobot_1.yaml\trobot_2.yaml\n");
  // The robots' starts are looked at when the building is there.
  expect_error(
      run(with({"-o", output("mine"), "--start", "-3,7", "--start", "-3,8"})), output("mine"),
      "that no simulation wrote, or that have changed since: pairs.tsv, robot_2.yaml: choose another "
      "directory");
  EXPECT_EQ(read_file(output("mine/robot_2.yaml")), "mine");
}

TEST_F(Simulate, NamesWhatItRemovesOfAnEarlierDataset) {
  const Outcome first = run(with({"-o", output("a")}));
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(first.out.find("removed"), std::string::npos) << first.out;
  std::vector<std::string> fewer{"simulate", "--kind",   "hall", "--size", "20x12",     "--robots",
                                 "1",        "--others", "0",    "-o",     output("a"), "--quiet"};
  const Outcome second = run(fewer);
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_NE(second.out.find("removed: elsewhere_1.pgm, elsewhere_1.yaml, robot_2.pgm, robot_2.yaml (of an "
                            "earlier dataset)\n"),
            std::string::npos)
      << second.out;
  EXPECT_FALSE(std::filesystem::exists(output("a/robot_2.yaml")));
}

TEST_F(Simulate, NamesItsFolderOnOneLine) {
  const Outcome outcome = run(with({"-o", output("a\n\x1b[31mb")}));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("the truth: " + output("a\\n\\x1b[31mb") + "/pairs.tsv"), std::string::npos)
      << outcome.out;
}

/// What stands on the command line, and what is said of it.
struct WrongWords {
  std::vector<std::string> words;
  const char* said;

  friend std::ostream& operator<<(std::ostream& out, const WrongWords& wrong) {
    for (const std::string& word : wrong.words) out << word << ' ';
    return out;
  }
};

class WrongSimulation : public testing::TestWithParam<WrongWords> {};

TEST_P(WrongSimulation, IsAUsageErrorThatNamesTheOption) {
  std::vector<std::string> words{"simulate", "-o", "/nonexistent/x"};
  words.insert(words.end(), GetParam().words.begin(), GetParam().words.end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
  EXPECT_EQ(outcome.err.find(std::string("gridmerge: ") + GetParam().said), 0U) << outcome.err;
}

INSTANTIATE_TEST_SUITE_P(
    Cli, WrongSimulation,
    testing::Values(
        WrongWords{{"--kind", "castle"}, "--kind: "}, WrongWords{{"--robots", "0"}, "--robots: "},
        WrongWords{{"--size", "40"}, "--size: "}, WrongWords{{"--size", "40xx2"}, "--size: "},
        WrongWords{{"--size", "nanx10"}, "--size: 'nanx10'"},
        WrongWords{{"--size", "10x-10"}, "--size: a building's sides must be between 8 and 500 metres"},
        WrongWords{{"--size", "501x10"}, "--size: a building's sides must be between 8 and 500 metres"},
        WrongWords{{"--overlap", "1.5"}, "--overlap: "}, WrongWords{{"--overlap", "nan"}, "--overlap: "},
        WrongWords{{"--overlap", "0.5", "--robots", "1"}, "--overlap: an overlap takes two robots"},
        WrongWords{{"--start", "3"}, "--start: '3'"}, WrongWords{{"--start", "3,inf"}, "--start: '3,inf'"},
        WrongWords{{"--start", "2,7"}, "--start: there must be a start for every robot"},
        WrongWords{{"--heading", "2"}, "--heading: there must be a heading for every robot"},
        WrongWords{{"--heading", "2", "--heading", "nan"}, "--heading: 'nan' is not a number"},
        WrongWords{{"--longest-way", "1e6"}, "--longest-way: "}, WrongWords{{"--steps", "0"}, "--steps: "},
        WrongWords{{"--clutter", "11"}, "--clutter: "}, WrongWords{{"--others", "-1"}, "--others: "},
        WrongWords{{"--drift", "-1"}, "--drift: "}, WrongWords{{"--drift", "11"}, "--drift: "},
        WrongWords{{"--resolution", "0"}, "--resolution: "}, WrongWords{{"--tidy", "100"}, "--tidy: "},
        WrongWords{{"--range", "0"}, "--range: "}, WrongWords{{"--noise", "-0.1"}, "--noise: "},
        WrongWords{{"--noise", "1e300"}, "--noise: "}, WrongWords{{"--stray", "2"}, "--stray: "},
        WrongWords{{"--missed", "2"}, "--missed: "},
        WrongWords{{"--field-of-view", "0"}, "--field-of-view, --angular-step: the field of view"},
        WrongWords{{"--angular-step", "0.000001"},
                   "--field-of-view, --angular-step: the angular step must be 0.0001 rad (0.0058 degrees)"},
        WrongWords{{"--seed", "x"}, "--seed: "}));

}  // namespace
}  // namespace gridmerge::test
