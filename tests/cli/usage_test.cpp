// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "commands.hpp"
#include "gridmerge/version.hpp"
#include "program.hpp"

namespace gridmerge::test {
namespace {

class WrongUsage : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(WrongUsage, IsOneLineAndExitCodeTwo) {
  const Outcome outcome = run(GetParam());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
  EXPECT_NE(outcome.err.find("--help"), std::string::npos) << outcome.err;
}

using Words = std::vector<std::string>;
#ifdef GRIDMERGE_HAS_NODE
INSTANTIATE_TEST_SUITE_P(
    Node, WrongUsage,
    testing::Values(Words{"node", "a"}, Words{"node", "--pattern", "map"},
                    Words{"node", "--pattern", "/a//b"}, Words{"node", "--pattern", "/*/map/"},
                    Words{"node", "--robot", "tb1"}, Words{"node", "--robot", "tb1="},
                    Words{"node", "--robot", "tb1=map"}, Words{"node", "--robot", "a=/m", "--robot", "a=/n"},
                    Words{"node", "--robot", "a=/m", "--robot", "b=/m"},
                    Words{"node", "--robot", "a=/m", "--fix", "b"}, Words{"node", "--wait", "-1"},
                    Words{"node", "--wait", "nan"}, Words{"node", "--tf", "both"},
                    Words{"node", "--world", ""}, Words{"node", "--world", "the world"},
                    Words{"node", "--name", "a b"}, Words{"node", "--output", "merged"},
                    Words{"node", "--accept", "2"}, Words{"node", "--output-resolution", "0"}));
#endif

INSTANTIATE_TEST_SUITE_P(
    Cli, WrongUsage,
    testing::Values(
        Words{""}, Words{"frobnicate"}, Words{"--frobnicate"}, Words{"info"},
        Words{"info", "a.yaml", "--frobnicate"}, Words{"match"}, Words{"match", "a.yaml"},
        Words{"match", "a.yaml", "b.yaml", "c.yaml"}, Words{"match", "a.yaml", "b.yaml", "--threads", "-1"},
        Words{"match", "a.yaml", "b.yaml", "--threads", "two"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "--elastic"}, Words{"merge", "a.yaml", "b.yaml", "-o", "-q"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--export", "--elastic"},
        Words{"evaluate", "a.tsv", "--json", "--quiet"}, Words{"simulate", "-o", "--seed", "3"},
        Words{"match", "a.yaml", "b.yaml", "--threads", "1.5"},
        Words{"match", "a.yaml", "b.yaml", "--threads", "99999999999999999999"},
        Words{"match", "a.yaml", "b.yaml", "--resolution", "0"},
        Words{"match", "a.yaml", "b.yaml", "--resolution", "-1"},
        Words{"match", "a.yaml", "b.yaml", "--resolution", "nan"},
        Words{"match", "a.yaml", "b.yaml", "--resolution", "inf"},
        Words{"match", "a.yaml", "b.yaml", "--resolution", "5cm"},
        Words{"match", "a.yaml", "b.yaml", "--accept", "1.1"},
        Words{"match", "a.yaml", "b.yaml", "--accept", "nan"},
        Words{"match", "a.yaml", "b.yaml", "--quiet", "--verbose"}, Words{"merge", "a.yaml", "b.yaml"},
        Words{"merge", "a.yaml", "-o", "out"}, Words{"merge", "-o", "out"},
        Words{"match", "a.yaml", "b.yaml", "--resolution", "1e-7"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--output-resolution", "0"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--output-resolution", "1e-7"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--output-resolution", "1e5"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-false-joins", "nan"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-false-joins", "-1"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-missed", "-0.1"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-missed", "1"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-missed", "nan"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-missed", "5%"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-missed", ""},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--max-missed", "0.3", "--all-pairs"},
        Words{"merge", "a.yaml", "b.yaml", "-o", "out", "--strategy", "tree", "--max-missed", "0.1"},
        Words{"view"}, Words{"view", "a", "--port", "65536"}, Words{"view", "a", "--port", "-1"},
        Words{"view", "a", "--port", "http"}, Words{"view", "a", "--address", "0.0.0.0"},
        Words{"view", "a", "--address", "::"}, Words{"view", "a", "--address", "0"},
        Words{"view", "a", "--address", "0.0"}, Words{"view", "a", "--address", "0x0"},
        Words{"view", "a", "--address", "::0"}, Words{"view", "a", "--address", "::ffff:0.0.0.0"},
        Words{"view", "a", "--address", ""}, Words{"report"}, Words{"report", "a", "b"},
        Words{"report", "a", "--resolution", "0"}, Words{"evaluate"}, Words{"measure", "a.yaml", "b.yaml"},
        Words{"measure", "a.yaml", "--pose", "0,0,0"}, Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0,0"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,nan,0"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,5deg"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,1e999"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--pose", "1,0,0"},
        Words{"measure", "a.yaml", "b.yaml", "c.yaml", "--pose", "0,0,0"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--c-lock", "-1"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--dmap", "d.jpg"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--dmap-of", "1"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--dmap", "d.png", "--dmap-of", "2"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--dmap", "d.png", "--dmap-of", "-1"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--dmap", "d.png", "--dmap-class", "wall"},
        Words{"measure", "a.yaml", "b.yaml", "--pose", "0,0,0", "--dmap", "d.png", "--dmap-pass", "third"},
        Words{"evaluate", "--json", "result.json"}, Words{"evaluate", "a.tsv", "b.tsv"}));

TEST(Usage, AMisspeltCommandIsNamed) {
  EXPECT_NE(run({"mtach", "a.yaml", "b.yaml"}).err.find("'mtach'"), std::string::npos);
  EXPECT_NE(run({""}).err.find("there is no command ''"), std::string::npos);
}

TEST(Usage, HelpOfTheProgramNamesEveryCommand) {
  const Outcome outcome = run({"--help"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const std::string& command : kCommands)
    EXPECT_NE(outcome.out.find("\n  " + command), std::string::npos);
}

TEST(Usage, HelpOfACommandHasItsOptionsAndAnExample) {
  for (const std::string& command : kCommands) {
    const Outcome outcome = run({command, "--help"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "");
    for (const std::string text : {"--quiet", "--verbose", "--threads", "Example:\n  gridmerge "}) {
      EXPECT_NE(outcome.out.find(text + (text.back() == ' ' ? command : "")), std::string::npos)
          << command << text;
    }
  }
}

TEST(Usage, HelpFitsATerminal) {
  for (const std::string& command : kCommands) {
    std::istringstream lines(run({command, "--help"}).out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110u) << command << line;
  }
}

TEST(Usage, HelpBreaksALineWhereTheNextWordDoesNotFit) {
  constexpr std::size_t kColumn = 30, kWidth = 100;  // where explanations begin and end
  int broken = 0;
  for (const std::string& command : kCommands) {
    std::istringstream lines(run({command, "--help"}).out);
    std::string before;
    for (std::string line; std::getline(lines, line); before = line) {
      const bool explains = before.size() > kColumn && before[kColumn - 1] == ' ' && before[kColumn] != ' ';
      if (!explains || line.find_first_not_of(' ') != kColumn) continue;
      const std::size_t word = std::min(line.find(' ', kColumn), line.size()) - kColumn;
      EXPECT_LE(before.size(), kWidth) << command << before;
      EXPECT_GT(before.size() + 1 + word, kWidth) << command << before;
      ++broken;
    }
  }
  EXPECT_GT(broken, 100);
}

TEST(Usage, HelpSaysOfEachValueWhatItIs) {
  for (const std::string& command : kCommands) {
    const std::string help = run({command, "--help"}).out;
    // What the library calls a value of which nothing is said.
    for (const char* unnamed : {" TEXT", " INT", " UINT", " FLOAT"})
      EXPECT_EQ(help.find(unnamed), std::string::npos) << command << unnamed;
  }
}

TEST(Usage, HelpHasOptionsOfTheWalkBehindAllOthers) {
  for (const std::string command : {"match", "merge", "evaluate"}) {
    const std::string help = run({command, "--help"}).out;
    const std::size_t walk = help.find("\nWith --search random-walk:\n");
    ASSERT_NE(walk, std::string::npos) << command;
    EXPECT_LT(help.find("\n  --threads "), walk) << command;
    EXPECT_GT(help.find("\n  --c-lock "), walk) << command;
  }
}

TEST(Usage, HelpOfEvaluateNamesTheColumnsOfItsTables) {
  const std::string help = run({"evaluate", "--help"}).out;
  for (const char* columns : {"fixed moving x y theta tolerance, and optionally tier, overlap, shared_wall",
                              "fixed moving\n", "set map x y theta tolerance\n"}) {
    EXPECT_NE(help.find(columns), std::string::npos) << columns;
  }
}

TEST(Usage, VersionIsPrinted) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, std::string("gridmerge ") + kVersion + "\n");
}

}  // namespace
}  // namespace gridmerge::test
