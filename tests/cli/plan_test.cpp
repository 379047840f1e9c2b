// SPDX-License-Identifier: Apache-2.0
// merge --plan, end to end.
#include <filesystem>
#include <fstream>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

class MergePlan : public CliTest {
 protected:
  MergePlan() {
    OccupancyGrid drawing = draw_building(1);
    drawing.resolution *= 0.8;
    plan = write_map(directory, "plan", drawing);
    west = write_map(directory, "west", map_part(draw_building(1), {0, 0, 9, 13}, T_left_building));
    east = write_map(directory, "east", map_part(draw_building(1), {9, 0, 18, 13}, T_right_building));
  }

  Json transforms() const { return Json::parse(read_file(output + "/transforms.json")); }

  std::string plan, west, east;  // the ends of the building, which have nothing in common
  const std::string output = directory.file("out");
};

TEST_F(MergePlan, JoinsWhatNothingElseJoins) {
  const Outcome outcome = run({"merge", west, east, "--plan", plan, "--plan-scale", "1.1:1.4", "-o", output});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("merged.yaml: 2 of 2 maps"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("plan " + plan + ": 2 of 2 maps hang on it, as merged.yaml, enlarged by 1.2"),
            std::string::npos)
      << outcome.out;
  const Json json = transforms();
  ASSERT_EQ(json.at("components").size(), 1u);
  const Json& component = json.at("components").at(0);
  EXPECT_TRUE(component.at("frame").is_null());
  for (const Json& member : component.at("members")) {
    const SE2& T = member.at("source") == west ? T_left_building : T_right_building;
    expect_near(member.at("transform"), inverse(T), 0.4, 0.03);
  }
  const Json& told = json.at("plan");
  expect_keys(told, {"source", "resolution", "scale", "probability", "component", "maps", "parts"});
  EXPECT_EQ(told.at("source"), plan);
  EXPECT_NEAR(told.at("scale"), 1.25, 0.02);
  EXPECT_GE(told.at("probability"), 0.95);
  EXPECT_EQ(told.at("component"), "merged.yaml");
  EXPECT_EQ(told.at("maps"), (Json{west, east}));
  ASSERT_EQ(told.at("parts").size(), 2u);
  for (const Json& part : told.at("parts")) {
    expect_keys(part, {"maps", "transform", "scale", "probability", "reason"});
    EXPECT_NEAR(part.at("scale"), 1.25, 0.05);
  }
  EXPECT_EQ(told.at("resolution"), draw_building(1).resolution * 0.8);
  // The page names the plan, and a report that is made again is the same to the byte.
  const std::string page = read_file(output + "/report.html");
  EXPECT_NE(page.find("\"plan\":{\"name\":"), std::string::npos);
  ASSERT_EQ(run({"report", output}).exit_code, 0);
  EXPECT_EQ(read_file(output + "/report.html"), page);
  EXPECT_EQ(run({"merge", west, east, "-o", output}).exit_code, 3);
  EXPECT_FALSE(transforms().contains("plan"));
}

// Its scale is to be found, so nobody has to know its resolution.
TEST_F(MergePlan, AnImageNeedsNoResolution) {
  const std::string image = directory.file("plan.pgm");
  const Outcome outcome =
      run({"merge", left, right, "--plan", image, "--plan-scale", "0.9:1.1", "-o", output});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "gridmerge: warning: " + image +
                             ": no --resolution says how large its pixels are, so the range of scales counts "
                             "from 0.1 m, as of " +
                             left + "\n");
  EXPECT_NEAR(transforms().at("plan").at("scale"), 1.0, 0.02);
  const Outcome told = run({"merge", left, right, "--plan", image, "--resolution", "0.08", "--plan-scale",
                            "1.1:1.4", "-o", output});
  EXPECT_EQ(told.err, "");
  EXPECT_NEAR(transforms().at("plan").at("scale"), 1.25, 0.02);
}

// As the merge counted its pixels, whatever the report is told of images.
TEST_F(MergePlan, AReportThatIsMadeAgainShowsThePlanToo) {
  const std::string image = directory.file("plan.pgm");
  ASSERT_EQ(run({"merge", left, right, "--plan", image, "--plan-scale", "0.9:1.1", "-o", output}).exit_code,
            0);
  const std::string page = read_file(output + "/report.html");
  EXPECT_NE(page.find("\"grid\":{\"width\":"), std::string::npos);
  const Outcome again = run({"report", output, "--resolution", "0.3"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.err, "");
  EXPECT_EQ(read_file(output + "/report.html"), page);
  std::filesystem::rename(image, directory.file("moved.pgm"));
  const Outcome without = run({"report", output});
  EXPECT_EQ(without.exit_code, 0) << without.err;
  EXPECT_NE(without.err.find(image), std::string::npos) << without.err;
  EXPECT_NE(without.err.find("the report does not show the plan"), std::string::npos) << without.err;
  EXPECT_NE(read_file(output + "/report.html").find("\"grid\":null"), std::string::npos);
}

TEST_F(MergePlan, APlanWhosePixelsAreOfAnotherSizeByNowIsNotDrawn) {
  const std::string copy = directory.file("copy.yaml");
  std::string yaml = read_file(plan);
  directory.write("copy.yaml", yaml);
  ASSERT_EQ(run({"merge", left, right, "--plan", copy, "--plan-scale", "1.1:1.4", "-o", output}).exit_code,
            0);
  const std::size_t at = yaml.find("resolution: ");
  ASSERT_NE(at, std::string::npos);
  directory.write("copy.yaml", yaml.replace(at, yaml.find('\n', at) - at, "resolution: 0.3"));
  const Outcome report = run({"report", output});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_NE(report.err.find("has pixels of 0.3 m, and had "), std::string::npos) << report.err;
  EXPECT_NE(read_file(output + "/report.html").find("\"grid\":null"), std::string::npos);
}

TEST_F(MergePlan, MapsThatThePlanAloneJoinsAreNotBent) {
  const Outcome outcome =
      run({"merge", west, east, "--plan", plan, "--plan-scale", "1.1:1.4", "--elastic", "-o", output});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("no map is bent: maps that the plan alone joins stay as they are\n"),
            std::string::npos)
      << outcome.out;

  // Maps of another building are straight, which is why those are not bent.
  const std::string here =
      write_map(directory, "here", map_part(draw_building(2), {0, 0, 13, 13}, T_left_building));
  const std::string there =
      write_map(directory, "there", map_part(draw_building(2), {5, 0, 18, 13}, T_right_building));
  const Outcome both = run({"merge", west, east, here, there, "--plan", plan, "--plan-scale", "1.1:1.4",
                            "--elastic", "-o", output});
  EXPECT_EQ(both.exit_code, 3) << both.out << both.err;
  EXPECT_NE(both.out.find("no map is bent: by what they say, bending would bring their walls no nearer\n"),
            std::string::npos)
      << both.out;
}

TEST_F(MergePlan, ADrawingAmongTheMapsMayBeTheirPlan) {
  const std::string drawing = write_map(directory, "drawing", on_white_paper(draw_building(2)));
  const Outcome outcome = run({"merge", left, right, drawing, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("hint: " + drawing + " looks like a drawing of walls: --plan " + drawing + " "),
            std::string::npos)
      << outcome.out;
}

TEST_F(MergePlan, SaysWhatIsNotOnThePlanAndWhy) {
  const Outcome outcome =
      run({"merge", left, right, other, "--plan", plan, "--plan-scale", "1.1:1.4", "-o", output});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("2 of 3 maps hang on it"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("off the plan: " + other + ": "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("; the best way: x "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(", the plan enlarged by 1."), std::string::npos) << outcome.out;
  EXPECT_NE(transforms().at("plan").at("parts").at(1).at("reason"), nullptr);
}

TEST_F(MergePlan, AStrangersPlanChangesNothing) {
  ASSERT_EQ(run({"merge", left, right, "-o", output}).exit_code, 0);
  Json before = transforms();
  const Outcome outcome =
      run({"merge", left, right, "--plan", other, "--plan-scale", "0.9:1.1", "-o", output});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("plan " + other + ": no map hangs on it\n"), std::string::npos) << outcome.out;
  Json after = transforms();
  EXPECT_TRUE(after.at("plan").at("scale").is_null());
  EXPECT_TRUE(after.at("plan").at("component").is_null());
  EXPECT_EQ(after.at("plan").at("maps"), Json::array());
  after.erase("plan");
  EXPECT_EQ(after, before);
}

TEST_F(MergePlan, APlanOfAnotherSizeIsToldWithTheRangeThatFits) {
  OccupancyGrid drawing = on_white_paper(draw_building(1));
  drawing.resolution *= 8.0;
  const std::string large = write_map(directory, "large", drawing);
  const std::vector<std::string> asked{"merge",        left,      right, "--plan", large,
                                       "--plan-scale", "0.9:1.1", "-o",  output};
  const Outcome outcome = run(asked);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("times the floor of the merged map as it is"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(", and --plan-scale 0.1"), std::string::npos) << outcome.out;
}

TEST_F(MergePlan, OneMapThatHangsThereAloneIsToldOf) {
  const Outcome outcome =
      run({"merge", west, other, "--plan", plan, "--plan-scale", "1.2:1.3", "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("1 of 2 maps hang on it, enlarged by 1.2"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\n  " + west + ": x "), std::string::npos) << outcome.out;
  EXPECT_EQ(transforms().at("plan").at("maps"), Json{west});
}

TEST_F(MergePlan, OneMapIsEnough) {
  const Outcome outcome = run({"merge", west, "--plan", plan, "--plan-scale", "1.2:1.3", "-o", output});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.out.find("plan " + plan + ": 1 of 1 maps hang on it, enlarged by 1.2"), 0u)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("left out"), std::string::npos) << outcome.out;
  EXPECT_EQ(transforms().at("plan").at("maps"), Json{west});
  const std::string page = read_file(output + "/report.html");
  EXPECT_NE(page.find("\"places\":[{\"component\":null,\"map\":0,"), std::string::npos);
  ASSERT_EQ(run({"report", output}).exit_code, 0);
  EXPECT_EQ(read_file(output + "/report.html"), page);
  const std::vector<std::string> doubtful{"merge",   west, "--plan", plan,       "--plan-scale",
                                          "1.2:1.3", "-o", output,   "--accept", "0.99999"};
  EXPECT_NE(run(doubtful).out.find("\n     a lower --accept asks for less\n"), std::string::npos);
  const std::vector<std::string> none_false{
      "merge", west, "--plan", plan, "--plan-scale", "1.2:1.3", "-o", output, "--max-false-joins", "0"};
  EXPECT_NE(
      run(none_false)
          .out.find("\n     a higher --max-false-joins asks for less: the most probable place is false with"),
      std::string::npos);
  const Outcome stranger = run({"merge", other, "--plan", plan, "--plan-scale", "1.2:1.3", "-o", output});
  EXPECT_EQ(stranger.exit_code, 3);
  EXPECT_EQ(stranger.out.find("--accept"), std::string::npos) << stranger.out;
  EXPECT_EQ(stranger.out.find("plan " + plan + ": no map hangs on it\n"), 0u) << stranger.out;
  const Outcome alone = run({"merge", west, "-o", output});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("MAP"), std::string::npos) << alone.err;
}

TEST_F(MergePlan, WhatMakesNoSenseIsAUsageError) {
  const auto expect_usage = [&](std::vector<std::string> more, const std::string& option) {
    std::vector<std::string> asked{"merge", left, right};
    asked.insert(asked.end(), more.begin(), more.end());
    const Outcome outcome = run(asked);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    EXPECT_NE(outcome.err.find(option), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(output));
  };
  for (const char* range : {"2:0.5", "0:1", "nan:1", "0.1:9", "1", "a:b", ""})
    expect_usage({"--plan", plan, "--plan-scale", range, "-o", output}, "--plan-scale");
  expect_usage({"--plan-scale", "0.5:2", "-o", output}, "--plan");
  expect_usage({"--plan", plan, "--strategy", "tree", "-o", output}, "--plan");
  expect_usage({"--plan", plan, "--search", "random-walk", "-o", output}, "--plan");
  expect_usage({"--plan", plan, "--fix", left, "-o", output}, "--plan");
  expect_usage({"--plan", plan, "--cache", directory.file("cache"), "--shard", "1/2"}, "--plan");
}

TEST_F(MergePlan, APlanThatIsNoneIsAnError) {
  const auto asked = [&](const std::string& file) {
    return run({"merge", left, right, "--plan", file, "-o", output});
  };
  const std::string bare = write_map(directory, "bare", make_grid(40, 30, 0.1, {}, Cell::free));
  expect_error(asked(bare), bare, "no walls");
  expect_error(asked(left), left, "one of the maps");
  const std::string copy =
      write_map(directory, "copy", map_part(draw_building(1), {5, 0, 18, 13}, {1.0, -7.0, -1.1}));
  expect_error(asked(copy), copy, "the same as map 1");
  expect_error(asked(directory.file("absent.yaml")), "absent.yaml", "");
  EXPECT_FALSE(std::filesystem::exists(output));
}

/// The plan is an input too: its file is not replaced.
TEST_F(MergePlan, APlanInTheOutputDirectoryIsKept) {
  std::filesystem::create_directory(output);
  std::filesystem::rename(directory.file("plan.pgm"), output + "/merged.pgm");
  std::filesystem::rename(plan, output + "/merged.yaml");
  std::ofstream(output + "/merged.yaml")
      << "image: merged.pgm\nresolution: 0.08\norigin: [0, 0, 0]\nnegate: 0\n"
         "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  const std::string before = read_file(output + "/merged.pgm");
  expect_error(run({"merge", west, east, "--plan", output + "/merged.yaml", "-o", output}), "merged.yaml",
               "would be replaced");
  EXPECT_EQ(read_file(output + "/merged.pgm"), before);
}

}  // namespace
}  // namespace gridmerge::test
