// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <sstream>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class EvaluateCommand : public CliTest {
 protected:
  EvaluateCommand() {
    const auto pose = [](const SE2& T) {
      return std::to_string(T.x) + "\t" + std::to_string(T.y) + "\t" + std::to_string(T.theta);
    };
    pairs = directory.write("pairs.tsv",
                            "fixed\tmoving\tx\ty\ttheta\ttolerance\ttier\toverlap\nleft.yaml\tright.yaml\t" +
                                pose(T_left_right) + "\t0.2\tA\t0.6\n");
    negatives =
        directory.write("negatives.tsv", "fixed\tmoving\nleft.yaml\tother.yaml\nother.yaml\tright.yaml\n");
    sets = directory.write("sets.tsv",
                           "set\tmap\tx\ty\ttheta\ttolerance\nhouse\tleft.yaml\t0\t0\t0\t0.2\n"
                           "house\tright.yaml\t" +
                               pose(T_left_right) + "\t0.2\n");
    json = directory.file("result.json");
  }

  std::string pairs, negatives, sets, json;
};

TEST_F(EvaluateCommand, WritesTheJsonOfTheContractAndASummary) {
  const Outcome outcome = run({"evaluate", pairs, "--negatives", negatives, "--sets", sets, "--json", json});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("best"), std::string::npos) << outcome.out;

  Json result = Json::parse(read_file(json));
  expect_keys(result, {"pairs", "negatives", "sets", "seconds", "cases"});
  EXPECT_EQ(result.at("pairs"),
            Json::parse(R"({"total": 1, "accepted_correct": 1, "accepted_wrong": 0, "refused": 0,
                                             "best_correct": 1})"));
  EXPECT_EQ(result.at("negatives"), Json::parse(R"({"total": 2, "accepted": 0})"));
  EXPECT_EQ(result.at("sets"), Json::parse(R"({"total": 1, "maps": 2, "maps_correct": 2, "maps_wrong": 0,
                                            "maps_left_out": 0, "complete": 1})"));
  expect_keys(result.at("seconds"), {"median", "p90", "max"});
  ASSERT_EQ(result.at("cases").size(), 3u);
  for (const Json& one : result.at("cases")) {
    expect_keys(one,
                {"fixed", "moving", "verdict", "probability", "error", "tolerance", "correct", "seconds"});
  }
  EXPECT_EQ(result.at("cases").at(0).at("moving"), "right.yaml");
  EXPECT_EQ(result.at("cases").at(0).at("correct"), true);
  EXPECT_LE(result.at("cases").at(0).at("error"), 0.2);
  EXPECT_EQ(result.at("cases").at(1).at("moving"), "other.yaml");
  EXPECT_TRUE(result.at("cases").at(1).at("error").is_null());
  EXPECT_TRUE(result.at("cases").at(1).at("correct").is_null());
  EXPECT_EQ(result.at("cases").at(2).at("fixed"), "other.yaml");
}

TEST_F(EvaluateCommand, WritesWhatVerdictsRestOn) {
  const std::string features = directory.file("features.tsv");
  const Outcome outcome =
      run({"evaluate", pairs, "--negatives", negatives, "--features", features, "--quiet"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream lines(read_file(features));
  std::string head, first, second;
  std::getline(lines, head);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(head.rfind("fixed\tmoving\ttier\thypothesis\ttruth\terror\tx\ty\ttheta\tscore\t", 0), 0U) << head;
  EXPECT_EQ(first.rfind("left.yaml\tright.yaml\tA\t1\tright\t", 0), 0U) << first;
  EXPECT_EQ(second.rfind("left.yaml\tright.yaml\tA\t2\twrong\t", 0), 0U) << second;
  std::string last = second;
  while (std::getline(lines, second)) last = second;
  EXPECT_NE(last.find("\tnegative\t"), std::string::npos) << last;
  EXPECT_EQ(std::count(first.begin(), first.end(), '\t'), std::count(head.begin(), head.end(), '\t'));
  expect_error(run({"evaluate", pairs, "--features", pairs}), pairs, "is an input");
}

TEST_F(EvaluateCommand, OneFileIsNotWrittenTwice) {
  const std::string file = directory.file("result");
  expect_error(run({"evaluate", pairs, "--features", file, "--json", file}), file, "--json and --features");
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(EvaluateCommand, TheNumberOfThreadsChangesNothingButTheTimes) {
  const auto result = [&](const std::string& threads) {
    Json json_result = Json::parse(run({"evaluate", pairs, "--negatives", negatives, "--sets", sets, "--json",
                                        "-", "--threads", threads})
                                       .out);
    json_result.erase("seconds");
    for (Json& one : json_result.at("cases")) one.erase("seconds");
    return json_result;
  };
  EXPECT_EQ(result("1"), result("2"));
}

TEST_F(EvaluateCommand, AnyOneOfTheThreeTablesIsEnough) {
  EXPECT_EQ(run({"evaluate", pairs}).exit_code, 0);
  EXPECT_EQ(run({"evaluate", "--negatives", negatives}).exit_code, 0);
  EXPECT_EQ(run({"evaluate", "--sets", sets}).exit_code, 0);
}

TEST_F(EvaluateCommand, VerboseTellsOfEachMatch) {
  const Outcome outcome = run({"evaluate", pairs, "--verbose"});
  EXPECT_NE(outcome.out.find("left.yaml right.yaml\n"), std::string::npos) << outcome.out;
}

TEST_F(EvaluateCommand, QuietStillPrintsTheSummary) {
  const Outcome outcome = run({"evaluate", "--negatives", negatives, "--quiet"});
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("negatives"), std::string::npos) << outcome.out;
}

TEST_F(EvaluateCommand, ErrorsNameTheTableAndTheLine) {
  expect_error(run({"evaluate", directory.file("none.tsv")}), directory.file("none.tsv"), "No such file");
  expect_error(run({"evaluate", directory.path().string()}), directory.path().string(), "directory");
  const std::string empty = directory.write("empty.tsv", "");
  expect_error(run({"evaluate", empty}), empty, "empty");
  const std::string odd =
      directory.write("odd.tsv", "fixed\tmoving\tx\ty\ttheta\ttolerance\na\tb\t1\tNaN\t0\t1\n");
  expect_error(run({"evaluate", odd}), odd + ":2", "y is 'NaN'");
  expect_error(run({"evaluate", negatives}), negatives + ":1", "no column 'x'");
  const std::string dangling = directory.write("dangling.tsv", "fixed\tmoving\nleft.yaml\tlost.yaml\n");
  expect_error(run({"evaluate", "--negatives", dangling}), directory.file("lost.yaml"), "No such file");
}

TEST_F(EvaluateCommand, AResultThatCannotBeWrittenLeavesNothing) {
  directory.write("result.json", "old");
  RunOptions options;
  options.file_size_limit = 100;
  const Outcome full = run({"evaluate", "--negatives", negatives, "--json", json}, options);
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_NE(full.out.find("negatives"), std::string::npos) << "the summary is not lost";
  EXPECT_NE(full.err.find(json), std::string::npos) << full.err;
  EXPECT_EQ(read_file(json), "old");
  for (const auto& entry : std::filesystem::directory_iterator(directory.path())) {
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
  }
}

TEST_F(EvaluateCommand, AFileThatCannotBeWrittenIsAnErrorBeforeTheWork) {
  const std::string nowhere = directory.file("no/where.json");
  // Of a run that did the work, stdout would have the summary.
  expect_error(run({"evaluate", "--negatives", negatives, "--json", nowhere}), nowhere, "No such file");
}

TEST_F(EvaluateCommand, AnInputIsNeverReplaced) {
  std::filesystem::create_symlink("other.pgm", directory.file("link"));
  for (const std::string& name : {std::string("pairs.tsv"), std::string("negatives.tsv"),
                                  std::string("sets.tsv"), std::string("left.yaml"), std::string("right.pgm"),
                                  std::string("./other.yaml"), std::string("link")}) {
    const std::string input = directory.file(name);
    const std::string before = read_file(input);
    expect_error(run({"evaluate", pairs, "--negatives", negatives, "--sets", sets, "--json", input}), input,
                 "is an input");
    EXPECT_EQ(read_file(input), before) << name;
  }
  EXPECT_EQ(run({"evaluate", "--negatives", negatives, "--json", pairs}).exit_code, 0) << "not an input here";
}

TEST_F(EvaluateCommand, ADeviceIsNotReplacedByAFile) {
  const Outcome outcome = run({"evaluate", "--negatives", negatives, "--json", "/dev/null"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.err.find("/dev/null"), std::string::npos) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace gridmerge::test
