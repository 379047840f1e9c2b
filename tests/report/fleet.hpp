// SPDX-License-Identifier: Apache-2.0
// Results of merges of many maps, made without a search.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::test {

inline std::vector<std::string> fleet_names(std::size_t maps) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < maps; ++i) names.push_back("site/robot_" + std::to_string(i + 1) + ".yaml");
  return names;
}

/// What merge() may return of so many maps that lie in a square of places 10 m apart, each joined to the four
/// around it, but for the last two: they are left out, and there is an open way for the last. One in `every`
/// other pairs was compared, and refused. There are no fused maps.
inline MergeResult fleet(std::size_t maps, std::size_t every) {
  MergeResult result;
  std::mt19937 random(7);
  const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
  const std::size_t placed = maps - 2;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(placed))));
  Component component;
  for (std::size_t i = 0; i < placed; ++i) {
    const SE2 T{10.0 * static_cast<double>(i % side), 10.0 * static_cast<double>(i / side),
                i == 0 ? 0.0 : 3.0 * share()};
    component.members.push_back({i, T, 1.0 - 0.01 * share(), PoseDeviation{0.1 * share(), 0.01 * share()}});
  }
  const auto place = [&](std::size_t i) { return component.members[i].T_component_map; };
  const std::vector<Reason> reasons{Reason::ambiguous, Reason::too_little_overlap, Reason::contradiction,
                                    Reason::several};
  for (std::size_t i = 0; i < maps; ++i) {
    for (std::size_t j = i + 1; j < maps; ++j) {
      const bool is_near = j < placed && ((j == i + 1 && j % side != 0) || j == i + side);
      const bool is_open = i == 0 && j == maps - 1;
      if (!is_near && !is_open && (i * maps + j) % every != 0) continue;
      Join join;
      join.fixed = i;
      join.moving = j;
      join.T_fixed_moving =
          is_near ? inverse(place(i)) * place(j) : SE2{40.0 * share(), 40.0 * share(), 3.0 * share()};
      join.probability = is_near ? 0.9 + 0.1 * share() : std::pow(share(), 40.0);
      join.acceptance_index = share();
      join.agreement = static_cast<std::int64_t>(random() % 20000);
      join.disagreement = static_cast<std::int64_t>(random() % 2000);
      join.overlap = share();
      const bool is_rejected = !is_near && (i + j) % 97 == 0 && j == i + 3;
      const bool is_rescued = is_near && (i + j) % 5 == 0;
      join.outcome = is_rejected  ? JoinOutcome::rejected
                     : is_rescued ? JoinOutcome::rescued
                     : is_near    ? JoinOutcome::accepted
                                  : JoinOutcome::refused;
      static_cast<PairPose&>(join.match) = join;
      join.match.verdict = is_rejected || (is_near && !is_rescued) ? Verdict::accepted : Verdict::refused;
      join.match.reason = reasons[random() % reasons.size()];
      join.match.hypotheses = {{join.T_fixed_moving, 500.0 * share(), join.probability}};
      join.match.hypotheses[0].figures.sigma = 0.1 + share();
      const double rest = 1.0 - join.probability;
      for (int k = 0; k < (is_near ? 11 : 1); ++k) {
        join.match.hypotheses.push_back(
            {{40.0 * share(), 40.0 * share(), 3.0 * share()}, 100.0 * share(), rest * std::pow(0.3, k + 1)});
      }
      result.joins.push_back(std::move(join));
    }
  }
  result.components.push_back(std::move(component));
  result.left_out = {{maps - 2, Reason::ambiguous}, {maps - 1, Reason::too_little_overlap}};
  result.open_ways = {{0, maps - 1, {1.0, 2.0, 0.5}, 0.4}};
  result.expected_false_joins = 0.0375;
  return result;
}

}  // namespace gridmerge::test
