// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "match/hypotheses.hpp"
#include "match/looks.hpp"
#include "match/scaled_pose.hpp"

namespace gridmerge::internal {

/// Two maps, the moving one drawn at one scale.
class ScaledPair {
 public:
  /// In cells of `cell` metres, or larger ones where working_cell() is larger. `fixed` must outlive this.
  /// O(cells).
  ScaledPair(const PreparedMap& fixed, const PreparedMap& moving, double scale, double cell);

  /// What find_hypotheses() says of the pair at this scale: the `count` most probable.
  std::vector<Hypothesis> look(SearchMethod search, std::size_t count) const;

  /// All that speaks for a pose of this scale; what is known from rivals is not set.
  Hypothesis judge(const SE2& T_fixed_moving) const;

  /// `pose` brought to its maximum near this scale, by all walls.
  ScaledPose settle(const ScaledPose& pose, double reach) const;

  /// How the maps agree under a pose of this scale.
  void count_common(PairPose& pose) const;

 private:
  /// Between the compared maps' grid frames [cells], of which either may be the fixed one.
  ScaledPose to_cells(const ScaledPose& pose) const;
  ScaledPose from_cells(const ScaledPose& pose) const;

  double scale_;
  PreparedMap moving_;
  const PreparedMap& fixed_;
  bool swapped_;
  ComparedMaps maps_;
  PoseMetric metric_;
  PoseJudge judge_;
};

}  // namespace gridmerge::internal
