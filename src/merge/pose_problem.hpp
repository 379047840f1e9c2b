// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/ceres.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "merge/pose_graph.hpp"

namespace gridmerge::internal {

/// Poses of frames in a common one, adjusted to what is measured between them (Ceres, robust least squares).
///
/// A pose is optimised as the place of a point of its frame and the frame's direction. With the middle of
/// what the frame holds for the point the three hardly depend on each other, however far off the origin is.
class PoseProblem {
 public:
  /// Of at most so many poses.
  explicit PoseProblem(std::size_t most_poses) { blocks_.reserve(most_poses); }

  /// Returns the pose's number. A held pose is not changed. Throws std::length_error for one pose too many.
  std::size_t add_pose(const SE2& pose, const Point2& middle, bool held);

  /// Adds a measurement between two of the poses.
  void add(const RelativePose& measured);

  /// Adds residuals of two poses that take them as (x, y, theta) of frames with their origins in the middles.
  void add(std::size_t fixed, std::size_t moving, std::unique_ptr<ceres::CostFunction> error);

  void solve();

  SE2 pose(std::size_t number) const;

  /// Of all poses; 0 for those held, none where the problem does not determine them.
  std::vector<std::optional<PoseDeviation>> deviations();

 private:
  struct Block {
    std::array<double, 3> values;  // the middle's place, and theta
    Point2 middle;
    bool held;
  };

  // They stay where they are. Ceres computes in the order of their addresses, which is then that of their
  // numbers: last digits do not depend on what else the process has allocated.
  std::vector<Block> blocks_;
  ceres::Problem problem_;
};

}  // namespace gridmerge::internal
