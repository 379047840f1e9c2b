// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/evaluate.hpp"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "evaluate/map_cache.hpp"
#include "gridmerge/io/map_file.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::draw_building;
using test::map_part;
using test::write_map;

// Two robots in one building and one in another.
class Evaluate : public testing::Test {
 protected:
  void SetUp() override {
    const OccupancyGrid building = draw_building(1);
    write_map(directory_, "left", map_part(building, {0, 0, 13, 13}, T_left_building_));
    write_map(directory_, "right", map_part(building, {5, 0, 18, 13}, T_right_building_));
    write_map(directory_, "other", draw_building(2));
  }

  TruthMap map(const std::string& name) const { return {name, directory_.path() / (name + ".yaml")}; }

  test::TemporaryDirectory directory_;
  const SE2 T_left_building_{-3.0, 2.0, 0.4};
  const SE2 T_right_building_{1.0, -7.0, -1.1};
  const SE2 T_left_right_ = T_left_building_ * inverse(T_right_building_);
};

TEST_F(Evaluate, FindsPairsNegativesAndSetsAsTheyAre) {
  Truth truth;
  truth.pairs = {{map("left"), map("right"), T_left_right_, 0.2, "A"},
                 {map("left"), map("right"), T_left_right_ * SE2{0.5, 0.0, 0.0}, 0.2, "A"}};
  truth.negatives = {{map("left"), map("other")}};
  truth.sets = {{"s", {{map("left"), {}, 0.2}, {map("right"), T_left_right_, 0.2}, {map("other"), {}, 0.2}}}};
  std::vector<std::pair<std::size_t, std::size_t>> steps;
  EvaluateOptions options;
  options.progress = [&](std::size_t done, std::size_t total) { steps.emplace_back(done, total); };
  const Evaluation evaluation = evaluate(truth, options);

  ASSERT_EQ(evaluation.matches.size(), 3u);
  EXPECT_EQ(evaluation.matches[0].fixed, "left");
  EXPECT_EQ(evaluation.matches[0].moving, "right");
  EXPECT_TRUE(evaluation.matches[0].accepted());
  EXPECT_TRUE(evaluation.matches[0].correct());
  EXPECT_NEAR(evaluation.matches[1].error.value(), 0.5, 0.2);
  EXPECT_FALSE(evaluation.matches[1].correct());
  EXPECT_TRUE(evaluation.matches[2].negative());
  EXPECT_FALSE(evaluation.matches[2].accepted());
  EXPECT_GT(evaluation.matches[2].seconds, 0.0);
  ASSERT_EQ(evaluation.sets.size(), 1u);
  EXPECT_EQ(evaluation.sets[0].correct, 2u);
  EXPECT_EQ(evaluation.sets[0].left_out, 1u);
  EXPECT_EQ(steps, (std::vector<std::pair<std::size_t, std::size_t>>{{1, 4}, {2, 4}, {3, 4}, {4, 4}}));
}

TEST_F(Evaluate, PassesOnWhatTheMatcherSays) {
  const SE2 T_second = T_left_right_ * SE2{0.0, 2.0, 0.0};
  MatchResult result;
  result.verdict = Verdict::accepted;
  result.reason = Reason::several;
  result.T_fixed_moving = T_left_right_;
  result.probability = 0.73;
  result.seconds = 0.125;
  result.hypotheses = {{T_left_right_, 9.0, 0.73}, {T_second, 4.0, 0.2}};
  EvaluateOptions options;
  std::vector<std::size_t> widths;
  options.matcher = [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    widths.insert(widths.end(), {fixed.cells.size(), moving.cells.size()});
    return result;
  };
  Truth truth;
  truth.pairs = {{map("left"), map("right"), T_left_right_, 0.2, "B"}};
  truth.negatives = {{map("right"), map("other")}};
  const Evaluation evaluation = evaluate(truth, options);
  const auto cells = [&](const char* name) { return load_map(map(name).path).grid.cells.size(); };
  EXPECT_EQ(widths,
            (std::vector<std::size_t>{cells("left"), cells("right"), cells("right"), cells("other")}));

  for (const MatchOutcome& outcome : evaluation.matches) {
    EXPECT_EQ(outcome.verdict, Verdict::accepted);
    EXPECT_EQ(outcome.reason, Reason::several);
    EXPECT_EQ(outcome.probability, 0.73);
    EXPECT_EQ(outcome.seconds, 0.125);
    ASSERT_EQ(outcome.hypotheses.size(), 2u);
    EXPECT_EQ(outcome.hypotheses[1].hypothesis.T_fixed_moving, T_second);
  }
  const MatchOutcome &pair = evaluation.matches[0], &negative = evaluation.matches[1];
  EXPECT_EQ(pair.tier, "B");
  EXPECT_EQ(pair.tolerance, 0.2);
  EXPECT_NEAR(pair.error.value(), 0.0, 1e-9);
  EXPECT_NEAR(pair.hypotheses[0].error.value(), 0.0, 1e-9);
  EXPECT_NEAR(pair.hypotheses[1].error.value(), 2.0, 1e-9);
  EXPECT_TRUE(negative.tier.empty());
  EXPECT_FALSE(negative.tolerance || negative.error || negative.hypotheses[0].error);
  EXPECT_EQ(negative.fixed, "right");
  EXPECT_EQ(negative.moving, "other");

  result.hypotheses.clear();  // nothing to go by: there is no error of it
  EXPECT_FALSE(evaluate(truth, options).matches[0].error);
}

TEST_F(Evaluate, ItsProbabilityIsThatOfMatch) {
  Truth truth;
  truth.pairs = {{map("left"), map("right"), T_left_right_, 0.2, ""}};
  const MatchResult result = match(load_map(map("left").path).grid, load_map(map("right").path).grid);
  const MatchOutcome outcome = evaluate(truth).matches.at(0);
  EXPECT_GT(result.probability, 0.5);
  EXPECT_EQ(outcome.probability, result.probability);
  EXPECT_EQ(outcome.verdict, result.verdict);
  EXPECT_EQ(outcome.hypotheses.size(), result.hypotheses.size());
}

/// The message of what `work` throws.
template <typename Error, typename Work>
std::string message_of(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "it throws nothing";
  return "";
}

TEST_F(Evaluate, NamesTheMapsThatCannotBeComparedOrMerged) {
  EvaluateOptions options;
  options.matcher = [](const OccupancyGrid&, const OccupancyGrid&) -> MatchResult {
    throw std::invalid_argument("too odd");
  };
  options.merger = [](const std::vector<OccupancyGrid>&) -> MergeResult {
    throw std::invalid_argument("too many");
  };
  Truth pair, set;
  pair.pairs = {{map("left"), map("right"), {}, 0.2, ""}};
  EXPECT_EQ(message_of<std::runtime_error>([&] { evaluate(pair, options); }),
            map("left").path.string() + " and " + map("right").path.string() + ": too odd");
  set.sets = {{"floor", {{map("left"), {}, 0.2}, {map("right"), {}, 0.2}}}};
  EXPECT_EQ(message_of<std::runtime_error>([&] { evaluate(set, options); }), "set floor: too many");

  options.matcher = [](const OccupancyGrid&, const OccupancyGrid&) -> MatchResult { throw std::bad_alloc(); };
  options.merger = [](const std::vector<OccupancyGrid>&) -> MergeResult { throw std::bad_alloc(); };
  const std::string no_memory = ": out of memory: maps of larger cells take less";
  EXPECT_EQ(message_of<std::runtime_error>([&] { evaluate(pair, options); }),
            map("left").path.string() + " and " + map("right").path.string() + no_memory);
  EXPECT_EQ(message_of<std::runtime_error>([&] { evaluate(set, options); }), "set floor" + no_memory);
}

TEST_F(Evaluate, SaysWhichLineNamesAMapThatCannotBeRead) {
  TruthMap missing = map("missing");
  missing.named_at = "truth.tsv:7";
  Truth pair, set;
  pair.negatives = {{map("left"), missing}};
  set.sets = {{"s", {{missing, {}, 0.2}, {map("left"), {}, 0.2}}}};
  for (const Truth& truth : {pair, set}) {
    const std::string message = message_of<FileError>([&] { evaluate(truth); });
    EXPECT_NE(message.find("missing.yaml"), std::string::npos) << message;
    EXPECT_NE(message.find(" (truth.tsv:7 names it)"), std::string::npos) << message;
  }
}

TEST_F(Evaluate, NamesAMapThatCannotBeRead) {
  Truth truth;
  truth.negatives = {{map("left"), map("missing")}};
  try {
    evaluate(truth);
    FAIL() << "a missing map was accepted";
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("missing.yaml"), std::string::npos) << error.what();
  }
}

TEST_F(Evaluate, ItsInputsAreEveryMapAndItsImageOnce) {
  Truth truth;
  truth.pairs = {{map("left"), map("right"), T_left_right_, 0.2, "A"}};
  truth.negatives = {{map("left"), map("other")}};
  truth.sets = {{"s", {{map("left"), {}, 0.2}, {map("third"), {}, 0.2}}}};
  write_map(directory_, "third", make_grid(2, 2, 0.1, {}, Cell::free));
  std::vector<std::filesystem::path> expected;
  for (const char* name : {"left", "other", "right", "third"}) {
    expected.push_back(directory_.file(name + std::string(".pgm")));
    expected.push_back(directory_.file(name + std::string(".yaml")));
  }
  EXPECT_EQ(input_files(truth), expected);
  truth.negatives[0].moving = map("missing");
  EXPECT_THROW(input_files(truth), FileError);
}

TEST_F(Evaluate, WarnsOnceOfAMap) {
  // 205 is what unknown looks like, and this threshold calls it free.
  directory_.write("odd.pgm", std::string("P5\n3 1\n255\n\x00\xcd\xfe", 14));
  directory_.write("odd.yaml",
                   "image: odd.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                   "occupied_thresh: 0.65\nfree_thresh: 0.25\n");
  Truth truth;
  truth.negatives = {{map("odd"), map("odd")}, {map("odd"), map("left")}};
  EvaluateOptions options;
  options.cache_bytes = 0;
  std::vector<std::string> warnings;
  options.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  evaluate(truth, options);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].find(directory_.file("odd.yaml") + ": "), 0u) << warnings[0];
}

TEST_F(Evaluate, TheCacheKeepsWhatWasUsedLastAndItsBound) {
  MapCache unbounded({}, std::size_t{1} << 30, nullptr);
  const auto left = unbounded.get(map("left").path);
  const std::size_t left_bytes = unbounded.bytes();
  EXPECT_GE(left_bytes, left->grid.cells.size());
  EXPECT_EQ(unbounded.get(map("left").path), left);
  unbounded.get(map("right").path);
  const std::size_t both_bytes = unbounded.bytes();
  EXPECT_GT(both_bytes, left_bytes);

  MapCache two({}, both_bytes, nullptr);
  const auto first = two.get(map("left").path);
  const auto second = two.get(map("right").path);
  EXPECT_EQ(two.get(map("left").path), first);  // used last: "right" has to go for "small"
  write_map(directory_, "small", make_grid(4, 4, 0.1, {}, Cell::free));
  two.get(map("small").path);
  EXPECT_LE(two.bytes(), both_bytes);
  EXPECT_EQ(two.get(map("left").path), first);
  EXPECT_NE(two.get(map("right").path), second);
  EXPECT_FALSE(second->grid.cells.empty());

  MapCache none({}, 0, nullptr);
  EXPECT_FALSE(none.get(map("left").path)->grid.cells.empty());
  EXPECT_EQ(none.bytes(), 0u);
}

}  // namespace
}  // namespace gridmerge
