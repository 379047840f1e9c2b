// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "fixture.hpp"

namespace gridmerge::test {
namespace {

constexpr double kHalfACell = 0.05;
constexpr double kFifthOfADegree = 0.0035;

class Match : public CliTest {
 protected:
  static void expect_contract(const Json& json) {
    expect_keys(json, {"fixed", "moving", "verdict", "reason", "transform", "probability", "acceptance_index",
                       "agreement", "disagreement", "overlap", "seconds", "hypotheses"});
    EXPECT_TRUE(json.at("agreement").is_number_integer());
    EXPECT_TRUE(json.at("disagreement").is_number_integer());
    for (const char* key : {"probability", "acceptance_index", "overlap"}) {
      EXPECT_GE(json.at(key), 0.0) << key;
      EXPECT_LE(json.at(key), 1.0) << key;
    }
    EXPECT_GT(json.at("seconds"), 0.0);
    for (const Json& hypothesis : json.at("hypotheses")) {
      expect_keys(hypothesis, {"transform", "score", "probability"});
      expect_keys(hypothesis.at("transform"), {"x", "y", "theta"});
    }
  }
};

TEST_F(Match, RefusedForWantOfMoreThanUsualNamesNoFaultAndNoFullProbability) {
  const double surely = Json::parse(run({"match", left, right, "--json"}).out).at("probability");
  ASSERT_GT(surely, 0.95);
  const Outcome outcome = run({"match", left, right, "--accept", "1"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.out.find(
                "refused: the maps show one place, but not as surely as is asked for (probability 0.9"),
            0u)
      << outcome.out;
}

TEST_F(Match, JsonOfAnAcceptedPairIsAllThereIsOnStdout) {
  const Outcome outcome = run({"match", left, right, "--json"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(outcome.out);
  expect_contract(json);
  EXPECT_EQ(json.at("fixed"), left);
  EXPECT_EQ(json.at("moving"), right);
  EXPECT_EQ(json.at("verdict"), "accepted");
  expect_near(json.at("transform"), T_left_right, 2 * kHalfACell, 2 * kFifthOfADegree);
  ASSERT_FALSE(json.at("hypotheses").empty());
  EXPECT_EQ(json.at("hypotheses").at(0).at("transform"), json.at("transform"));
  EXPECT_EQ(json.at("hypotheses").at(0).at("probability"), json.at("probability"));
}

TEST_F(Match, JsonOfARefusedPairHasTheSameForm) {
  const Outcome outcome = run({"match", left, other, "--json"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(outcome.out);
  expect_contract(json);
  EXPECT_EQ(json.at("verdict"), "refused");
}

TEST_F(Match, TellsPeopleTheVerdictFirst) {
  const Outcome accepted = run({"match", left, right});
  EXPECT_EQ(accepted.exit_code, 0);
  EXPECT_EQ(accepted.err, "");
  EXPECT_EQ(accepted.out.find("accepted: "), 0u) << accepted.out;
  for (const char* word : {"T_fixed_moving", "agreement", "overlap", "time"}) {
    EXPECT_NE(accepted.out.find(word), std::string::npos) << word;
  }
  EXPECT_EQ(accepted.out.find("hypothesis 1"), std::string::npos);
  EXPECT_EQ(run({"match", left, other}).out.find("refused: "), 0u);
}

TEST_F(Match, VerboseListsTheHypotheses) {
  const Outcome outcome = run({"match", left, right, "--verbose"});
  EXPECT_NE(outcome.out.find("hypothesis 1"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("read " + left), std::string::npos) << outcome.err;
}

TEST_F(Match, TheNumberOfThreadsChangesNothingButTheTime) {
  Json one = Json::parse(run({"match", left, right, "--json", "--threads", "1"}).out);
  Json two = Json::parse(run({"match", left, right, "--json", "--threads", "2"}).out);
  one.erase("seconds");
  two.erase("seconds");
  EXPECT_EQ(one, two);
}

TEST_F(Match, TheSameFileTwiceAndACopyOfItAreAcceptedAtTheIdentity) {
  std::filesystem::create_directory(directory.path() / "copy");
  for (const char* name : {"left.yaml", "left.pgm"}) {
    std::filesystem::copy_file(directory.path() / name, directory.path() / "copy" / name);
  }
  for (const std::string& moving : {left, directory.file("copy/left.yaml")}) {
    const Outcome outcome = run({"match", left, moving, "--json"});
    EXPECT_EQ(outcome.exit_code, 0);
    const Json json = Json::parse(outcome.out);
    expect_near(json.at("transform"), {}, kHalfACell, kFifthOfADegree);
    EXPECT_GT(json.at("acceptance_index"), 0.99);
  }
}

TEST_F(Match, AcceptDecidesTheVerdict) {
  EXPECT_EQ(run({"match", left, other, "--accept", "0"}).exit_code, 0);
  // One search alone: whether there is a second look depends on what is asked for.
  for (const std::string& moving : {right, other}) {
    const double probability =
        Json::parse(run({"match", left, moving, "--search", "quick", "--json"}).out).at("probability");
    ASSERT_GT(probability, 1e-6);
    ASSERT_LT(probability, 1.0 - 1e-9);
    const auto verdict_from = [&](double accept) {
      const Outcome outcome =
          run({"match", left, moving, "--search", "quick", "--json", "--accept", fmt::format("{}", accept)});
      EXPECT_EQ(outcome.exit_code, Json::parse(outcome.out).at("verdict") == "accepted" ? 0 : 3);
      return outcome.exit_code;
    };
    EXPECT_EQ(verdict_from(probability), 0);
    EXPECT_EQ(verdict_from(std::nextafter(probability, 2.0)), 3);
  }
}

TEST_F(Match, SearchesAreChosenByName) {
  for (const char* name : {"exhaustive", "quick", "thorough"})
    EXPECT_EQ(run({"match", left, right, "--search", name}).exit_code, 0) << name;
  const Outcome unknown = run({"match", left, right, "--search", "fast"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("thorough"), std::string::npos) << unknown.err;
}

TEST_F(Match, BareImagesTakeTheirResolutionFromTheOption) {
  const Outcome outcome = run(
      {"match", directory.file("left.pgm"), directory.file("right.pgm"), "--resolution", "0.1", "--json"});
  EXPECT_EQ(outcome.exit_code, 0);
  // Without a YAML the origin is zero; the turn is what it was.
  EXPECT_NEAR(normalize_angle(Json::parse(outcome.out).at("transform").at("theta").get<double>() -
                              T_left_right.theta),
              0.0, 2 * kFifthOfADegree);
}

TEST_F(Match, MapsWithNothingToGoByAreRefused) {
  const std::string blank = write_map(directory, "blank", make_grid(40, 30, 0.1));
  const std::string dot = write_map(directory, "dot", make_grid(1, 1, 0.1, {}, Cell::occupied));
  const std::string bare = write_map(directory, "bare", make_grid(40, 30, 0.1, {}, Cell::free));
  for (const std::string& map : {blank, dot, bare}) {
    for (const Outcome& outcome : {run({"match", left, map, "--json"}), run({"match", map, left, "--json"}),
                                   run({"match", map, map, "--json"})}) {
      EXPECT_EQ(outcome.exit_code, 3) << map << outcome.err;
      EXPECT_EQ(Json::parse(outcome.out).at("verdict"), "refused");
    }
  }
  const Outcome quiet = run({"match", left, blank, "--quiet"});
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(quiet.out.find("refused: "), 0u) << quiet.out;
  EXPECT_EQ(quiet.out.find("(probability"), std::string::npos) << quiet.out;
  const Outcome warned = run({"match", left, blank});
  EXPECT_EQ(warned.err, "gridmerge: warning: " + blank + ": the map has no known cell\n");
}

TEST_F(Match, AMapWhoseCellsSwallowTheOtherIsRefused) {
  OccupancyGrid coarse = make_grid(3000, 3000, 1000.0, {}, Cell::free);
  for (int i = 0; i < 3000; ++i) coarse.at(i, 7) = Cell::occupied;
  const std::string huge = write_map(directory, "huge", coarse);
  for (const Outcome& outcome :
       {run({"match", left, huge, "--json"}), run({"match", huge, left, "--json"})}) {
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_EQ(Json::parse(outcome.out).at("verdict"), "refused");
  }
}

TEST_F(Match, FindsTheScaleOfAPlan) {
  OccupancyGrid plan = draw_building(1);
  plan.resolution *= 1.3;
  plan.origin = {0.0, 0.0, 0.0};
  const std::string larger = write_map(directory, "plan", plan);
  const Outcome outcome = run({"match", larger, left, "--scale", "0.8:1.8", "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json.at("verdict"), "accepted");
  const double scale = json.at("scale");
  EXPECT_NEAR(scale, 1.3, 0.02);
  EXPECT_EQ(json.at("hypotheses").at(0).at("scale"), scale);
  // A corner of the left map's window, through p_fixed = scale * R * p_moving + t.
  const Point2 in_left = T_left_building * Point2{3.0, 4.0};
  const Json& T = json.at("transform");
  const Point2 in_plan =
      SE2{T.at("x"), T.at("y"), T.at("theta")} * Point2{scale * in_left.x, scale * in_left.y};
  EXPECT_NEAR(in_plan.x, 1.3 * 3.0, 0.4);
  EXPECT_NEAR(in_plan.y, 1.3 * 4.0, 0.4);

  const Outcome for_people = run({"match", larger, left, "--scale", "1.2:1.4", "--verbose"});
  EXPECT_EQ(for_people.exit_code, 0);
  EXPECT_NE(for_people.out.find("scale"), std::string::npos) << for_people.out;
}

TEST_F(Match, AnImageWhoseScaleIsSoughtNeedsNoResolution) {
  const std::string image = directory.file("left.pgm");
  const std::string warning = "gridmerge: warning: " + image + ": no --resolution says";
  const Outcome moving = run({"match", right, image, "--scale", "0.9:1.1"});
  EXPECT_EQ(moving.err.find(warning), 0u) << moving.err;
  EXPECT_NE(moving.out.find("enlarged first: its cells are 0."), std::string::npos) << moving.out;
  EXPECT_EQ(moving.exit_code, 0);
  const Outcome fixed = run({"match", image, right, "--scale", "0.9:1.1"});
  EXPECT_EQ(fixed.err.find(warning), 0u) << fixed.err;
  EXPECT_EQ(fixed.exit_code, 0);
  // Nothing else says how large the pixels are.
  expect_error(run({"match", image, directory.file("right.pgm"), "--scale", "0.9:1.1"}), "right.pgm",
               "needs a resolution");
  expect_error(run({"match", right, image}), image, "needs a resolution");
}

TEST_F(Match, SaysWhatItMakesOfADrawing) {
  const std::string drawing = write_map(directory, "drawing", on_white_paper(draw_building(1)));
  const Outcome outcome = run({"match", left, drawing, "--scale", "0.9:1.1"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_NE(outcome.out.find("\n  drawing        " + drawing + ": the "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find(left + ": the "), std::string::npos) << outcome.out;
  const Outcome unscaled =
      run({"match", other, write_map(directory, "drawing", on_white_paper(draw_building(1)))});
  EXPECT_EQ(unscaled.exit_code, 3);
  EXPECT_NE(unscaled.out.find("hint: " + drawing + " looks like a drawing of walls: --scale 0.5:2"),
            std::string::npos)
      << unscaled.out;
}

TEST_F(Match, RefusesStrangersAtEveryScale) {
  const Outcome outcome = run({"match", other, left, "--scale", "0.7:1.4"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
  EXPECT_EQ(outcome.out.find("refused: "), 0u) << outcome.out;
}

TEST_F(Match, HasNoScaleUnlessItIsAskedFor) {
  EXPECT_FALSE(Json::parse(run({"match", left, right, "--json"}).out).contains("scale"));
}

TEST_F(Match, ScalesThatMakeNoSenseAreUsageErrors) {
  for (const char* range : {"0:1", "-1:2", "2:0.5", "nan:1", "0.5:nan", "0.1:9", "0.5", "a:b", ":",
                            "1:", "1:2:3", "0.5:inf", "1e-9:1e-8", ""}) {
    const Outcome outcome = run({"match", left, right, "--scale", range});
    EXPECT_EQ(outcome.exit_code, 2) << range;
    EXPECT_EQ(outcome.out, "") << range;
    EXPECT_NE(outcome.err.find("--scale"), std::string::npos) << outcome.err;
  }
  const Outcome walk = run({"match", left, right, "--scale", "0.5:2", "--search", "random-walk"});
  EXPECT_EQ(walk.exit_code, 2);
  EXPECT_NE(walk.err.find("--scale"), std::string::npos) << walk.err;
}

TEST_F(Match, APlanWithoutWallsIsAnError) {
  OccupancyGrid floor = make_grid(40, 30, 0.1);
  for (Cell& cell : floor.cells) cell = Cell::free;
  const std::string empty = write_map(directory, "empty", floor);
  expect_error(run({"match", empty, left, "--scale", "0.5:2"}), empty, "no walls");
  expect_error(run({"match", left, empty, "--scale", "0.5:2", "--json"}), empty, "no walls");
}

TEST_F(Match, AnImageWithoutAResolutionIsToldOfScales) {
  const std::string image = directory.file("left.pgm");
  expect_error(run({"match", right, image}), image, "--scale 0.5:2 finds that of a plan");
  expect_error(run({"match", image, right}), image, "--scale 0.5:2 finds that of a plan");
  EXPECT_EQ(run({"match", right, directory.file("absent.pgm")}).err.find("--scale"), std::string::npos);
}

TEST_F(Match, APlanOfAnotherSizeIsToldWithTheRangeThatFits) {
  OccupancyGrid drawing = on_white_paper(draw_building(1));
  drawing.resolution *= 5.0;
  const std::string plan = write_map(directory, "large", drawing);
  const std::string whole = write_map(directory, "whole", draw_building(1));
  const Outcome outcome = run({"match", whole, plan, "--scale", "0.9:1.1"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
  const std::string hint = "hint: what " + plan + " draws has ", range = ", and --scale ";
  const std::size_t at = outcome.out.find(hint), from = outcome.out.find(range, at);
  ASSERT_NE(from, std::string::npos) << outcome.out;
  const std::string asked = outcome.out.substr(
      from + range.size(), outcome.out.find(' ', from + range.size()) - from - range.size());
  const Outcome found = run({"match", whole, plan, "--scale", asked});
  EXPECT_EQ(found.exit_code, 0) << asked << "\n" << found.out;
  EXPECT_NE(found.out.find("scale          0.2"), std::string::npos) << found.out;
  // The other way round it is the map that is enlarged.
  const Outcome turned = run({"match", plan, whole, "--scale", "0.9:1.1"});
  EXPECT_NE(turned.out.find("the scale is near 5"), std::string::npos) << turned.out;
  // Neither of two drawings or of two maps says how large the other is.
  EXPECT_EQ(run({"match", plan, plan, "--scale", "3:4"}).out.find(hint), std::string::npos);
  EXPECT_EQ(run({"match", whole, other, "--scale", "3:4"}).out.find("hint: what"), std::string::npos);
}

}  // namespace
}  // namespace gridmerge::test
