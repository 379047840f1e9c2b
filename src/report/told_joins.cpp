// SPDX-License-Identifier: Apache-2.0
#include "report/told_joins.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "merge/candidates.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kMinProbability = 0.01;  // of what may well be true

std::size_t comparisons_of(const MergeResult& result) {
  return std::accumulate(result.refused_more.begin(), result.refused_more.end(), result.joins.size(),
                         [](std::size_t sum, const RefusedCount& refused) { return sum + refused.count; });
}

std::vector<std::size_t> most_probable(std::vector<std::size_t> rows, const std::vector<Join>& joins) {
  if (rows.size() > kMostRows) {
    std::nth_element(rows.begin(), rows.begin() + kMostRows, rows.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(-joins[a].probability, a) < std::pair(-joins[b].probability, b);
    });
    rows.resize(kMostRows);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace

ToldJoins tell_joins(const MergeResult& result) {
  ToldJoins told;
  const std::vector<Join>& joins = result.joins;
  told.in_full = comparisons_of(result) <= kMostToldInFull;
  if (told.in_full) {
    told.objects.resize(joins.size());
    std::iota(told.objects.begin(), told.objects.end(), std::size_t{0});
  }
  std::map<Reason, std::size_t> counts;
  for (const RefusedCount& more : result.refused_more) counts[more.reason] += more.count;
  if (!told.in_full) {
    std::set<std::pair<std::size_t, std::size_t>> open;
    for (const OpenWay& way : result.open_ways) open.emplace(way.fixed, way.moving);
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < joins.size(); ++i) {
      const Join& join = joins[i];
      if (join.outcome != JoinOutcome::refused || open.count({join.fixed, join.moving}) > 0) {
        told.objects.push_back(i);
        continue;
      }
      ++counts[join.reason()];
      if (join.probability >= kMinProbability) rows.push_back(i);
    }
    told.rows = most_probable(std::move(rows), joins);
  }
  for (const auto& [reason, count] : counts) {
    if (count > 0) told.counts.push_back({reason, count});
  }
  return told;
}

std::vector<Hypothesis> told_hypotheses(const Join& join, bool in_full) {
  constexpr std::size_t kMax = 3;
  const std::vector<Hypothesis>& all = join.match.hypotheses;
  if (in_full && join.outcome != JoinOutcome::refused) return all;
  std::vector<Hypothesis> kept;
  for (const Hypothesis& hypothesis : all) {
    const bool is_likely = kept.size() < kMax && hypothesis.probability >= kMinProbability;
    const bool is_used = join.used() && hypothesis.T_fixed_moving == join.T_fixed_moving;
    if (kept.empty() || is_likely || is_used) kept.push_back(hypothesis);
  }
  return kept;
}

std::optional<double> deviation_of(const Join& join) {
  for (const Hypothesis& hypothesis : join.match.hypotheses) {
    if (hypothesis.T_fixed_moving == join.T_fixed_moving && hypothesis.figures.sigma > 0.0)
      return kDeviationsOfWalls * hypothesis.figures.sigma;
  }
  return std::nullopt;
}

void set_deviation(Join& join, double sd) {
  for (Hypothesis& hypothesis : join.match.hypotheses) {
    if (hypothesis.T_fixed_moving == join.T_fixed_moving) hypothesis.figures.sigma = sd / kDeviationsOfWalls;
  }
}

}  // namespace gridmerge::internal
