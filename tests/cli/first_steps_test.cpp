// SPDX-License-Identifier: Apache-2.0
// What a newcomer types first: every command of README and every example of --help, as it stands there.
#include <glob.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "bag/bag_builder.hpp"
#include "fixture.hpp"

namespace gridmerge::test {
namespace {

/// Works in a folder of its own, which holds maps of one building and tables of their truth.
class FirstSteps : public testing::Test {
 protected:
  FirstSteps() { std::filesystem::current_path(directory.path()); }
  ~FirstSteps() override { std::filesystem::current_path(before); }

  /// Three robots' maps by these names, and what is known of them.
  void make_maps(const std::vector<std::string>& names) const {
    const OccupancyGrid building = draw_building(1);
    const SE2 T_first_building{-3.0, 2.0, 0.4};
    const std::vector<OccupancyGrid> maps{
        map_part(building, {0, 0, 13, 13}, T_first_building),
        map_part(building, {5, 0, 18, 13}, inverse(T_first_second) * T_first_building),
        map_part(building, {2, 0, 16, 13}, {4.0, 1.0, 2.0})};
    for (std::size_t i = 0; i < maps.size(); ++i) write_map(directory, names[i], maps[i]);
    // Recordings too, of the first robot and of all.
    directory.write(names[0] + ".mcap", mcap_file({record("/map", 1, maps[0])}));
    directory.write("team.mcap", mcap_file({record("/tb1/map", 1, maps[0]), record("/tb2/map", 2, maps[1]),
                                            record("/tb3/map", 3, maps[2])}));
    write_map(directory, "other", draw_building(2));
    OccupancyGrid layout = building;  // an architect's, who drew it smaller
    layout.resolution *= 0.8;
    write_map(directory, "layout", layout);
    const std::string first = names[0] + ".yaml", second = names[1] + ".yaml";
    directory.write("poses.tsv",
                    "map\tx\ty\ttheta\n" + first + "\t0\t0\t0\n" + second + "\t1.25\t-3\t0.52\n");
    directory.write("pairs.tsv", "fixed\tmoving\tx\ty\ttheta\ttolerance\n" + first + "\t" + second +
                                     "\t1.25\t-3\t0.52\t0.2\n");
    directory.write("negatives.tsv", "fixed\tmoving\n" + first + "\tother.yaml\n");
  }

  /// Words as a shell makes them of a line without quotes.
  static std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream text(line);
    for (std::string word; text >> word;) {
      glob_t found{};
      if (::glob(word.c_str(), GLOB_NOCHECK, nullptr, &found) == 0)
        words.insert(words.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
      ::globfree(&found);
    }
    return words;
  }

  /// Runs "gridmerge LINE". It has to succeed, and to say something.
  static void expect_useful(const std::string& line) {
    SCOPED_TRACE("gridmerge " + line);
    const std::vector<std::string> words = words_of(line);
    if (words.front() == "view") {  // which goes on until it is told to end
      RunningProgram view(words);
      EXPECT_NE(view.read_line().find("http://127.0.0.1:"), std::string::npos);
      EXPECT_EQ(view.end_with(SIGINT).exit_code, 0);
      return;
    }
    if (words.front() == "node") {  // likewise; robots are none here, and it looks for none elsewhere
      RunOptions options;
      options.environment = {"ROS_LOCALHOST_ONLY=1"};
      RunningProgram node(words, options);
      std::string said = node.read_line();
      if (line.find("--page") != std::string::npos) {
        EXPECT_EQ(said.find("page: http://127.0.0.1:"), 0u);
        said = node.read_line();
      }
      EXPECT_EQ(said.find("hears a map"), 0u);
      EXPECT_EQ(node.end_with(SIGINT).exit_code, 0);
      return;
    }
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out, "");
    if (line.find("--sets office/") == std::string::npos) return;
    // One set, complete: four maps correct, none wrong, none left out.
    EXPECT_TRUE(std::regex_search(outcome.out, std::regex("sets +1 +1 +4 +4 +0 +0\\n"))) << outcome.out;
  }

  /// Runs the command that a merge says to try, as a shell reads it.
  Outcome tried(const std::string& out) const {
    const std::string begin = "try: gridmerge ";
    const std::size_t at = out.find(begin) + begin.size(), end = out.find("   (", at);
    EXPECT_LT(at, end) << out;
    const std::string script = directory.write("try.sh", "printf '%s\\0' " + out.substr(at, end - at));
    FILE* const shell = ::popen(("bash " + script).c_str(), "r");
    std::vector<std::string> words(1);
    for (int c = std::fgetc(shell); c != EOF; c = std::fgetc(shell)) {
      if (c != 0) {
        words.back() += static_cast<char>(c);
      } else {
        words.emplace_back();
      }
    }
    EXPECT_EQ(::pclose(shell), 0) << out;
    words.pop_back();
    return run(words);
  }

  const std::filesystem::path before = std::filesystem::current_path();
  const TemporaryDirectory directory;
  const SE2 T_first_second{1.25, -3.0, 0.52};  // as README and the help of measure have it
};

TEST_F(FirstSteps, EveryCommandOfReadmeIsUseful) {
  make_maps({"a", "b", "c"});
  std::ifstream file(GRIDMERGE_README);
  std::ostringstream readme;
  readme << file.rdbuf();
  const std::string text = readme.str();
  const std::regex command("build/release/bin/gridmerge +([^`#\n]*[^`# \n])");
  std::size_t commands = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), command), end; at != end; ++at, ++commands)
    expect_useful((*at)[1].str());
  EXPECT_GE(commands, 12u);
}

TEST_F(FirstSteps, EveryExampleOfHelpIsUseful) {
  make_maps({"robot1", "robot2", "robot3"});
  ASSERT_EQ(run({"merge", "robot1.yaml", "robot2.yaml", "-o", "merged"}).exit_code, 0);
  for (const std::string command :
       {"", "info", "match", "measure", "merge", "report", "view", "evaluate", "simulate"}) {
    const Outcome help = run(command.empty() ? std::vector<std::string>{"--help"}
                                             : std::vector<std::string>{command, "--help"});
    std::istringstream lines(help.out.substr(help.out.find("Example:\n")));
    std::size_t examples = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("  gridmerge ", 0) != 0) continue;
      // The folder of the example is this one, and its port may be taken.
      line = std::regex_replace(line.substr(12), std::regex("/data/site"), directory.path().string());
      expect_useful(std::regex_replace(line, std::regex("--port 8750"), "--port 0"));
      ++examples;
    }
    EXPECT_GE(examples, 1u) << command;
  }
}

TEST_F(FirstSteps, TheProgramAloneSaysWhatItCanDo) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, run({"--help"}).out);
}

TEST_F(FirstSteps, WhatAMergeSaysToTryRunsAsItIsPrinted) {
  make_maps({"a", "b", "c"});
  const OccupancyGrid map = map_part(draw_building(1), {0, 0, 13, 13}, {});
  for (const std::string name : {"sp ace", "it's", "-d", "#a", "a;b", "$(x)",
                                 "gr\xc3\xb6\xc3\x9f"
                                 "e",
                                 "a\nb", "it's\x1b\\", "caf\xe9"}) {
    write_map(directory, name + "/map", map);
    const Outcome outcome = run({"merge", "-o", "out", "--", name + "/map.yaml", "other.yaml"});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos) << outcome.out;
    const Outcome again = tried(outcome.out);
    EXPECT_EQ(again.exit_code, 3) << outcome.out << again.err;
  }
  const Outcome images =
      run({"merge", "a.pgm", "other.pgm", "--resolution", "0.1", "--literal-thresholds", "-o", "out"});
  EXPECT_NE(images.out.find("gridmerge match a.pgm other.pgm --resolution 0.1 --literal-thresholds "),
            std::string::npos)
      << images.out;
  EXPECT_EQ(tried(images.out).exit_code, 3) << images.out;
}

TEST_F(FirstSteps, AMergeOfNothingOpensWithThatAndWhatToTry) {
  make_maps({"a", "b", "c"});
  const Outcome outcome = run({"merge", "a.yaml", "other.yaml", "-o", "out"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.out.find("nothing was merged: no two of the 2 maps"), 0u) << outcome.out;
  EXPECT_NE(outcome.out.find("nearest to it: a.yaml and other.yaml, probability 0."), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("try: gridmerge match a.yaml other.yaml "), std::string::npos) << outcome.out;
  for (const std::string option : {"--accept", "--max-false-joins", "--init", "--fix"})
    EXPECT_NE(outcome.out.find(option), std::string::npos) << outcome.out;
  const Outcome merged = run({"merge", "a.yaml", "b.yaml", "-o", "out"});
  EXPECT_EQ(merged.out.find("nothing"), std::string::npos) << merged.out;
  const Outcome tree = run({"merge", "a.yaml", "other.yaml", "-o", "out", "--strategy", "tree"});
  EXPECT_EQ(tree.out.find("nothing was merged"), 0u) << tree.out;
  EXPECT_EQ(tree.out.find("--init"), std::string::npos) << tree.out;
}

}  // namespace
}  // namespace gridmerge::test
