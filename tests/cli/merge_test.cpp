// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class Merge : public CliTest {
 protected:
  std::set<std::string> files_in(const std::string& folder) const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      names.insert(entry.path().filename());
    return names;
  }

  const std::string output = directory.file("out");
  const std::set<std::string> all_files = {"merged.yaml", "merged.pgm", "transforms.json", "preview.png",
                                           "report.html"};
};

TEST_F(Merge, WritesTheFilesOfTheContract) {
  const Outcome outcome = run({"merge", left, right, "-o", output});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("merged.yaml: 2 of 2 maps"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("look at it: " + output + "/report.html\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(files_in(output), all_files);

  const Json json = Json::parse(read_file(output + "/transforms.json"));
  expect_keys(json, {"maps", "components", "joins", "left_out", "left_out_maps", "open_ways",
                     "expected_false_joins"});
  EXPECT_EQ(json.at("left_out"), Json::array());
  ASSERT_EQ(json.at("components").size(), 1u);
  expect_keys(json.at("components").at(0), {"map", "frame", "members", "omega", "cells", "omega_share"});
  const Json& component = json.at("components").at(0);
  EXPECT_GT(component.at("omega"), component.at("cells").get<int>() / 10);
  EXPECT_LT(component.at("omega"), component.at("cells"));
  EXPECT_DOUBLE_EQ(component.at("omega_share"),
                   component.at("omega").get<double>() / component.at("cells").get<double>());
  EXPECT_EQ(json.at("components").at(0).at("map"), "merged.yaml");
  ASSERT_EQ(json.at("components").at(0).at("members").size(), 2u);
  const Json& members = json.at("components").at(0).at("members");
  for (const Json& member : members) expect_keys(member, {"source", "transform", "probability", "sd"});
  EXPECT_EQ(members.at(0).at("source"), left);
  expect_near(members.at(0).at("transform"), {}, 1e-12, 1e-12);
  EXPECT_EQ(members.at(1).at("source"), right);
  expect_near(members.at(1).at("transform"), T_left_right, 0.1, 0.007);
  ASSERT_EQ(json.at("joins").size(), 1u);
  expect_keys(json.at("joins").at(0),
              {"fixed", "moving", "transform", "verdict", "probability", "outcome", "reason", "by_themselves",
               "acceptance_index", "agreement", "disagreement", "overlap", "sd", "hypotheses"});
  EXPECT_EQ(json.at("joins").at(0).at("fixed"), left);
  EXPECT_EQ(json.at("joins").at(0).at("moving"), right);
  EXPECT_EQ(json.at("joins").at(0).at("verdict"), "accepted");
}

TEST_F(Merge, ItsMapIsAMapThatKnowsMoreThanEach) {
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  const Json info = Json::parse(run({"info", "--json", left, right, output + "/merged.yaml"}).out);
  const auto known = [&](int i) {
    return info.at("maps").at(i).at("free").get<int>() + info.at("maps").at(i).at("occupied").get<int>();
  };
  EXPECT_GT(known(2), known(0));
  EXPECT_GT(known(2), known(1));
  EXPECT_LT(known(2), known(0) + known(1));
  EXPECT_EQ(info.at("maps").at(2).at("resolution"), 0.1);
}

TEST_F(Merge, VerboseListsWhatBecameOfEveryPair) {
  const Outcome outcome = run({"merge", left, right, other, "-o", output, "--verbose"});
  EXPECT_EQ(outcome.exit_code, 3);
  const Json joins = Json::parse(read_file(output + "/transforms.json")).at("joins");
  ASSERT_EQ(joins.size(), 3u);
  for (const Json& join : joins) {
    const std::string pair =
        join.at("fixed").get<std::string>() + " and " + join.at("moving").get<std::string>();
    const std::string head = fmt::format("{:<8} probability {:.4f}, ", join.at("outcome").get<std::string>(),
                                         join.at("probability").get<double>());
    bool is_listed = false;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);)
      is_listed = is_listed || (line.starts_with(head) && line.ends_with(" s: " + pair));
    EXPECT_TRUE(is_listed) << outcome.out << "has no " << head << pair;
  }
  EXPECT_EQ(joins[0].at("outcome"), "accepted");
  EXPECT_EQ(joins[1].at("outcome"), "refused");
}

// The second map fits the first by itself, but is fixed where the first cannot be.
TEST_F(Merge, NamesThePairThatTheOthersContradict) {
  const std::string middle = write_map(directory, "middle", map_part(draw_building(1), {0, 3, 18, 13}, {}));
  const std::string poses =
      directory.write("poses.tsv", "map\tx\ty\ttheta\n" + left + "\t0\t0\t0\n" + right + "\t200\t0\t0\n");
  const Outcome outcome =
      run({"merge", left, middle, right, "--init", poses, "--fix", left, "--fix", right, "-o", output});
  EXPECT_NE(outcome.out.find("rejected: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(" by themselves, but other maps or fixed poses contradict\n"), std::string::npos)
      << outcome.out;
  const Json joins = Json::parse(read_file(output + "/transforms.json")).at("joins");
  const auto rejected = std::find_if(joins.begin(), joins.end(),
                                     [](const Json& join) { return join.at("outcome") == "rejected"; });
  ASSERT_NE(rejected, joins.end());
  EXPECT_EQ(rejected->at("verdict"), "refused");
  EXPECT_EQ(rejected->at("reason"), "contradicts_others");
}

TEST_F(Merge, LeavesOutWhatDoesNotFit) {
  const Outcome outcome = run({"merge", left, other, right, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("left out: " + other + ": "), std::string::npos) << outcome.out;
  EXPECT_EQ(files_in(output), all_files);
  const Json json = Json::parse(read_file(output + "/transforms.json"));
  EXPECT_EQ(json.at("left_out"), Json::array({other}));
  expect_keys(json.at("left_out_maps").at(0), {"source", "reason"});
  EXPECT_EQ(json.at("left_out_maps").at(0).at("source"), other);
  EXPECT_EQ(json.at("components").at(0).at("members").size(), 2u);
}

TEST_F(Merge, OfMapsThatAllDifferSaysSo) {
  const Outcome outcome = run({"merge", left, other, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  const Json json = Json::parse(read_file(output + "/transforms.json"));
  EXPECT_EQ(json.at("components"), Json::array());
  EXPECT_EQ(json.at("left_out"), Json::array({left, other}));
  EXPECT_EQ(files_in(output).count("merged.yaml"), 0u);
}

TEST_F(Merge, WaysAmongWhichNothingDecidesAreNamed) {
  // Two wings, each the other one turned by half a turn: the map of one wing fits both.
  const OccupancyGrid wing = draw_building(1);
  OccupancyGrid both = make_grid(2 * wing.width, wing.height, wing.resolution);
  for (int row = 0; row < wing.height; ++row) {
    for (int column = 0; column < wing.width; ++column) {
      both.at(column, row) = wing.at(column, row);
      both.at(both.width - 1 - column, both.height - 1 - row) = wing.at(column, row);
    }
  }
  const std::string whole = write_map(directory, "whole", both), part = write_map(directory, "part", wing);
  const Outcome outcome = run({"merge", whole, part, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
  EXPECT_NE(outcome.out.find("perhaps: " + part + " in the frame of " + whole + " at x "), std::string::npos)
      << outcome.out;
  const Json ways = Json::parse(read_file(output + "/transforms.json")).at("open_ways");
  ASSERT_EQ(ways.size(), 2u);
  double turns = 0.0;
  for (const Json& way : ways) {
    expect_keys(way, {"fixed", "moving", "transform", "probability"});
    EXPECT_EQ(way.at("fixed"), whole);
    EXPECT_EQ(way.at("moving"), part);
    EXPECT_GT(way.at("probability"), 0.4);
    EXPECT_LT(way.at("probability"), 0.6);
    turns += std::abs(way.at("transform").at("theta").get<double>());
  }
  EXPECT_NEAR(turns, 3.14159, 0.02);  // one as it is, one by half a turn
}

TEST_F(Merge, OfOneMapTwiceIsThatMap) {
  const Outcome outcome = run({"merge", left, left, "-o", output});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("given twice, and counted once: " + left + "\n"), std::string::npos)
      << outcome.err;
  const Json json = Json::parse(read_file(output + "/transforms.json"));
  expect_near(json.at("components").at(0).at("members").at(1).at("transform"), {}, 0.05, 0.0035);
  // Up a tree it is fused twice.
  const Outcome tree = run({"merge", left, left, "-o", output, "--strategy", "tree"});
  EXPECT_NE(tree.err.find("given twice, and counted each time: " + left + "\n"), std::string::npos)
      << tree.err;
}

TEST_F(Merge, AMapThatIsGivenTwiceCanBeShownAgain) {
  const std::vector<std::vector<std::string>> inputs = {
      {left, left}, {left, right, left}, {right, left, left}, {left, left, other}, {other, other, left}};
  for (const std::vector<std::string>& maps : inputs) {
    std::vector<std::string> arguments = {"merge", "-o", output};
    arguments.insert(arguments.end(), maps.begin(), maps.end());
    EXPECT_EQ(run(arguments).exit_code % 3, 0);
    const std::string page = read_file(output + "/report.html");
    EXPECT_EQ(run({"report", output}).err, "");
    EXPECT_TRUE(read_file(output + "/report.html") == page) << arguments[3] << " " << arguments[4];
  }
}

TEST_F(Merge, NamesTheOptionsByWhichTwoMapsWouldBeJoined) {
  const Outcome outcome =
      run({"merge", left, right, "--accept", "0.5", "--max-false-joins", "0", "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(
      outcome.out.find(
          "\n     a higher --max-false-joins asks for less: this join alone is false with probability 0.0"),
      std::string::npos)
      << outcome.out;
}

TEST_F(Merge, SaysWhereTheBudgetIsWhatLeavesAMapOut) {
  const auto merge_within = [&](const std::string& budget) {
    return run({"merge", left, right, other, "--accept", "0.5", "--max-false-joins", budget, "-o", output})
        .out;
  };
  const std::string pair = left + " and " + right;
  const std::string none = merge_within("0");
  EXPECT_NE(none.find("left out: " + left + ": its joins are too doubtful for the budget of false joins\n"),
            std::string::npos)
      << none;
  EXPECT_NE(none.find("over budget: " + pair), std::string::npos) << none;
  EXPECT_EQ(none.find("contradict"), std::string::npos) << none;
  const Json join = Json::parse(read_file(output + "/transforms.json")).at("joins").at(0);
  EXPECT_EQ(join.at("outcome"), "refused");
  EXPECT_EQ(join.at("reason"), "over_budget");
  EXPECT_EQ(run({"report", output}).err.find("reason"), std::string::npos);
  const std::string enough = merge_within("1");
  EXPECT_EQ(enough.find("budget"), std::string::npos) << enough;
}

TEST_F(Merge, OfManyJoinsOfAKindTellsTheFirstTen) {
  std::vector<std::string> arguments{"merge", "--max-false-joins", "0", "-o", output};
  for (int i = 0; i < 6; ++i) {
    const double x = i;
    arguments.push_back(write_map(directory, "part_" + std::to_string(i),
                                  map_part(draw_building(1), {x, 0, 13 + x, 13}, {x, 0.3 * x, 0.2 * x})));
  }
  std::istringstream lines(run(arguments).out);
  int told = 0;
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("over budget: ")) continue;
    ++told;
    last = line;
  }
  EXPECT_EQ(told, 11);
  EXPECT_EQ(last, "over budget: 5 more, see transforms.json");
}

/// Which of the two has too little in it, the reason cannot tell.
TEST_F(Merge, OfAMapBesideABlankOneSaysNotThatItIsBlank) {
  const std::string blank = write_map(directory, "blank", make_grid(40, 30, 0.1));
  const std::string out = run({"merge", left, blank, "-o", output}).out;
  EXPECT_NE(out.find("left out: " + left + ": there is too little in it, or in the others, to compare\n"),
            std::string::npos)
      << out;
}

TEST_F(Merge, NamesWhatToAskOfAMapThatIsLeftOut) {
  const std::string out = run({"merge", left, right, other, "-o", output}).out;
  const std::size_t at = out.find("\ntry: gridmerge match ");
  ASSERT_NE(at, std::string::npos) << out;
  EXPECT_NE(out.substr(at, out.find('\n', at + 1) - at).find(other), std::string::npos) << out;
}

TEST_F(Merge, OfMapsWithNothingToCompareAsksForNothingThatCannotHelp) {
  for (const Cell cell : {Cell::unknown, Cell::occupied}) {
    const std::string a = write_map(directory, "a", make_grid(1, 1, 0.1, {}, cell));
    const std::string b = write_map(directory, "b", make_grid(1, 1, 0.1, {2.0, 0.0, 0.0}, cell));
    const std::string out = run({"merge", a, b, "-o", output}).out;
    for (const char* const hint :
         {"nearest to it", "--accept", "--max-false-joins", "gridmerge match", "--plan"})
      EXPECT_EQ(out.find(hint), std::string::npos) << out;
    EXPECT_NE(out.find("there is too little in it, or in the others, to compare"), std::string::npos) << out;
    EXPECT_NE(out.find("--init TABLE and --fix MAP"), std::string::npos) << "which place them all the same";
    // Beside maps that can be compared, these are the nearest.
    const std::string beside = run({"merge", a, left, other, "-o", output}).out;
    EXPECT_NE(beside.find("nearest to it: " + left + " and " + other), std::string::npos) << beside;
  }
}

TEST_F(Merge, OfOneMapOnAPlanDoesNotSpeakOfOthers) {
  const std::string dot = write_map(directory, "dot", make_grid(1, 1, 0.1, {}, Cell::occupied));
  EXPECT_EQ(run({"merge", dot, "--plan", left, "-o", output}).out.find("hint"), std::string::npos);
}

TEST_F(Merge, HelpSaysWhatTheThoroughLookIsFor) {
  const std::string help = run({"merge", "--help"}).out;
  EXPECT_EQ(help.find("decides nothing"), std::string::npos) << help;
  EXPECT_NE(run({"merge", left, right, "-o", output, "--search", "random-walk", "--strategy", "joint"})
                .err.find("--search exhaustive, quick or thorough"),
            std::string::npos);
}

TEST_F(Merge, LeavesOutMapsWithNothingToGoBy) {
  const std::string blank = write_map(directory, "blank", make_grid(40, 30, 0.1));
  const std::string dot = write_map(directory, "dot", make_grid(1, 1, 0.1, {}, Cell::occupied));
  const Outcome outcome = run({"merge", blank, left, dot, right, "-o", output, "--quiet"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(Json::parse(read_file(output + "/transforms.json")).at("left_out"), Json::array({blank, dot}));
}

TEST_F(Merge, QuietStillPrintsTheResult) {
  const std::vector<std::string> arguments = {"merge", left, right, "-o", output};
  std::vector<std::string> quiet = arguments;
  quiet.push_back("--quiet");
  EXPECT_EQ(run(quiet).out, run(arguments).out);
}

TEST_F(Merge, TheNumberOfThreadsChangesNoByte) {
  const std::string one = directory.file("one"), two = directory.file("two");
  ASSERT_EQ(run({"merge", left, other, right, "-o", one, "--threads", "1"}).exit_code, 3);
  ASSERT_EQ(run({"merge", left, other, right, "-o", two, "--threads", "2"}).exit_code, 3);
  for (const char* name : {"/transforms.json", "/merged.pgm", "/merged.yaml"}) {
    EXPECT_EQ(read_file(one + name), read_file(two + name)) << name;
  }
}

TEST_F(Merge, OutputResolutionIsThatOfTheMergedMap) {
  ASSERT_EQ(run({"merge", left, right, "-o", output, "--output-resolution", "0.2"}).exit_code, 0);
  const Json info = Json::parse(run({"info", "--json", output + "/merged.yaml"}).out);
  EXPECT_EQ(info.at("maps").at(0).at("resolution"), 0.2);

  const std::string too_fine = directory.file("fine");
  expect_error(run({"merge", left, right, "-o", too_fine, "--output-resolution", "1e-6"}), left, "cells");
  EXPECT_FALSE(std::filesystem::exists(too_fine));
}

TEST_F(Merge, AnImageOfAnInputIsNeverReplacedOrRemoved) {
  for (const std::string name : {"merged.pgm", "merged_2.pgm"}) {
    directory.write("w/floor.yaml",
                    "image: " + name +
                        "\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
                        "free_thresh: 0.196\n");
    const std::string before = read_file(directory.file("left.pgm"));
    const std::string image = directory.write("w/" + name, before);
    expect_error(run({"merge", directory.file("w/floor.yaml"), right, "-o", directory.file("w")}), image,
                 "is an input");
    EXPECT_EQ(read_file(image), before);
    std::filesystem::remove(image);
  }
}

TEST_F(Merge, ReplacesAnEarlierResult) {
  ASSERT_EQ(run({"merge", left, other, right, "-o", output}).exit_code, 3);
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  EXPECT_EQ(files_in(output), all_files);
  EXPECT_EQ(Json::parse(read_file(output + "/transforms.json")).at("left_out"), Json::array());
}

TEST_F(Merge, BothStrategiesPutTheMapsInTheSamePlace) {
  for (const std::string strategy : {"joint", "tree"}) {
    ASSERT_EQ(run({"merge", left, right, "-o", output, "--strategy", strategy}).exit_code, 0);
    const Json json = Json::parse(read_file(output + "/transforms.json"));
    const Json& member = json.at("components").at(0).at("members").at(1);
    expect_near(member.at("transform"), T_left_right, 0.1, 0.007);
    EXPECT_EQ(member.at("probability").is_null(), strategy == "tree");
  }
}

TEST_F(Merge, OptionsThatDoNotGoTogetherAreAUsageError) {
  EXPECT_EQ(run({"merge", left, right, "-o", output, "--strategy", "tree", "--fix", left}).exit_code, 2);
  EXPECT_EQ(
      run({"merge", left, right, "-o", output, "--search", "random-walk", "--strategy", "joint"}).exit_code,
      2);
  EXPECT_EQ(run({"merge", left, right, "-o", output, "--strategy", "best"}).exit_code, 2);
}

TEST_F(Merge, AnOutputDirectoryThatCannotBeWrittenIsAnError) {
  const std::string file = directory.write("file", "not a directory");
  expect_error(run({"merge", left, right, "-o", file}), file, "");
  expect_error(run({"merge", left, right, "-o", file + "/out"}), file, "Not a directory");
  expect_error(run({"merge", left, right, "-o", "/proc/gridmerge"}), "/proc/gridmerge", "");
  EXPECT_EQ(read_file(file), "not a directory");
}

TEST_F(Merge, AFullDiskLeavesNothingHalfWritten) {
  for (const std::size_t limit : {100u, 3000u, 9000u}) {
    RunOptions options;
    options.file_size_limit = limit;
    expect_error(run({"merge", left, right, "-o", output}, options), output, "File too large");
    EXPECT_FALSE(std::filesystem::exists(output)) << limit;
  }
  // What an earlier run wrote stays whole.
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  const std::string before = read_file(output + "/merged.pgm");
  RunOptions options;
  options.file_size_limit = 9000;
  EXPECT_EQ(run({"merge", left, right, "-o", output}, options).exit_code, 1);
  EXPECT_EQ(files_in(output), all_files);
  EXPECT_EQ(read_file(output + "/merged.pgm"), before);
}

}  // namespace
}  // namespace gridmerge::test
