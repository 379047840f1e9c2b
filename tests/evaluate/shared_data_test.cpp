// SPDX-License-Identifier: Apache-2.0
// Real maps with ground truth, where they are at hand: a sample that is small enough for every run of the
// tests. The whole of it takes `gridmerge evaluate`.
#include <gtest/gtest.h>

#include <filesystem>

#include "evaluate/count.hpp"
#include "gridmerge/evaluate/evaluate.hpp"

namespace gridmerge {

using namespace internal;
namespace {

constexpr std::size_t kPairStep = 4;
constexpr std::size_t kNegativeStep = 8;

template <typename T>
std::vector<T> every(std::size_t step, const std::vector<T>& all) {
  std::vector<T> sample;
  for (std::size_t i = 0; i < all.size(); i += step) sample.push_back(all[i]);
  return sample;
}

class SharedData : public testing::TestWithParam<const char*> {};

TEST_P(SharedData, NoSampledMatchIsAcceptedWrongly) {
  const std::filesystem::path folder = std::filesystem::path("../shared/data") / GetParam();
  if (!std::filesystem::exists(folder / "pairs.tsv")) GTEST_SKIP() << folder << " is not here";
  Truth truth;
  truth.pairs = every(kPairStep, read_pairs(folder / "pairs.tsv"));
  truth.negatives = every(kNegativeStep, read_negatives(folder / "negatives.tsv"));
  const Evaluation evaluation = evaluate(truth);
  for (const MatchOutcome& match : evaluation.matches) {
    if (match.accepted()) {
      EXPECT_TRUE(match.correct()) << match.fixed << " " << match.moving;
    }
  }
  // The other half of the bargain: refusing everything is no way to pass.
  const PairCounts counts = count_pairs(evaluation.matches);
  EXPECT_GE(2 * counts.accepted_correct, counts.total);
}

INSTANTIATE_TEST_SUITE_P(Sample, SharedData, testing::Values("halmstad", "radish"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace gridmerge
