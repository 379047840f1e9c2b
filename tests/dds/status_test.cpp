// SPDX-License-Identifier: Apache-2.0
#include "dds/status.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gridmerge::internal {
namespace {

HeardRobot heard(const std::string& name, const std::string& frame) {
  HeardRobot robot;
  robot.name = name;
  robot.topic = "/" + name + "/map";
  robot.frame = frame;
  robot.maps = frame.empty() ? 0 : 1;
  robot.publishers = 1;
  return robot;
}

RobotStatus placed(const std::string& name, std::size_t component, const SE2& T_world_map) {
  RobotStatus status;
  status.name = name;
  status.state = RobotState::placed;
  status.why = "it lies together with others";
  status.component = component;
  status.T_world_map = T_world_map;
  status.probability = 0.99;
  return status;
}

TeamAnswer answer_of(std::vector<RobotStatus> robots, const std::vector<std::size_t>& numbers) {
  TeamAnswer answer;
  answer.number = 5;
  answer.seconds = 0.25;
  answer.settled = true;
  answer.robots = std::move(robots);
  answer.components.resize(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) answer.components[i].number = numbers[i];
  return answer;
}

std::string value_of(const Diagnosis& diagnosis, const std::string& key) {
  for (const auto& [name, value] : diagnosis.values)
    if (name == key) return value;
  return "none";
}

TEST(TeamTransforms, GoFromTheComponentsFramesToTheMaps) {
  const auto answer =
      answer_of({placed("a", 0, {}), placed("b", 0, {1, 2, 0.5}), placed("c", 1, {3, 4, 0})}, {1, 3});
  const TeamTransforms result =
      team_transforms(answer, {heard("a", "a/map"), heard("b", "b/map"), heard("c", "c/map")}, "world");
  EXPECT_EQ(result.transforms,
            (std::vector<NamedTransform>{
                {"world", "a/map", {}}, {"world", "b/map", {1, 2, 0.5}}, {"world_3", "c/map", {3, 4, 0}}}))
      << "the frame follows the number";
  EXPECT_TRUE(result.withheld.empty());
}

TEST(TeamTransforms, AreWithheldFromFramesThatSeveralHave) {
  RobotStatus waiting;
  waiting.name = "c";
  const auto answer = answer_of({placed("a", 0, {}), placed("b", 0, {1, 2, 0.5}), waiting}, {1});
  const TeamTransforms result =
      team_transforms(answer, {heard("a", "map"), heard("b", "b/map"), heard("c", "map")}, "world");
  EXPECT_EQ(result.transforms, (std::vector<NamedTransform>{{"world", "b/map", {1, 2, 0.5}}}));
  EXPECT_EQ(result.withheld,
            (std::map<std::string, std::string>{{"a", "the frame map is that of a and of c"}}));
}

TEST(TeamTransforms, AreWithheldFromTheWorldItself) {
  const auto answer = answer_of({placed("a", 0, {}), placed("b", 1, {})}, {1, 2});
  const TeamTransforms result =
      team_transforms(answer, {heard("a", "world_2"), heard("b", "world")}, "world");
  EXPECT_TRUE(result.transforms.empty());
  EXPECT_EQ(result.withheld.size(), 2u);
}

TEST(TeamTransforms, AreNoneOfRobotsThatAreNotPlaced) {
  RobotStatus left_out;
  left_out.name = "a";
  left_out.state = RobotState::left_out;
  EXPECT_TRUE(team_transforms(answer_of({left_out}, {}), {heard("a", "a/map")}, "world").transforms.empty());
}

TEST(Diagnoses, TellOfTheNodeAndOfEachRobot) {
  RobotStatus left_out;
  left_out.name = "b";
  left_out.state = RobotState::left_out;
  left_out.why = "too little overlap";
  HeardRobot refused = heard("c", "");
  refused.refused = 3;
  refused.last_refusal = "a size of 0 x 0 cells";
  const std::vector<HeardRobot> robots{heard("a", "a/map"), heard("b", "b/map"), refused};
  const auto answer = answer_of({placed("a", 0, {1, 2, 0.5}), left_out}, {1});
  const auto transforms = team_transforms(answer, robots, "world");
  const std::vector<Diagnosis> diagnoses = diagnose(answer, robots, transforms, {"gridmerge", 0, 0});
  ASSERT_EQ(diagnoses.size(), 4u);
  EXPECT_EQ(diagnoses[0].name, "gridmerge");
  EXPECT_EQ(diagnoses[0].level, Diagnosis::ok);
  EXPECT_EQ(diagnoses[0].message, "1 of 3 robots placed");
  EXPECT_EQ(value_of(diagnoses[0], "seconds of the last solve"), "0.25");
  EXPECT_EQ(value_of(diagnoses[0], "settled"), "yes");
  EXPECT_EQ(diagnoses[1].name, "gridmerge: a");
  EXPECT_EQ(diagnoses[1].hardware, "a");
  EXPECT_EQ(diagnoses[1].level, Diagnosis::ok);
  EXPECT_EQ(value_of(diagnoses[1], "theta"), "0.5");
  EXPECT_EQ(diagnoses[2].level, Diagnosis::warning);
  EXPECT_EQ(diagnoses[2].message, "left out: too little overlap");
  EXPECT_EQ(value_of(diagnoses[2], "x"), "none");
  EXPECT_EQ(diagnoses[3].message, "waiting: no map was heard yet");
  EXPECT_EQ(value_of(diagnoses[3], "refused"), "3");
  EXPECT_EQ(value_of(diagnoses[3], "last refusal"), "a size of 0 x 0 cells");
}

TEST(Diagnoses, WarnOfWhatWentWrong) {
  const TeamAnswer answer;
  EXPECT_EQ(diagnose(answer, {}, {}, {"gridmerge", 0, 0})[0].message, "no robot is known yet");
  EXPECT_EQ(diagnose(answer, {}, {}, {"gridmerge", 1, 0})[0].level, Diagnosis::warning);
  EXPECT_EQ(diagnose(answer, {}, {}, {"gridmerge", 0, 1})[0].level, Diagnosis::warning);
  TeamAnswer problem;
  problem.problem = "too large";
  EXPECT_EQ(value_of(diagnose(problem, {}, {}, {"gridmerge", 0, 0})[0], "problem"), "too large");
  TeamTransforms withheld;
  withheld.withheld["a"] = "two have its frame";
  const auto robots = std::vector<HeardRobot>{heard("a", "a")};
  const Diagnosis robot =
      diagnose(answer_of({placed("a", 0, {})}, {1}), robots, withheld, {"gridmerge", 0, 0})[1];
  EXPECT_EQ(robot.level, Diagnosis::warning);
  EXPECT_NE(robot.message.find("no transform: two have its frame"), std::string::npos);
}

TEST(Team, IsDescribedALineForEachRobot) {
  const auto answer = answer_of({placed("a", 0, {}), placed("b", 1, {1, -2, 0.5})}, {1, 2});
  EXPECT_EQ(describe_team(answer, {heard("a", "a"), heard("b", "b"), heard("c", "")}),
            "a: placed at x 0.000 m, y 0.000 m, theta 0.0000 rad (probability 0.990)\n"
            "b: placed at x 1.000 m, y -2.000 m, theta 0.5000 rad (probability 0.990) in merged map 2\n"
            "c: waiting: no map was heard yet\n");
}

}  // namespace
}  // namespace gridmerge::internal
