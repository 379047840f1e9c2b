// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/evaluate.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "gridmerge/evaluate/displacement.hpp"
#include "gridmerge/io/map_file.hpp"
#include "map_cache.hpp"
#include "support/building.hpp"

namespace gridmerge {
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
