// SPDX-License-Identifier: Apache-2.0
#include "evaluate/count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gridmerge::internal {

namespace {

void add_pair(PairCounts& counts, const MatchOutcome& match) {
  ++counts.total;
  counts.best_correct += match.correct();
  if (!match.accepted()) {
    ++counts.refused;
  } else if (match.correct()) {
    ++counts.accepted_correct;
  } else {
    ++counts.accepted_wrong;
  }
}

// `sorted` ascending and not empty; `share` in [0, 1].
double quantile(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const std::size_t below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

// How many members of the component lie where the truth says, seen from the `reference`-th.
std::size_t count_correct(const TrueSet& set, const std::vector<KnownMoments>& moments,
                          const Component& component, std::size_t reference) {
  const Member& from = component.members[reference];
  const SE2 T_reference_component = inverse(from.T_component_map);
  const SE2 T_reference_set = inverse(set.members[from.map].T_set_map);
  return static_cast<std::size_t>(
      std::count_if(component.members.begin(), component.members.end(), [&](const Member& member) {
        const TrueMember& truth = set.members[member.map];
        return rms_displacement(moments[member.map], T_reference_component * member.T_component_map,
                                T_reference_set * truth.T_set_map) <= truth.tolerance;
      }));
}

}  // namespace

PairCounts count_pairs(const std::vector<MatchOutcome>& matches) {
  PairCounts counts;
  for (const MatchOutcome& match : matches) {
    if (!match.negative()) add_pair(counts, match);
  }
  return counts;
}

std::map<std::string, PairCounts> count_tiers(const std::vector<MatchOutcome>& matches) {
  std::map<std::string, PairCounts> tiers;
  for (const MatchOutcome& match : matches) {
    if (!match.negative() && !match.tier.empty()) add_pair(tiers[match.tier], match);
  }
  return tiers;
}

NegativeCounts count_negatives(const std::vector<MatchOutcome>& matches) {
  NegativeCounts counts;
  for (const MatchOutcome& match : matches) {
    counts.total += match.negative();
    counts.accepted += match.negative() && match.accepted();
  }
  return counts;
}

SetCounts count_sets(const std::vector<SetOutcome>& sets) {
  SetCounts counts;
  for (const SetOutcome& set : sets) {
    ++counts.total;
    counts.maps += set.maps;
    counts.maps_correct += set.correct;
    counts.maps_wrong += set.wrong;
    counts.maps_left_out += set.left_out;
    counts.complete += set.complete();
  }
  return counts;
}

TimeSummary summarize_times(const std::vector<MatchOutcome>& matches) {
  if (matches.empty()) return {};
  std::vector<double> seconds;
  seconds.reserve(matches.size());
  for (const MatchOutcome& match : matches) seconds.push_back(match.seconds);
  std::sort(seconds.begin(), seconds.end());
  return {quantile(seconds, 0.5), quantile(seconds, 0.9), seconds.back()};
}

std::vector<ThresholdCounts> sweep_thresholds(const std::vector<MatchOutcome>& matches,
                                              const std::vector<double>& thresholds) {
  std::vector<ThresholdCounts> sweep;
  for (const double threshold : thresholds) {
    ThresholdCounts counts;
    counts.threshold = threshold;
    for (const MatchOutcome& match : matches) {
      if (match.probability < threshold) continue;
      counts.negatives += match.negative();
      counts.correct += match.correct();
      counts.wrong += !match.negative() && !match.correct();
    }
    sweep.push_back(counts);
  }
  return sweep;
}

double roc_area(const std::vector<MatchOutcome>& matches) {
  std::vector<double> right, not_right;
  for (const MatchOutcome& match : matches)
    (match.correct() ? right : not_right).push_back(match.probability);
  if (right.empty() || not_right.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(not_right.begin(), not_right.end());
  double wins = 0.0;
  for (const double probability : right) {
    const auto [below, above] = std::equal_range(not_right.begin(), not_right.end(), probability);
    wins += 0.5 * static_cast<double>((below - not_right.begin()) + (above - not_right.begin()));
  }
  return wins / (static_cast<double>(right.size()) * static_cast<double>(not_right.size()));
}

SetOutcome judge_set(const TrueSet& set, const std::vector<KnownMoments>& moments,
                     const MergeResult& result) {
  SetOutcome outcome;
  outcome.name = set.name;
  outcome.maps = set.members.size();
  for (const Component& component : result.components) {
    if (component.members.size() < 2) continue;
    std::size_t correct = 0;
    for (std::size_t reference = 0; reference < component.members.size(); ++reference) {
      correct = std::max(correct, count_correct(set, moments, component, reference));
    }
    outcome.correct += correct;
    outcome.wrong += component.members.size() - correct;
  }
  outcome.left_out = outcome.maps - outcome.correct - outcome.wrong;
  return outcome;
}

}  // namespace gridmerge::internal
