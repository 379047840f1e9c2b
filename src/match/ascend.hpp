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

/// Steepest ascent from `pose` over `moves` moves, of which 2 i and 2 i + 1 undo each other; the step is
/// halved whenever none of them helps. `moved(pose, move, step)` makes one; `is_better(pose)` says whether a
/// pose is better than the best one so far, which it then is.
template <typename Pose, typename Moved, typename IsBetter>
Pose ascend_by(std::size_t moves, Pose pose, const AscentSteps& steps, Moved moved, IsBetter is_better) {
  for (double step = steps.first; step >= steps.last; step /= 2.0) {
    std::size_t last = moves;
    for (int i = 0; i < steps.max_moves; ++i) {
      const Pose from = pose;
      const std::size_t back = last ^ 1U;  // would undo the last move
      last = moves;
      for (std::size_t m = 0; m < moves; ++m) {
        if (m == back) continue;
        const Pose next = moved(from, m, step);
        if (!is_better(next)) continue;
        pose = next;
        last = m;
      }
      if (last == moves) break;
    }
  }
  return pose;
}

/// Moves of a rigid pose: +-x, +-y and +-rotation, in steps by which walls move on average.
inline constexpr std::size_t kRigidMoves = 6;
inline SE2 moved_rigidly(const PoseMetric& metric, const SE2& pose, std::size_t move, double step) {
  constexpr std::array<std::array<double, 3>, kRigidMoves> kMoves{
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  const auto& [dx, dy, turn] = kMoves[move];
  return metric.moved(pose, step * dx, step * dy, step * turn / metric.radius);
}

/// ascend_by() over these moves.
template <typename IsBetter>
SE2 ascend(const PoseMetric& metric, const SE2& pose, const AscentSteps& steps, IsBetter is_better) {
  return ascend_by(
      kRigidMoves, pose, steps,
      [&](const SE2& from, std::size_t move, double step) { return moved_rigidly(metric, from, move, step); },
      is_better);
}

}  // namespace gridmerge::internal
