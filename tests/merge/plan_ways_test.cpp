// SPDX-License-Identifier: Apache-2.0
#include "merge/plan_ways.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include "merge/on_plan.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;

/// A way to lie on the plan, as a voice may say it. Of the voices below each covers all of the plan.
Hypothesis said(const SE2& T_voice_plan, double scale, double probability) {
  Hypothesis one;
  one.T_fixed_moving = T_voice_plan;
  one.scale = scale;
  one.probability = probability;
  one.figures.sigma = 0.1;
  return one;
}

const SE2 kHere{};
const SE2 kElsewhere{6.0, -4.0, 1.5};

std::shared_ptr<const MapStore::Input> input_of(OccupancyGrid map) {
  return std::make_shared<const MapStore::Input>(std::make_shared<const OccupancyGrid>(std::move(map)));
}

/// A part of three voices, that of all maps first, which say this of the plan.
MergePart part_of(const std::vector<std::vector<Hypothesis>>& sayings) {
  MergePart part;
  for (std::size_t i = 0; i < sayings.size(); ++i) {
    MatchResult match;
    match.hypotheses = sayings[i];
    const std::optional<std::size_t> map = i == 0 ? std::nullopt : std::optional(i - 1);
    part.voices.push_back({map, {}, input_of(draw_building(1)), match});
    if (map) part.members.push_back({*map, {}});
  }
  return part;
}

double probability(const std::vector<std::vector<Hypothesis>>& sayings) {
  static const PreparedMap plan(draw_building(1));
  const std::optional<PlanWay> way = best_way(part_of(sayings), plan);
  return way ? way->probability : 0.0;
}

TEST(BestWay, MembersThatAgreeDoNoHarm) {
  const std::vector<Hypothesis> here{said(kHere, 1.0, 0.97)};
  EXPECT_NEAR(probability({here}), 0.97, 1e-3);
  EXPECT_NEAR(probability({here, here, here}), 0.97, 1e-3);
}

/// That members of one part agree may be chance, though each speaks of places of its own.
TEST(BestWay, IsNoSurerThanTheSurestOfItsVoices) {
  MergePart part = part_of({{}, {said(kHere, 1.0, 0.8)}, {said(kHere, 1.0, 0.7)}});
  part.voices.erase(part.voices.begin());
  for (std::size_t i = 0; i < 2; ++i) {
    const double left = 9.0 * static_cast<double>(i);
    part.voices[i].input = input_of(test::map_part(draw_building(1), {left, 0, left + 9.0, 13}, {}));
  }
  const std::optional<PlanWay> way = best_way(part, PreparedMap(draw_building(1)));
  ASSERT_TRUE(way);
  EXPECT_NEAR(way->probability, 0.8, 1e-3);
}

TEST(KnowScale, SharesOutWhatOtherScalesHad) {
  MergePart part =
      part_of({{said(kElsewhere, 1.5, 0.5), said(kHere, 1.01, 0.3), said(kElsewhere, 0.97, 0.1)}});
  know_scale(part, 1.0, {0.5, 2.0});
  const std::vector<Hypothesis>& left = part.voices[0].match.hypotheses;
  ASSERT_EQ(left.size(), 2u);
  // Of the 0.1 that nothing fits, 8 % of the range's logarithm are left.
  const double sum = 0.3 + 0.1 + 0.1 * 0.08 / std::log(4.0);
  EXPECT_NEAR(left[0].probability, 0.3 / sum, 1e-12);
  EXPECT_NEAR(left[1].probability, 0.1 / sum, 1e-12);
  // Who knew the scale before learns nothing.
  MergePart narrow = part_of({{said(kHere, 1.0, 0.6)}});
  know_scale(narrow, 1.0, {1.0, 1.0});
  EXPECT_NEAR(narrow.voices[0].match.hypotheses[0].probability, 0.6, 1e-12);
}

TEST(BestWay, MembersThatSayOtherwiseCountAgainstIt) {
  const std::vector<Hypothesis> here{said(kHere, 1.0, 0.97)};
  const std::vector<Hypothesis> elsewhere{said(kElsewhere, 1.0, 0.97)};
  EXPECT_LT(probability({here, elsewhere, elsewhere}), 0.9);
  EXPECT_LT(probability({here, {}, {}}), 0.9);  // of much in common they find nothing
  const std::vector<Hypothesis> larger{said(kHere, 1.3, 0.97)};
  EXPECT_LT(probability({here, larger, larger}), 0.9);
}

/// Bent maps see scales to both sides of that of all maps as one. The outer ones lie too far from it, and
/// from the surest one, to be the same; all lie near their middle.
TEST(BestWay, MembersThatSeeScalesOnBothSidesOfTheMiddleAgree) {
  const std::vector<std::vector<Hypothesis>> sayings{
      {said(kHere, 0.852, 0.95)}, {said(kHere, 0.887, 0.94)}, {said(kHere, 0.855, 0.9)}};
  EXPECT_NEAR(probability(sayings), 0.95, 1e-3);
  // The way keeps the scale of all maps as one.
  EXPECT_EQ(best_way(part_of(sayings), PreparedMap(draw_building(1)))->scale, 0.852);
  // Of a scale that nothing connects with theirs they stay apart.
  EXPECT_LT(probability({{said(kHere, 0.852, 0.95)}, {said(kHere, 0.94, 0.94)}, {said(kHere, 0.94, 0.9)}}),
            0.9);
}

/// A middle may lie near that of surer scales: then who began there goes on by its own scale. Nobody goes
/// unheard, and who says something else is a rival.
TEST(BestWay, NoScaleIsTooNearOthersToBeHeard) {
  const auto alone = [](double third) {
    return probability(
        {{said(kHere, 1.0, 0.4), said(kElsewhere, 1.038, 0.2), said(kElsewhere, third, 0.35)}});
  };
  const double unheard = probability({{said(kHere, 1.0, 0.4), said(kElsewhere, 1.038, 0.2)}});
  EXPECT_NEAR(alone(1.058), alone(1.3), 0.05);
  EXPECT_LT(alone(1.058), unheard - 0.03);
}

/// Voices of a scale nearby draw a middle away, by more than makes scales one: the surest voice keeps its
/// own.
TEST(BestWay, ASureVoiceIsNotDrawnAway) {
  std::vector<std::vector<Hypothesis>> sayings{{said(kHere, 1.0, 0.3)}, {said(kHere, 1.035, 0.29)}};
  for (int i = 0; i < 12; ++i) sayings.push_back({said(kElsewhere, 1.055, 0.2)});
  const std::optional<PlanWay> way = best_way(part_of(sayings), PreparedMap(draw_building(1)));
  ASSERT_TRUE(way);
  EXPECT_TRUE(way->scale == 1.0 || way->scale == 1.055) << way->scale;
  sayings[0][0].probability = 0.98;
  sayings.resize(8);
  EXPECT_EQ(best_way(part_of(sayings), PreparedMap(draw_building(1)))->scale, 1.0);
}

TEST(BestWay, SaysNothingWhereNobodyDoes) {
  EXPECT_EQ(probability({}), 0.0);
  EXPECT_EQ(probability({{}, {}, {}}), 0.0);
}

TEST(BestWay, HasThePoseAndScaleOfAllMapsAsOne) {
  const SE2 near{0.05, 0.02, 0.001};
  const PreparedMap plan(draw_building(1));
  const std::optional<PlanWay> way =
      best_way(part_of({{said(near, 1.01, 0.9)}, {said(kHere, 1.0, 0.99)}, {said(kHere, 1.0, 0.99)}}), plan);
  ASSERT_TRUE(way);
  EXPECT_EQ(way->scale, 1.01);
  EXPECT_EQ(way->T_plan_part, inverse(near));
  EXPECT_GT(way->sd, 0.0);
}

/// Two parts that would lie on each other, and whose maps have been found to have nothing in common.
TEST(BestWayBeside, PartsThatContradictEachOtherCountAgainstEachOther) {
  const PreparedMap plan(draw_building(1));
  const MergePart first = part_of({{said(kHere, 1.0, 0.97)}});
  MergePart hung = part_of({{}, {said(kHere, 1.0, 0.97)}});
  MergePart other = part_of({{}, {said(kHere, 1.0, 0.97)}});
  hung.voices.erase(hung.voices.begin());
  other.voices.erase(other.voices.begin());
  hung.voices[0].map = 0;
  hung.members = {{0, {}}};
  other.voices[0].map = 1;
  other.members = {{1, {}}};
  Join join;
  join.fixed = 0;
  join.moving = 1;
  const auto found = [&](const std::vector<Join>& joins) {
    return best_way_beside(other, {{&hung, kHere}}, 1.0, plan, joins)->probability;
  };
  const double unheard = found({});
  EXPECT_NEAR(unheard, 0.97, 1e-3);
  EXPECT_LT(found({join}), 0.7);
  join.match.hypotheses = {said(kHere, 1.0, 0.3)};
  EXPECT_GE(found({join}), unheard - 1e-3);
}

TEST(JoinOnPlan, TellsOpenWaysFromTheFirstMapOfTheComponent) {
  PlanInputs inputs;
  for (unsigned i = 1; i <= 5; ++i) inputs.push_back(input_of(draw_building(i)));
  MergeResult merged;
  for (std::size_t i = 0; i < 5; ++i) merged.left_out.push_back({i, Reason::ambiguous});
  merged.expected_false_joins = 0.01;
  const SE2 T_1_2{1.0, 2.0, 0.3}, T_0_2{-3.0, 1.0, 0.1}, T_2_3{4.0, 4.0, -2.0}, T_0_1{7.0, 0.0, 1.0},
      T_3_4{1.0, -1.0, 0.2}, T_1_3{};
  merged.open_ways = {{1, 2, T_1_2, 0.5}, {0, 2, T_0_2, 0.4}, {2, 3, T_2_3, 0.3},
                      {0, 1, T_0_1, 0.2}, {3, 4, T_3_4, 0.2}, {1, 3, T_1_3, 0.2}};
  const std::vector<MergePart> parts = parts_of(merged, inputs);
  const SE2 T_plan_1{2.0, 0.0, 0.5}, T_plan_3{-20.0, 5.0, 2.5};
  join_on_plan({{&parts[1], {T_plan_1, 1.0, 0.99, 0.2}}, {&parts[3], {T_plan_3, 1.0, 0.97, 0.2}}}, inputs,
               0.0, merged);
  ASSERT_EQ(merged.components.size(), 1u);
  EXPECT_EQ(merged.left_out.size(), 3u);
  EXPECT_NEAR(*merged.expected_false_joins, 0.01 + 0.01 + 0.03, 1e-12);
  ASSERT_EQ(merged.open_ways.size(), 5u);  // that between the two is gone
  const auto expect_near = [](const SE2& is, const SE2& wanted) {
    EXPECT_NEAR(is.x, wanted.x, 1e-9);
    EXPECT_NEAR(is.y, wanted.y, 1e-9);
    EXPECT_NEAR(normalize_angle(is.theta - wanted.theta), 0.0, 1e-9);
  };
  expect_near(merged.open_ways[0].T_fixed_moving, T_1_2);
  expect_near(merged.open_ways[1].T_fixed_moving, T_0_2);
  // Map 2 and map 3, which goes by map 1 now.
  EXPECT_EQ(merged.open_ways[2].fixed, 1u);
  EXPECT_EQ(merged.open_ways[2].moving, 2u);
  expect_near(merged.open_ways[2].T_fixed_moving, inverse(T_plan_1) * T_plan_3 * inverse(T_2_3));
  expect_near(merged.open_ways[3].T_fixed_moving, T_0_1);
  EXPECT_EQ(merged.open_ways[4].fixed, 1u);
  EXPECT_EQ(merged.open_ways[4].moving, 4u);
  expect_near(merged.open_ways[4].T_fixed_moving, inverse(T_plan_1) * T_plan_3 * T_3_4);
}

}  // namespace
}  // namespace gridmerge::internal
