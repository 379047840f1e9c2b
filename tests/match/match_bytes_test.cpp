// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <limits>
#include <stdexcept>
#include <string>

#include "gridmerge/match/match.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "support/building.hpp"

namespace gridmerge {
namespace {

MatchResult drawn_match() {
  const auto count = [] { return std::int64_t{*rc::gen::inRange(0, 1 << 30)} << *rc::gen::inRange(0, 30); };
  const auto share = [] { return *rc::gen::inRange(0, 1001) / 1000.0; };
  const auto finite = [] { return *rc::gen::inRange(-1000000, 1000000) / 977.0; };
  MatchResult match;
  match.T_fixed_moving = {finite(), finite(), finite()};
  match.probability = share();
  match.acceptance_index = finite();
  match.agreement = count();
  match.disagreement = count();
  match.overlap = share();
  match.verdict = *rc::gen::element(Verdict::refused, Verdict::accepted);
  match.reason = static_cast<Reason>(*rc::gen::inRange(0, 8));
  match.seconds = *rc::gen::arbitrary<double>();
  match.scale = *rc::gen::inRange(1, 5000) / 977.0;
  match.hypotheses.resize(*rc::gen::inRange<std::size_t>(0, 5));
  for (Hypothesis& one : match.hypotheses) {
    one.T_fixed_moving = {finite(), finite(), -0.0};
    one.score = -finite();
    one.probability = share();
    one.scale = *rc::gen::inRange(1, 5000) / 977.0;
    for (const PoseFigure& figure : pose_figures()) one.figures.*figure.value = finite();
    one.figures.sigma = share();
  }
  return match;
}

RC_GTEST_PROP(MatchBytes, ComeBackBitForBit, ()) {
  const MatchResult match = drawn_match();
  const std::string bytes = to_bytes(match);
  const MatchResult back = match_from_bytes(bytes);
  RC_ASSERT(to_bytes(back) == bytes);
  RC_ASSERT(back.T_fixed_moving == match.T_fixed_moving);
  RC_ASSERT(back.scale == match.scale);
  RC_ASSERT(back.verdict == match.verdict);
  RC_ASSERT(back.reason == match.reason);
  RC_ASSERT(back.agreement == match.agreement);
  RC_ASSERT(back.disagreement == match.disagreement);
  RC_ASSERT(std::bit_cast<std::uint64_t>(back.overlap) == std::bit_cast<std::uint64_t>(match.overlap));
  RC_ASSERT(back.hypotheses.size() == match.hypotheses.size());
  for (std::size_t i = 0; i < back.hypotheses.size(); ++i) {
    RC_ASSERT(back.hypotheses[i].T_fixed_moving == match.hypotheses[i].T_fixed_moving);
    for (const PoseFigure& figure : pose_figures())
      RC_ASSERT(std::bit_cast<std::uint64_t>(back.hypotheses[i].figures.*figure.value) ==
                std::bit_cast<std::uint64_t>(match.hypotheses[i].figures.*figure.value));
  }
}

RC_GTEST_PROP(MatchBytes, CutShortOrLengthenedTheyAreNoMatch, (std::uint32_t at)) {
  const std::string bytes = to_bytes(drawn_match());
  RC_ASSERT_THROWS_AS(match_from_bytes(bytes.substr(0, at % bytes.size())), std::invalid_argument);
  RC_ASSERT_THROWS_AS(match_from_bytes(bytes + "x"), std::invalid_argument);
}

TEST(MatchBytes, RefuseWhatNoMatchHas) {
  MatchResult match;
  match.T_fixed_moving.x = std::numeric_limits<double>::infinity();
  EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument);
  match.T_fixed_moving.x = 0.0;
  match.probability = 1.5;
  EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument);
  match.probability = 0.5;
  match.reason = static_cast<Reason>(77);
  EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument);
  match.reason = Reason::over_budget;
  EXPECT_EQ(match_from_bytes(to_bytes(match)).reason, Reason::over_budget);
  match.verdict = static_cast<Verdict>(2);
  EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument);
  match.verdict = Verdict::refused;
  match.T_fixed_moving.y = 1e300;
  EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument);
  EXPECT_THROW(validate(match), std::invalid_argument);
  match.T_fixed_moving.y = 0.0;
  EXPECT_NO_THROW(validate(match));
  std::string bytes = to_bytes(match);
  bytes[bytes.size() - 1] = '\x7f';  // more hypotheses than there can be
  EXPECT_THROW(match_from_bytes(bytes), std::invalid_argument);
}

TEST(MatchBytes, RefuseFiguresThatNoMatchHas) {
  MatchResult match;
  match.hypotheses.resize(2);
  match.hypotheses[1].figures.sigma = 0.1;
  const std::string sound = to_bytes(match);
  EXPECT_NO_THROW(match_from_bytes(sound));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto expect_refused = [&](auto&& spoil) {
    MatchResult spoilt = match_from_bytes(sound);
    spoil(spoilt);
    EXPECT_THROW(match_from_bytes(to_bytes(spoilt)), std::invalid_argument);
  };
  for (const double value : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    for (const PoseFigure& figure : pose_figures())
      expect_refused([&](MatchResult& one) { one.hypotheses[1].figures.*figure.value = value; });
    expect_refused([&](MatchResult& one) { one.hypotheses[0].score = value; });
    expect_refused([&](MatchResult& one) { one.acceptance_index = value; });
    expect_refused([&](MatchResult& one) { one.overlap = value; });
  }
  expect_refused([](MatchResult& one) { one.hypotheses[0].figures.sigma = -0.1; });
  expect_refused([](MatchResult& one) { one.agreement = -1; });
  expect_refused([](MatchResult& one) { one.disagreement = -1; });
  expect_refused([](MatchResult& one) { one.overlap = -0.1; });
}

TEST(MatchBytes, RefuseScalesThatNoMatchHas) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double scale : {0.0, -1.0, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    MatchResult match;
    match.scale = scale;
    EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument) << scale;
    match.scale = 1.0;
    EXPECT_NO_THROW(match_from_bytes(to_bytes(match)));
    match.hypotheses.resize(2);
    match.hypotheses[1].scale = scale;
    EXPECT_THROW(match_from_bytes(to_bytes(match)), std::invalid_argument) << scale;
  }
}

TEST(MatchKey, TellsApartWhatMayDiffer) {
  const OccupancyGrid map = test::draw_building(1);
  const std::string content = content_id(map);
  EXPECT_EQ(content, content_id(OccupancyGrid(map)));
  EXPECT_EQ(content.size(), 64u);
  OccupancyGrid other = map;
  other.cells[17] = other.cells[17] == Cell::free ? Cell::occupied : Cell::free;
  EXPECT_NE(content_id(other), content);
  other = map;
  other.origin.x += 1e-12;
  EXPECT_NE(content_id(other), content);
  other = map;
  other.resolution *= 1.0000001;
  EXPECT_NE(content_id(other), content);
  other = map;
  std::swap(other.width, other.height);
  EXPECT_NE(content_id(other), content);
  other = map;
  other.probability.assign(map.cells.size(), 0.5F);
  EXPECT_NE(content_id(other), content);

  const MatchOptions options;
  const std::string key = match_key("a", "b", options);
  EXPECT_EQ(key, match_key("a", "b", options));
  EXPECT_NE(key, match_key("b", "a", options));
  EXPECT_NE(key, match_key("ab", "", options));
  MatchOptions changed;
  changed.threads = 7;  // changes no answer
  EXPECT_EQ(match_key("a", "b", changed), key);
  changed.max_hypotheses = 11;
  EXPECT_NE(match_key("a", "b", changed), key);
  changed = {};
  changed.accept_probability = 0.9;
  EXPECT_NE(match_key("a", "b", changed), key);
  changed = {};
  changed.search = SearchMethod::quick;
  EXPECT_NE(match_key("a", "b", changed), key);
  changed = {};
  changed.scales = ScaleRange{0.5, 2.0};
  EXPECT_NE(match_key("a", "b", changed), key);
  const std::string scaled = match_key("a", "b", changed);
  changed.scales->most = 1.9;
  EXPECT_NE(match_key("a", "b", changed), scaled);
  changed.search = SearchMethod::random_walk;
  EXPECT_THROW(match_key("a", "b", changed), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
