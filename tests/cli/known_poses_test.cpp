// SPDX-License-Identifier: Apache-2.0
// merge --init and --fix.
#include "fixture.hpp"
#include "grid/quarter_turned.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge::test {
namespace {

class KnownPoses : public CliTest {
 protected:
  const std::string output = directory.file("out");
};

TEST_F(KnownPoses, FixedPosesThatTheMapsContradictAreNamed) {
  const std::string poses = directory.write(
      "poses.tsv", "map\tx\ty\ttheta\nleft.yaml\t0\t0\t0\nright.yaml\t" +
                       std::to_string(T_left_right.x + 60.0) + "\t" + std::to_string(T_left_right.y) + "\t" +
                       std::to_string(T_left_right.theta) + "\n");
  const Outcome outcome =
      run({"merge", left, right, "--init", poses, "--fix", left, "--fix", right, "-o", output});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.out.find(right + ": --fix keeps it 60 m from where it fits " + left), std::string::npos)
      << outcome.out;
}

TEST_F(KnownPoses, FixTakesOneMapAndNoticesACopy) {
  // The second name after --fix is one more input.
  const Outcome outcome = run({"merge", left, right, "--fix", left, right, "-o", output});
  EXPECT_NE(outcome.err.find("given twice, and counted once: " + right + "."), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("--fix takes one map"), std::string::npos) << outcome.err;
  const std::string copy = directory.write("copy.yaml", read_file(left));
  const std::string warned = run({"merge", left, right, copy, right, "-o", output}).err;
  EXPECT_NE(warned.find("copies, which count once: " + copy + " (of " + left + ")\n"), std::string::npos)
      << warned;
  EXPECT_NE(warned.find("given twice, and counted once: " + right + "\n"), std::string::npos) << warned;
  // Of the two that whose pose is known is the original.
  const std::string poses = directory.write("of_copy.tsv", "map\tx\ty\ttheta\ncopy.yaml\t1\t2\t0\n");
  const std::string of_known = run({"merge", left, copy, "--init", poses, "-o", output}).err;
  EXPECT_NE(of_known.find("copies, which count once: " + left + " (of " + copy + ")\n"), std::string::npos)
      << of_known;
  // Turned, and on a larger sheet, it is that map all the same.
  const OccupancyGrid turned = internal::quarter_turned(load_map(left).grid, 1);
  OccupancyGrid sheet = make_grid(turned.width + 20, turned.height + 20, turned.resolution, turned.origin);
  for (int row = 0; row < turned.height; ++row)
    for (int column = 0; column < turned.width; ++column)
      sheet.at(column + 10, row + 10) = turned.at(column, row);
  const std::string saved = directory.file("turned.yaml");
  save_map(sheet, saved);
  const std::string of_turned = run({"merge", left, right, saved, "-o", output}).err;
  EXPECT_NE(of_turned.find("copies, which count once: " + saved + " (of " + left + ")\n"), std::string::npos)
      << of_turned;
  const std::string help = run({"merge", "--help"}).out;
  EXPECT_NE(help.find("--fix MAP "), std::string::npos) << help;
  EXPECT_EQ(help.find("--fix MAP ..."), std::string::npos) << help;
}

TEST_F(KnownPoses, AGivenPoseThatTwoMapsContradictIsNamed) {
  const std::string poses = directory.write(
      "poses.tsv", "map\tx\ty\ttheta\tsd\tsd_theta\nleft.yaml\t0\t0\t0\t0.05\t0.005\nright.yaml\t" +
                       std::to_string(T_left_right.x + 60.0) + "\t" + std::to_string(T_left_right.y) + "\t" +
                       std::to_string(T_left_right.theta) + "\t0.05\t0.005\n");
  const Outcome outcome = run({"merge", left, right, "--init", poses, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("the given pose is 60 m from where the map surely fits "), std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("a lower --accept"), std::string::npos) << outcome.out;
}

TEST_F(KnownPoses, APrecisePoseThatPutsWallsBesideWallsIsNotBelievedBlindly) {
  const std::string poses = directory.write(
      "poses.tsv", "map\tx\ty\ttheta\tsd\tsd_theta\nleft.yaml\t0\t0\t0\t0.05\t0.005\nright.yaml\t" +
                       std::to_string(T_left_right.x - 3.0) + "\t" + std::to_string(T_left_right.y) + "\t" +
                       std::to_string(T_left_right.theta) + "\t0.05\t0.005\n");
  const Outcome outcome = run({"merge", left, right, "--init", poses, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("the given pose is 3 m from where the map surely fits "), std::string::npos)
      << outcome.out;
}

TEST_F(KnownPoses, APoseThatLaysUnrelatedMapsOnEachOtherIsDoubted) {
  const std::string elsewhere = write_map(directory, "elsewhere", draw_building(2));
  const std::string poses =
      directory.write("poses.tsv",
                      "map\tx\ty\ttheta\tsd\tsd_theta\nleft.yaml\t0\t0\t0\t0.05\t0.005\n"
                      "elsewhere.yaml\t-3\t2\t0.4\t0.05\t0.005\n");
  const Outcome doubted = run({"merge", left, elsewhere, "--init", poses, "-o", output});
  EXPECT_EQ(doubted.exit_code, 3);
  EXPECT_NE(doubted.out.find("the given pose is not used: what the maps say contradicts it"),
            std::string::npos)
      << doubted.out;
  EXPECT_NE(doubted.out.find(" without the given poses\n"), std::string::npos) << doubted.out;
  EXPECT_NE(doubted.out.find("this join alone is false with probability 0.06"), std::string::npos)
      << doubted.out;
  const Outcome asked_for = run({"merge", left, elsewhere, "--init", poses, "-o", output, "--accept", "0.9",
                                 "--max-false-joins", "0.1"});
  EXPECT_EQ(asked_for.exit_code, 0);
  EXPECT_NE(asked_for.out.find("lie double; an initial pose may be wrong, or --elastic bends maps"),
            std::string::npos)
      << asked_for.out;
}

TEST_F(KnownPoses, AFixedMapThatIsLeftOutIsNamed) {
  const std::string blank = write_map(directory, "blank", make_grid(40, 30, 0.1));
  const Outcome outcome = run({"merge", left, right, blank, "--fix", blank, "-o", output});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_NE(outcome.out.find(blank + ": --fix has no effect, as the map is left out\ntry: --init "),
            std::string::npos)
      << outcome.out;
}

TEST_F(KnownPoses, FixedMapsMakeTheFrame) {
  ASSERT_EQ(run({"merge", left, right, "-o", output, "--fix", right}).exit_code, 0);
  Json members = Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
  expect_near(members.at(1).at("transform"), {}, 1e-12, 1e-12);
  expect_near(members.at(0).at("transform"), inverse(T_left_right), 0.1, 0.007);

  const std::string poses = directory.write("poses.tsv", "map\tx\ty\ttheta\nright.yaml\t100\t-50\t1.5\n");
  ASSERT_EQ(run({"merge", left, right, "-o", output, "--fix", right, "--init", poses}).exit_code, 0);
  members = Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("members");
  expect_near(members.at(1).at("transform"), {100.0, -50.0, 1.5}, 1e-12, 1e-12);
  EXPECT_TRUE(
      Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("frame").is_null());
}

TEST_F(KnownPoses, OnePoseAloneIsToldToSayNothing) {
  const std::string poses = directory.write("poses.tsv", "map\tx\ty\ttheta\nright.yaml\t100\t-50\t1.5\n");
  const std::vector<std::string> words{"merge", left, right, "-o", output, "--init", poses};
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find(poses + ": one pose alone says nothing about how maps lie"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("--fix " + right), std::string::npos) << outcome.err;
  std::vector<std::string> fixed = words;
  fixed.insert(fixed.end(), {"--fix", right});
  EXPECT_EQ(run(fixed).err, "");
}

TEST_F(KnownPoses, NothingBendsMapsThatAreFixed) {
  // Half a metre off, so that walls lie double.
  const std::string poses = directory.write("poses.tsv", "map\tx\ty\ttheta\n" + left + "\t0\t0\t0\n" + right +
                                                             "\t" + std::to_string(T_left_right.x + 0.4) +
                                                             "\t" + std::to_string(T_left_right.y) + "\t" +
                                                             std::to_string(T_left_right.theta) + "\n");
  const std::vector<std::string> words{"merge", left,    right, "-o",    output, "--init",
                                       poses,   "--fix", left,  "--fix", right};
  std::vector<std::string> verbose = words, elastic = words;
  verbose.emplace_back("--verbose");
  const std::string told = run(verbose).out;
  EXPECT_NE(told.find("% of the walls that several maps saw lie double\n"), std::string::npos) << told;
  EXPECT_EQ(told.find("--elastic"), std::string::npos) << told;
  elastic.emplace_back("--elastic");
  const Outcome bent = run(elastic);
  EXPECT_NE(bent.out.find("no map is bent: --fix holds all of them as they are\n"), std::string::npos)
      << bent.out;
}

TEST_F(KnownPoses, InitialPosesJoinWhatTheMapsAloneDoNot) {
  const std::string poses =
      directory.write("poses.tsv", "map\tx\ty\ttheta\tsd\tsd_theta\n" + left +
                                       "\t0\t0\t0\t0.1\t0.01\nother.yaml\t30\t0\t0\t0.1\t0.01\n");
  const Outcome outcome = run({"merge", left, other, "-o", output, "--init", poses});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Json json = Json::parse(read_file(output + "/transforms.json"));
  const Json& join = json.at("joins").at(0);
  EXPECT_EQ(join.at("outcome"), "known");
  EXPECT_EQ(join.at("verdict"), "accepted");
  EXPECT_TRUE(join.at("reason").is_null());
  EXPECT_EQ(join.at("by_themselves").at("verdict"), "refused");
  // Of the pose that was used: 30 m apart the maps have nothing in common.
  EXPECT_EQ(join.at("agreement"), 0);
  EXPECT_EQ(join.at("overlap"), 0.0);
  expect_near(json.at("components").at(0).at("members").at(1).at("transform"), {30.0, 0.0, 0.0}, 0.5, 0.05);
}

TEST_F(KnownPoses, PosesFarApartThatAreNotSureEnoughNameTheRemedy) {
  const std::string table = "map\tx\ty\ttheta\nleft.yaml\t0\t0\t0\nother.yaml\t60\t0\t0\n";
  const std::string poses = directory.write("poses.tsv", table);
  const std::vector<std::string> arguments = {"merge", left, other, "--init", poses, "-o", output};
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, 3);
  const std::string line =
      left + ": the given pose is not sure enough to be used alone: beside that of " + other;
  EXPECT_NE(outcome.out.find(line), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("(sd 1 m, sd_theta 0.1 rad)"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("--fix " + other + " --fix " + left), std::string::npos) << outcome.out;
  // Once for the two, and before what is said of other remedies.
  EXPECT_EQ(outcome.out.find("not sure enough"), outcome.out.rfind("not sure enough")) << outcome.out;
  EXPECT_LT(outcome.out.find("not sure enough"), outcome.out.find("try: gridmerge match")) << outcome.out;

  // Both remedies are good ones: the factor that it names, and --fix.
  const std::size_t at = outcome.out.find("at most ") + 8;
  const double factor = std::stod(outcome.out.substr(at));
  ASSERT_GT(factor, 0.01);
  ASSERT_LT(factor, 0.5);
  const std::string sd = "\t" + std::to_string(0.95 * factor) + "\t" + std::to_string(0.095 * factor) + "\n";
  directory.write("poses.tsv",
                  "map\tx\ty\ttheta\tsd\tsd_theta\nleft.yaml\t0\t0\t0" + sd + "other.yaml\t60\t0\t0" + sd);
  EXPECT_EQ(run(arguments).exit_code, 0);
  directory.write("poses.tsv", table);
  std::vector<std::string> fixed = arguments;
  fixed.insert(fixed.end(), {"--fix", left, "--fix", other});
  EXPECT_EQ(run(fixed).exit_code, 0);
  const Json json = Json::parse(read_file(output + "/transforms.json"));
  expect_near(json.at("components").at(0).at("members").at(1).at("transform"), {60.0, 0.0, 0.0}, 1e-12,
              1e-12);
}

TEST_F(KnownPoses, APoseThatIsNotBelievedIsNamedWithTheDistance) {
  const auto table = [&](const SE2& T, double theta) {
    return directory.write("poses.tsv", "map\tx\ty\ttheta\nleft.yaml\t0\t0\t0\nright.yaml\t" +
                                            std::to_string(T.x) + "\t" + std::to_string(T.y) + "\t" +
                                            std::to_string(theta) + "\n");
  };
  const std::string right_one = table(T_left_right, T_left_right.theta);
  EXPECT_EQ(run({"merge", left, right, "--init", right_one, "-o", output}).out.find("believed"),
            std::string::npos);

  const Outcome far =
      run({"merge", left, right, "--init",
           table({T_left_right.x + 60.0, T_left_right.y, 0.0}, T_left_right.theta), "-o", output});
  EXPECT_EQ(far.exit_code, 0) << far.out;
  EXPECT_NE(far.out.find(right + ": the given pose is not believed: 60 m from where the maps fit"),
            std::string::npos)
      << far.out;

  const double degrees = T_left_right.theta * 180.0 / 3.14159265358979;
  const Outcome turned = run({"merge", left, right, "--init", table(T_left_right, degrees), "-o", output});
  EXPECT_NE(turned.err.find("more than a turn: it must be in radians"), std::string::npos) << turned.err;
  EXPECT_NE(turned.out.find("the given pose is not believed"), std::string::npos) << turned.out;
  EXPECT_NE(turned.out.find(" degrees from where the maps fit"), std::string::npos) << turned.out;
  EXPECT_EQ(far.out.find(" degrees from where"), std::string::npos) << far.out;
  EXPECT_NE(turned.out.find("look like degrees"), std::string::npos) << turned.out;
}

TEST_F(KnownPoses, CorrectPosesNeverMakeAMergeWorse) {
  const std::string poses = directory.write(
      "poses.tsv", "map\tx\ty\ttheta\nleft.yaml\t0\t0\t0\nright.yaml\t" + std::to_string(T_left_right.x) +
                       "\t" + std::to_string(T_left_right.y) + "\t" + std::to_string(T_left_right.theta) +
                       "\n");
  for (const std::string accept : {"0.95", "0.99", "0.999", "0.9999", "0.99995"}) {
    const int without = run({"merge", left, right, "--accept", accept, "-o", output}).exit_code;
    const int with = run({"merge", left, right, "--accept", accept, "--init", poses, "-o", output}).exit_code;
    EXPECT_LE(with, without) << "--accept " << accept;
  }
}

TEST_F(KnownPoses, OneFixedMapHoldsTheFrameByName) {
  ASSERT_EQ(run({"merge", left, right, "-o", output, "--fix", right}).exit_code, 0);
  EXPECT_EQ(Json::parse(read_file(output + "/transforms.json")).at("components").at(0).at("frame"), right);
  EXPECT_EQ(run({"report", output}).exit_code, 0);
}

TEST_F(KnownPoses, SaysWhatIsWrongWithInitialPoses) {
  const auto expect_bad = [&](const std::string& table, const std::string& cause) {
    const std::string poses = directory.write("poses.tsv", table);
    expect_error(run({"merge", left, right, "-o", output, "--init", poses}), poses, cause);
    EXPECT_FALSE(std::filesystem::exists(output));
  };
  const std::string head = "map\tx\ty\ttheta\n";
  expect_bad("map\tx\ty\n", "theta");
  expect_bad(head + "nowhere.yaml\t0\t0\t0\n", "none of the maps");
  expect_bad(head + "left.yaml\tnan\t0\t0\n", "finite");
  expect_bad(head + "left.yaml\t0\t0\t0\nleft.yaml\t1\t0\t0\n", "a second time");
  expect_bad(head + "left.yaml\t0\t0\t0\n" + left + "\t1\t0\t0\n", "named before");
  expect_bad("map\tx\ty\ttheta\tsd\nleft.yaml\t0\t0\t0\t-1\n", "positive");
  const std::string poses = directory.write("poses.tsv", head + "left.yaml\t0\t0\t0\n");
  expect_error(run({"merge", left, right, "-o", output, "--init", poses, "--fix", right}), right,
               "needs a pose");
  expect_error(run({"merge", left, right, "-o", output, "--fix", other}), other, "none of the maps");
  expect_error(run({"merge", left, right, "-o", output, "--fix", left, "--fix", right}), left,
               "needs a pose");
  const std::string by_another_way = directory.file("./left.yaml");
  for (const std::string& again : {left, by_another_way})
    expect_error(run({"merge", left, right, "-o", output, "--fix", left, "--fix", again}), "--fix " + left,
                 "is named twice");
}

}  // namespace
}  // namespace gridmerge::test
