// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "match/refine.hpp"

namespace gridmerge::internal {

/// How an ascent goes on.
struct AscentSteps {
  double first;   ///< [cells]
  double last;    ///< [cells]
  int max_moves;  ///< of each length
};

/// Steepest ascent from `pose` over steps of +-x, +-y and +-rotation; the step is halved whenever none of
/// them helps. `is_better(pose)` says whether a pose is better than the best one so far, which it then is.
template <typename IsBetter>
SE2 ascend(const PoseMetric& metric, SE2 pose, const AscentSteps& steps, IsBetter is_better) {
  constexpr std::array<std::array<double, 3>, 6> kMoves{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  for (double step = steps.first; step >= steps.last; step /= 2.0) {
    std::size_t last = kMoves.size();
    for (int i = 0; i < steps.max_moves; ++i) {
      const SE2 from = pose;
      const std::size_t back = last ^ 1U;  // would undo the last move
      last = kMoves.size();
      for (std::size_t m = 0; m < kMoves.size(); ++m) {
        if (m == back) continue;
        const auto& [dx, dy, turn] = kMoves[m];
        const SE2 moved = metric.moved(from, step * dx, step * dy, step * turn / metric.radius);
        if (!is_better(moved)) continue;
        pose = moved;
        last = m;
      }
      if (last == kMoves.size()) break;
    }
  }
  return pose;
}

}  // namespace gridmerge::internal
