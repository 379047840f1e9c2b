// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>
#include <set>
#include <string>

#include "gridmerge/match/match.hpp"
#include "support/building.hpp"

namespace gridmerge {
namespace {

MatchResult refused(Reason reason) {
  MatchResult result;
  result.reason = reason;
  return result;
}

TEST(Explain, SaysWhatAPairIs) {
  const OccupancyGrid building = test::draw_building(1);
  const MatchResult same = match(test::map_part(building, {0, 0, 12, 13}, {1.0, 2.0, 0.5}),
                                 test::map_part(building, {4, 0, 18, 13}, {}));
  ASSERT_EQ(same.verdict, Verdict::accepted);
  EXPECT_EQ(explain(same), "the maps show one place");
  const MatchResult nothing = match(make_grid(5, 5, 0.1), building);
  EXPECT_EQ(explain(nothing), "there is too little in the maps to compare");
}

TEST(Explain, HasWordsOfItsOwnForEachReason) {
  std::set<std::string> words;
  for (const Reason reason : {Reason::nothing_to_compare, Reason::ambiguous, Reason::contradiction,
                              Reason::too_little_overlap, Reason::several})
    words.insert(explain(refused(reason)));
  EXPECT_EQ(words.size(), 5u);
}

TEST(Explain, TellsRivalsFromMapsThatSlide) {
  MatchResult result = refused(Reason::ambiguous);
  PoseFigures held;
  held.held = held.held_most = 10.0;
  result.hypotheses = {{{}, 10.0, 0.5, held}, {{1.0, 0.0, 0.0}, 9.0, 0.45, held}};
  EXPECT_EQ(explain(result), "another way to lay the maps explains them too well to be ruled out");
  result.hypotheses[1].probability = 0.001;
  EXPECT_EQ(explain(result), "this way to lay the maps hardly stands out from all others");
  EXPECT_EQ(explain(result, 0.9999), "another way to lay the maps explains them too well to be ruled out");
  result.hypotheses[0].figures = {};
  result.hypotheses[0].figures.free_direction = std::numbers::pi / 6.0;
  EXPECT_EQ(explain(result), "the maps are free to slide along 30 degrees");
}

TEST(Explain, OfMoreThanIsUsuallyAskedForNamesNoFault) {
  const std::string words = "the maps show one place, but not as surely as is asked for";
  for (const Reason reason : {Reason::contradiction, Reason::several}) {
    MatchResult result = refused(reason);
    result.probability = 0.95;
    EXPECT_EQ(explain(result, 0.99998), words);
    result.probability = 0.9499;
    EXPECT_NE(explain(result, 0.99998), words);
    // Of a random walk that is its acceptance index, of which more is usual.
    result.probability = 0.965;
    EXPECT_NE(explain(result), words);
  }
  MatchResult result = refused(Reason::ambiguous);
  PoseFigures held;
  held.held = held.held_most = 10.0;
  result.probability = 0.99;
  result.hypotheses = {{{}, 10.0, 0.99, held}};
  EXPECT_EQ(explain(result, 0.999), words);
  result.hypotheses.push_back({{1.0, 0.0, 0.0}, 9.0, 0.0099, held});
  EXPECT_EQ(explain(result, 0.999), "another way to lay the maps explains them too well to be ruled out");
}

TEST(Explain, OfUnknownScaleSaysWhatWalls) {
  MatchResult result = refused(Reason::ambiguous);
  PoseFigures held;
  held.held = held.held_most = 10.0;
  held.stands_out = 6.0;
  result.hypotheses = {{{}, 10.0, 0.5, held}};
  EXPECT_EQ(explain(result),
            "the maps agree, but on so few walls that other places or scales may fit as well by chance");
  result.reason = Reason::contradiction;
  EXPECT_EQ(explain(result), "the maps disagree where both know the same places");
  result.scale = 1.25;
  EXPECT_EQ(explain(result), "too few walls meet a wall of the other map where both know the same places");
}

}  // namespace
}  // namespace gridmerge
