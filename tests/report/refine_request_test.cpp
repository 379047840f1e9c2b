// SPDX-License-Identifier: Apache-2.0
#include "report/refine_request.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "io/support.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;
using test::message_of;

const auto kThreeMaps = [](const std::string&) { return std::size_t{3}; };

std::string complaint(const std::string& text) {
  return message_of<std::invalid_argument>([&] { parse_refine_request(text, kThreeMaps); });
}

TEST(RefineRequest, HoldsWhatWasAsked) {
  const RefineRequest request = parse_refine_request(
      R"({"merge": "m", "moving": 2, "transform": {"x": 1.25, "y": -3, "theta": 7}, "more": [],
          "fixed": [{"map": 0, "transform": {"x": 0, "y": 0, "theta": 0}},
                    {"map": 1, "transform": {"x": 1e7, "y": 4.5, "theta": -0.25}}]})",
      kThreeMaps);
  EXPECT_EQ(request.moving.map, 2u);
  EXPECT_EQ(request.moving.T_page_map, (SE2{1.25, -3.0, normalize_angle(7.0)}));
  ASSERT_EQ(request.fixed.size(), 2u);
  EXPECT_EQ(request.fixed[0].map, 0u);
  EXPECT_EQ(request.fixed[1].map, 1u);
  EXPECT_EQ(request.fixed[1].T_page_map, (SE2{1e7, 4.5, -0.25}));
}

// The same numbers stand for other maps in another merge.
TEST(RefineRequest, IsOfTheMergeThatItNamesBeforeAnythingElse) {
  std::string asked;
  EXPECT_THROW(parse_refine_request(R"({"merge": "0123abcd", "moving": 99})",
                                    [&](const std::string& merge) -> std::size_t {
                                      asked = merge;
                                      throw std::domain_error("another");
                                    }),
               std::domain_error);
  EXPECT_EQ(asked, "0123abcd");
}

TEST(RefineRequest, SaysWhatIsWrongAndWhere) {
  const std::string pose = R"("transform": {"x": 0, "y": 0, "theta": 0})";
  const auto with_fixed = [&](const std::string& fixed) {
    return "{\"merge\": \"m\", \"moving\": 0, " + pose + ", \"fixed\": " + fixed + "}";
  };
  EXPECT_TRUE(contains(complaint("nonsense"), "is no JSON"));
  EXPECT_EQ(complaint("[]"), "the text is no object");
  EXPECT_EQ(complaint("{}"), "merge is missing");
  EXPECT_EQ(complaint("{\"merge\": 1}"), "merge is no text");
  EXPECT_EQ(complaint("{\"merge\": \"m\"}"), "moving is missing");
  EXPECT_EQ(complaint("{\"merge\": \"m\", \"moving\": 3}"), "moving is no map: 3 of 3, counted from 0");
  EXPECT_EQ(complaint("{\"merge\": \"m\", \"moving\": 0}"), "transform is missing");
  EXPECT_TRUE(
      contains(complaint(R"({"merge": "m", "moving": 0, "transform": {"x": 1e308, "y": 0, "theta": 0}})"),
               "transform.x"));
  EXPECT_TRUE(
      contains(complaint(R"({"merge": "m", "moving": 0, "transform": {"x": 1e999, "y": 0, "theta": 0}})"),
               "is no JSON"));
  EXPECT_TRUE(contains(
      complaint(R"({"merge": "m", "moving": 0, "transform": {"x": 0, "y": 0, "theta": 101}})"), "theta"));
  EXPECT_EQ(complaint("{\"merge\": \"m\", \"moving\": 0, " + pose + "}"), "fixed is missing");
  EXPECT_EQ(complaint(with_fixed("{}")), "fixed is no list");
  EXPECT_EQ(complaint(with_fixed("[]")), "fixed holds no map");
  EXPECT_EQ(complaint(with_fixed("[{\"map\": 1}]")), "fixed[0].transform is missing");
  EXPECT_EQ(complaint(with_fixed("[{\"map\": 0, " + pose + "}]")), "fixed[0].map is the moving map");
  EXPECT_EQ(complaint(with_fixed("[{\"map\": 1, " + pose + "}, {\"map\": 1, " + pose + "}]")),
            "fixed[1].map is there twice");
}

TEST(RefineRequest, PosesMayBeAsFarAsMapsGetAndAsTurnedAsAPageCounts) {
  const auto request = [](const std::string& pose) {
    return "{\"merge\": \"m\", \"moving\": 0, \"transform\": " + pose +
           ", \"fixed\": [{\"map\": 2, \"transform\": {\"x\": 0, \"y\": 0, \"theta\": 0}}]}";
  };
  for (const double sign : {-1.0, 1.0}) {
    const auto pose = [sign](double x, double y, double theta) {
      return "{\"x\": " + std::to_string(sign * x) + ", \"y\": " + std::to_string(sign * y) +
             ", \"theta\": " + std::to_string(sign * theta) + "}";
    };
    const RefineRequest farthest = parse_refine_request(request(pose(1e7, 1e7, 100.0)), kThreeMaps);
    EXPECT_EQ(farthest.moving.T_page_map, (SE2{sign * 1e7, sign * 1e7, normalize_angle(sign * 100.0)}));
    EXPECT_EQ(complaint(request(pose(1e7 + 1, 0, 0))), "transform.x lies outside [-10000000, 10000000]");
    EXPECT_EQ(complaint(request(pose(0, 1e7 + 1, 0))), "transform.y lies outside [-10000000, 10000000]");
    EXPECT_EQ(complaint(request(pose(0, 0, 100.001))), "transform.theta lies outside [-100, 100]");
  }
  EXPECT_TRUE(contains(complaint("{\"merge\": \"m\", \"moving\": -1}"), "moving is no whole number"));
}

TEST(RefineRequest, TheAnswerIsTheDocumentedText) {
  RefinedPose pose;
  pose.T_fixed_moving = {1.25, -0.0, 0.5};
  pose.score = 512.5;
  pose.start_score = -3.0;
  pose.moved = 0.75;
  pose.probability = 0.875;
  pose.acceptance_index = 0.9375;
  pose.agreement = 15;
  pose.disagreement = 1;
  pose.overlap = 0.25;
  EXPECT_EQ(refined_pose_json(pose),
            R"({"transform":{"x":1.25,"y":0.0,"theta":0.5},"score":512.5,"probability":0.875,)"
            R"("acceptance_index":0.9375,"agreement":15,"disagreement":1,"overlap":0.25,"start_score":-3.0,)"
            R"("moved":0.75})"
            "\n");
}

}  // namespace
}  // namespace gridmerge
