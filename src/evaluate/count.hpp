// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "evaluate/known_moments.hpp"
#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::internal {

struct PairCounts {
  std::size_t total = 0;
  std::size_t accepted_correct = 0;
  std::size_t accepted_wrong = 0;
  std::size_t refused = 0;
  std::size_t best_correct = 0;  ///< the best hypothesis is correct, accepted or not

  friend bool operator==(const PairCounts&, const PairCounts&) = default;
};

struct NegativeCounts {
  std::size_t total = 0;
  std::size_t accepted = 0;
};

struct SetCounts {
  std::size_t total = 0;
  std::size_t maps = 0;
  std::size_t maps_correct = 0;
  std::size_t maps_wrong = 0;
  std::size_t maps_left_out = 0;
  std::size_t complete = 0;  ///< sets with every map correct
};

/// Wall times of the matches [s]; zeros when there was none.
struct TimeSummary {
  double median = 0.0;
  double p90 = 0.0;
  double max = 0.0;
};

/// What would be accepted from a probability of `threshold` on.
struct ThresholdCounts {
  double threshold = 0.0;
  std::size_t correct = 0;    ///< pairs whose best hypothesis is correct
  std::size_t wrong = 0;      ///< pairs whose best hypothesis is not
  std::size_t negatives = 0;  ///< pairs with no common place
};

/// Negatives among the matches are passed over. O(matches).
PairCounts count_pairs(const std::vector<MatchOutcome>& matches);

/// count_pairs() of each tier by itself; pairs without one are passed over. O(matches log tiers).
std::map<std::string, PairCounts> count_tiers(const std::vector<MatchOutcome>& matches);

/// True pairs among the matches are passed over. O(matches).
NegativeCounts count_negatives(const std::vector<MatchOutcome>& matches);

SetCounts count_sets(const std::vector<SetOutcome>& sets);

/// Over pairs and negatives alike; quantiles between two times are interpolated. O(matches log matches).
TimeSummary summarize_times(const std::vector<MatchOutcome>& matches);

/// The verdict's trade: what each of `thresholds` would accept. O(matches * thresholds).
std::vector<ThresholdCounts> sweep_thresholds(const std::vector<MatchOutcome>& matches,
                                              const std::vector<double>& thresholds);

/// Area under the ROC of `probability`: how often a match with a correct best hypothesis has a larger one
/// than a match with a wrong one or none to find (a tie counts half). 1 = it tells them apart, 0.5 = it says
/// nothing; NaN unless there are matches of both kinds. O(matches log matches).
double roc_area(const std::vector<MatchOutcome>& matches);

/// Judges a merge of the maps of `set`, `moments[i]` belonging to its i-th map. Within a component, poses are
/// compared with the truth relative to one member, the one that makes most of the component's maps correct
/// (it counts as correct itself); a component of one map is left out. O(sum of squared component sizes).
SetOutcome judge_set(const TrueSet& set, const std::vector<KnownMoments>& moments, const MergeResult& result);

}  // namespace gridmerge::internal
