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
           {{"--start", "-3,7", "--start", "20,7"}, "no robot can stand at -3,7"},
           {{"--start", "2,7"}, "a start for every robot"},
           {{"--size", "3x20"}, "between 8 and 500 metres"},
           {{"--resolution", "0"}, "resolution"},
           {{"--range", "0"}, "range"}}) {
    std::vector<std::string> all{"simulate", "--kind",  "hall", "--size",
                                 "24x14",    "--quiet", "-o",   output("none")};
    for (std::size_t i = 0; i < words.size(); ++i) {
      const auto at = std::find(all.begin(), all.end(), words[i]);
      if (words[i] == "--size" && at != all.end()) {
        *(at + 1) = words[++i];
      } else {
        all.push_back(words[i]);
      }
    }
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
  expect_error(run(with({"-o", output("mine"), "--robots", "1", "--start", "-3,7"})), output("mine"),
               "that no simulation wrote, or that have changed since: pairs.tsv: choose another directory");
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

TEST_F(Simulate, SaysTheLeastAngularStep) {
  expect_error(run({"simulate", "-o", output("none"), "--quiet", "--angular-step", "0.000001"}), "",
               "the angular step must be 0.0001 rad (0.0058 degrees) at least");
}

class WrongSimulation : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WrongSimulation, IsAUsageError) {
  std::vector<std::string> words{"simulate", "-o", "/nonexistent/x"};
  words.insert(words.end(), GetParam().begin(), GetParam().end());
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(count_lines(outcome.err), 1U) << outcome.err;
}

using Words = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(Cli, WrongSimulation,
                         testing::Values(Words{"--kind", "castle"}, Words{"--robots", "0"},
                                         Words{"--size", "40"}, Words{"--size", "40xx2"},
                                         Words{"--overlap", "1.5"}, Words{"--overlap", "nan"},
                                         Words{"--noise", "-0.1"}, Words{"--drift", "-1"},
                                         Words{"--start", "3"}, Words{"--seed", "x"}, Words{"--others", "-1"},
                                         Words{"--steps", "0"}));

}  // namespace
}  // namespace gridmerge::test
