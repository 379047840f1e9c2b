// SPDX-License-Identifier: Apache-2.0
#include "merge/consistent_set.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace gridmerge {

using namespace internal;
namespace {

constexpr double kAccept = 0.8;

/// Maps at poses that are known to the test, and what pairs of them say of each other.
class World {
 public:
  explicit World(std::size_t maps, unsigned seed = 1) : random_(seed) {
    std::uniform_real_distribution<double> place(-40.0, 40.0), turn(-3.1, 3.1);
    for (std::size_t i = 0; i < maps; ++i) {
      T_world_map_.push_back({place(random_), place(random_), turn(random_)});
      problem.maps.push_back({{{2.0, -1.0}, 10.0, 30.0}});
    }
  }

  SE2 T(std::size_t fixed, std::size_t moving) const {
    return inverse(T_world_map_[fixed]) * T_world_map_[moving];
  }

  /// One more candidate of a pair; where `off` is added to the truth.
  void say(std::size_t fixed, std::size_t moving, double log_odds, const SE2& off = {}) {
    auto pair = std::find_if(problem.pairs.begin(), problem.pairs.end(), [&](const PairCandidates& other) {
      return other.fixed == fixed && other.moving == moving;
    });
    if (pair == problem.pairs.end()) pair = problem.pairs.insert(problem.pairs.end(), {fixed, moving, {}});
    pair->candidates.push_back({T(fixed, moving) * off, log_odds, 0.1});
  }

  void say_all(double log_odds) {
    for (std::size_t i = 0; i < problem.maps.size(); ++i) {
      for (std::size_t j = i + 1; j < problem.maps.size(); ++j) say(i, j, log_odds);
    }
  }

  void expect_true(const NodeGroup& group) const {
    for (const PlacedNode& node : group) {
      const SE2 expected = T(group.front().map, node.map);
      EXPECT_LT(displacement(problem.maps[node.map].extent, node.T_group_map, expected), 0.2)
          << "map " << node.map;
    }
  }

  PairCandidates& pair(std::size_t fixed, std::size_t moving) {
    return *std::find_if(problem.pairs.begin(), problem.pairs.end(), [&](const PairCandidates& other) {
      return other.fixed == fixed && other.moving == moving;
    });
  }

  JoinProblem problem;

 private:
  std::mt19937 random_;
  std::vector<SE2> T_world_map_;
};

/// Far from true, and not the same for two pairs unless it is meant to be.
const SE2 kWrong{12.0, 7.0, 2.0};
const SE2 kOtherWrong{-9.0, 15.0, -1.0};

std::set<std::pair<std::size_t, std::size_t>> used_pairs(const JoinProblem& problem,
                                                         const ConsistentSet& consistent_set) {
  std::set<std::pair<std::size_t, std::size_t>> used;
  for (const UsedCandidate& candidate : consistent_set.used)
    used.emplace(problem.pairs[candidate.pair].fixed, problem.pairs[candidate.pair].moving);
  return used;
}

TEST(ConsistentSet, NoMapsAreNoGroups) {
  EXPECT_TRUE(find_consistent_set({}, kAccept).groups.empty());
}

TEST(ConsistentSet, OneMapIsAGroupByItself) {
  const ConsistentSet consistent_set = find_consistent_set(World(1).problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  EXPECT_EQ(consistent_set.groups[0].size(), 1u);
  EXPECT_EQ(consistent_set.groups[0][0].probability, 1.0);
}

/// Of many maps, two that only their own pair speaks of: the surest of many matches is often only that.
TEST(ConsistentSet, APairAmongManyMapsIsLessSureThanByItself) {
  World two(2), many(3);
  two.say(0, 1, 6.0);
  many.say(0, 1, 6.0);
  const double of_two = find_consistent_set(two.problem, kAccept).groups[0][1].probability;
  const double of_many = find_consistent_set(many.problem, kAccept).groups[0][1].probability;
  EXPECT_GT(of_two, 0.997);
  EXPECT_LT(of_many, 0.99);
  EXPECT_GT(of_many, 0.97);
}

TEST(ConsistentSet, TwoMapsAreJoinedAsSurelyAsTheirPairIs) {
  for (const double probability : {0.5, 0.79, 0.81, 0.99}) {
    World world(2);
    world.say(0, 1, std::log(probability / (1.0 - probability)));
    const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
    ASSERT_EQ(consistent_set.groups.size(), probability < kAccept ? 2u : 1u) << probability;
    if (probability < kAccept) continue;
    EXPECT_NEAR(consistent_set.groups[0][1].probability, probability, 1e-6);
    world.expect_true(consistent_set.groups[0]);
  }
}

TEST(ConsistentSet, TheFirstMapIsDoubtedAsTheOthersAre) {
  World two(2);
  two.say(0, 1, 2.0);
  const ConsistentSet pair = find_consistent_set(two.problem, kAccept);
  ASSERT_EQ(pair.groups.size(), 1u);
  EXPECT_NEAR(pair.groups[0][0].probability, pair.groups[0][1].probability, 1e-12);
  EXPECT_LT(pair.groups[0][0].probability, 0.9);

  // Of three, the first hangs on one pair alone.
  World three(3);
  three.say(0, 1, 4.0);
  three.say(1, 2, 9.0);
  const ConsistentSet chain = find_consistent_set(three.problem, kAccept);
  ASSERT_EQ(chain.groups.size(), 1u);
  EXPECT_LT(chain.groups[0][0].probability, chain.groups[0][2].probability);
}

TEST(ConsistentSet, OfTwoPosesThatAreAsLikelyNoneIsBelieved) {
  World world(2);
  world.say(0, 1, 4.0);
  world.say(0, 1, 4.0, kWrong);
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 2u);
}

TEST(FindOpenJoins, AreTheRivalsBetweenWhichNothingDecides) {
  World world(2);
  world.say(0, 1, 4.0);
  world.say(0, 1, 4.0, kWrong);
  world.say(0, 1, -3.0, {500.0, 0.0, 1.0});  // 1 in 20
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  const std::vector<OpenJoin> open = find_open_joins(world.problem, consistent_set, 0.1);
  ASSERT_EQ(open.size(), 2u);
  for (const OpenJoin& join : open) {
    EXPECT_EQ(join.a, 0u);
    EXPECT_EQ(join.b, 1u);
    EXPECT_GT(join.probability, 0.4);
    EXPECT_LT(join.probability, 0.5);
  }
  EXPECT_NE(open[0].T_a_b, open[1].T_a_b);
  EXPECT_EQ(find_open_joins(world.problem, consistent_set, 0.01).size(), 3u);
  EXPECT_TRUE(find_open_joins(world.problem, consistent_set, 0.6).empty());
  EXPECT_THROW(find_open_joins(world.problem, consistent_set, -0.1), std::invalid_argument);
}

TEST(FindOpenJoins, OfAGroupHearAllItsMaps) {
  // Two pairs propose each of two ways for the fourth map to lie beside the group of the first three.
  World world(4);
  world.say(0, 1, 5.0);
  world.say(1, 2, 5.0);
  world.say(0, 2, 5.0);
  for (const std::size_t map : {std::size_t{0}, std::size_t{1}}) {
    world.say(map, 3, 0.0);
    world.say(map, 3, 0.0, kWrong);
  }
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 2u);
  const std::vector<OpenJoin> open = find_open_joins(world.problem, consistent_set, 0.1);
  ASSERT_GE(open.size(), 2u);
  double sum = 0.0;
  for (const OpenJoin& join : open) {
    EXPECT_EQ(join.b, 1u);
    sum += join.probability;
  }
  EXPECT_NEAR(open[0].probability, open[1].probability, 0.05);
  EXPECT_GT(open[0].probability, 0.3);
  EXPECT_LE(sum, 1.0);
}

TEST(FindOpenJoins, OfOneGroupAreNone) {
  World world(3);
  world.say(0, 1, 5.0);
  world.say(1, 2, 5.0);
  world.say(0, 2, 5.0);
  EXPECT_TRUE(find_open_joins(world.problem, find_consistent_set(world.problem, kAccept), 0.0).empty());
}

TEST(ConsistentSet, AThirdMapDecidesBetweenPosesThatAreAsLikely) {
  World world(3);
  world.say(0, 1, 2.0, kWrong);
  world.say(0, 1, 2.0);
  world.say(0, 2, 4.0);
  world.say(1, 2, 4.0);
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  world.expect_true(consistent_set.groups[0]);
  EXPECT_EQ(consistent_set.used.size(), 3u);
  EXPECT_EQ(consistent_set.used[0].candidate, 1u);
}

TEST(ConsistentSet, AWeakPairThatAgreesWithACycleIsUsed) {
  World world(3);
  world.say(0, 1, 4.0);
  world.say(1, 2, 4.0);
  world.say(0, 2, -2.0);
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  EXPECT_TRUE(used_pairs(world.problem, consistent_set).contains({0, 2}));
}

TEST(ConsistentSet, TwoWeakPairsThatAgreeAreEnoughTogether) {
  World world(3);
  world.say(0, 1, 4.0);
  world.say(0, 2, 1.0);
  world.say(1, 2, 1.0);
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 1u);
  world.pair(1, 2).candidates[0].T_fixed_moving = world.T(1, 2) * kWrong;  // they agree no more
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 2u);
}

/// Twenty maps of places that look alike: all pairs agree, and none knows whether it is right. So they do not
/// make each other right. Once they were all joined, with a probability of 1.
TEST(ConsistentSet, MapsOfPlacesThatLookAlikeAreNoPlaceHoweverManyTheyAre) {
  World world(20);
  for (std::size_t a = 0; a < 20; ++a) {
    for (std::size_t b = a + 1; b < 20; ++b) world.say(a, b, a + 1 == b && a % 2 == 0 ? 4.0 : -0.5);
  }
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  EXPECT_EQ(consistent_set.groups.size(), 10u);
  for (const NodeGroup& group : consistent_set.groups) EXPECT_EQ(group.size(), 2u);
}

/// Where each pair is sure by itself, many are surer.
TEST(ConsistentSet, MapsWhosePairsAreAllSureAreOnePlace) {
  World world(6);
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) world.say(a, b, 3.0);
  }
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  for (const PlacedNode& node : consistent_set.groups[0]) EXPECT_GT(node.probability, 0.999);
}

/// What was known beforehand is of this place: nothing that looks alike has it.
TEST(ConsistentSet, AKnownPoseIsOfNoOtherPlace) {
  World world(3);
  world.say(0, 1, 4.0);
  world.say(0, 2, 1.6);
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 2u);
  world.pair(0, 2).candidates[0].is_known = true;
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 1u);
}

/// One map's given pose puts it right or wrong for all others: they do not bear it out.
TEST(ConsistentSet, AWrongGivenPoseDoesNotGainByEveryPairThatItIsGivenFor) {
  World world(4);
  for (const auto& [a, b] : {std::pair(0u, 1u), std::pair(0u, 2u), std::pair(1u, 2u)}) world.say(a, b, 5.0);
  for (const std::size_t other : {0u, 1u, 2u}) {
    const SE2 T_other_wrong = world.T(other, 0) * kWrong * world.T(0, 3);
    world.say(other, 3, 6.0, inverse(world.T(other, 3)) * T_other_wrong);
    world.pair(other, 3).candidates[0].is_known = true;
  }
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 1u) << "nothing says that it is wrong";
  world.say(0, 3, 5.8);
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 2u) << "that may be, too";
  world.say(1, 3, 5.8);
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  world.expect_true(consistent_set.groups[0]);
}

/// The pair that sees most of a given pose tells what it is worth.
TEST(ConsistentSet, AGivenPoseIsWorthWhatThePairSaysThatDoubtsItMost) {
  World world(3);
  world.say(0, 1, 5.0);
  world.say(0, 2, 6.0);
  world.say(1, 2, 1.0);
  for (const std::size_t other : {0u, 1u}) world.pair(other, 2).candidates[0].is_known = true;
  EXPECT_EQ(find_consistent_set(world.problem, kAccept).groups.size(), 2u);
}

TEST(ConsistentSet, AWrongJoinStrongerThanEveryRightOneIsNotUsed) {
  for (std::size_t wrong = 1; wrong < 5; ++wrong) {
    World world(5);
    world.say_all(3.0);
    world.pair(0, wrong).candidates = {{world.T(0, wrong) * kWrong, 6.0, 0.1}};
    const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
    ASSERT_EQ(consistent_set.groups.size(), 1u) << wrong;
    world.expect_true(consistent_set.groups[0]);
    EXPECT_EQ(consistent_set.used.size(), 9u);
    EXPECT_FALSE(used_pairs(world.problem, consistent_set).contains({0, wrong}));
  }
}

TEST(ConsistentSet, TwoWrongJoinsThatAgreeWithEachOtherAreNotUsed) {
  World world(6);
  world.say_all(3.0);
  // Both say that map 5 lies where it does not, in the same place.
  world.pair(0, 5).candidates = {{world.T(0, 5) * kWrong, 4.0, 0.1}};
  world.pair(1, 5).candidates = {{world.T(1, 5) * kWrong, 4.0, 0.1}};
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  world.expect_true(consistent_set.groups[0]);
  EXPECT_FALSE(used_pairs(world.problem, consistent_set).contains({0, 5}));
  EXPECT_FALSE(used_pairs(world.problem, consistent_set).contains({1, 5}));
}

TEST(ConsistentSet, WhatIsContradictedAsMuchAsItIsSaidIsLeftOut) {
  World world(5);
  world.say_all(3.0);
  for (const std::size_t map : {0u, 1u})
    world.pair(map, 4).candidates = {{world.T(map, 4) * kWrong, 3.0, 0.1}};
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 2u);
  EXPECT_EQ(consistent_set.groups[0].size(), 4u);
  EXPECT_EQ(consistent_set.groups[1][0].map, 4u);
}

TEST(ConsistentSet, MapsOfTwoPlacesAreTwoGroups) {
  World world(6);
  for (const std::size_t side : {0u, 1u}) {
    world.say(side, side + 2, 4.0);
    world.say(side, side + 4, 4.0);
    world.say(side + 2, side + 4, 4.0);
  }
  world.say(0, 1, -1.0, kWrong);
  world.say(2, 3, -1.0, kOtherWrong);
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 2u);
  for (const NodeGroup& group : consistent_set.groups) {
    EXPECT_EQ(group.size(), 3u);
    world.expect_true(group);
  }
}

TEST(ConsistentSet, PosesInACycleShareItsError) {
  World world(3);
  world.say(0, 1, 4.0);
  world.say(1, 2, 4.0);
  world.say(0, 2, 4.0, {0.9, 0.0, 0.0});
  const ConsistentSet consistent_set = find_consistent_set(world.problem, kAccept);
  ASSERT_EQ(consistent_set.groups.size(), 1u);
  EXPECT_NEAR(
      displacement(world.problem.maps[2].extent, consistent_set.groups[0][2].T_group_map, world.T(0, 2)), 0.6,
      0.05);
}

// Whatever pairs say, the order of the maps must not matter.
RC_GTEST_PROP(ConsistentSet, OrderOfTheMapsPlaysNoPart, ()) {
  const auto size = static_cast<std::size_t>(*rc::gen::inRange(2, 8));
  World world(size, *rc::gen::arbitrary<unsigned>());
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::uniform_real_distribution<double> log_odds(-4.0, 5.0), off(-20.0, 20.0);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = i + 1; j < size; ++j) {
      if (random() % 3 != 0) world.say(i, j, log_odds(random));
      if (random() % 3 == 0) world.say(i, j, log_odds(random), {off(random), off(random), 0.1 * off(random)});
    }
  }
  std::vector<std::size_t> place(size);  // of each map, in the other order
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  JoinProblem other;
  other.maps = world.problem.maps;  // all are alike
  for (const PairCandidates& pair : world.problem.pairs) {
    PairCandidates moved{place[pair.fixed], place[pair.moving], pair.candidates};
    if (moved.fixed > moved.moving) {
      std::swap(moved.fixed, moved.moving);
      for (CandidateJoin& candidate : moved.candidates)
        candidate.T_fixed_moving = inverse(candidate.T_fixed_moving);
    }
    other.pairs.push_back(std::move(moved));
  }
  std::shuffle(other.pairs.begin(), other.pairs.end(), random);

  const ConsistentSet one = find_consistent_set(world.problem, kAccept),
                      two = find_consistent_set(other, kAccept);
  RC_ASSERT(one.groups.size() == two.groups.size());
  RC_ASSERT(one.used.size() == two.used.size());
  for (const NodeGroup& group : one.groups) {
    const auto same = std::find_if(two.groups.begin(), two.groups.end(), [&](const NodeGroup& candidate) {
      return std::any_of(candidate.begin(), candidate.end(),
                         [&](const PlacedNode& node) { return node.map == place[group[0].map]; });
    });
    RC_ASSERT(same != two.groups.end());
    RC_ASSERT(same->size() == group.size());
    const auto pose_in = [&](std::size_t map) {
      return std::find_if(same->begin(), same->end(),
                          [&](const PlacedNode& node) { return node.map == place[map]; })
          ->T_group_map;
    };
    for (const PlacedNode& node : group) {
      const SE2 T = inverse(pose_in(group[0].map)) * pose_in(node.map);
      RC_ASSERT(displacement(world.problem.maps[node.map].extent, T, node.T_group_map) < 1e-3);
    }
  }
}

/// No pair is as sure as a small budget asks for, but all of them together are.
TEST(ConsistentSetWithin, KeepsWhatManyPairsAreSureOfTogether) {
  World world(6);
  world.say_all(4.5);
  const ConsistentSet consistent_set = find_consistent_set_within(world.problem, kAccept, 0.01);
  ASSERT_EQ(consistent_set.groups.size(), 1U);
  world.expect_true(consistent_set.groups[0]);
}

}  // namespace
}  // namespace gridmerge
