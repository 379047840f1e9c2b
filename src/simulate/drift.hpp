// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <unordered_map>

#include "gridmerge/grid/se2.hpp"
#include "simulate/random.hpp"

namespace gridmerge::internal {

/// What a robot believes of its pose. Its odometry turns a little too far for a while, then too little, and
/// takes ways for longer or shorter than they are; where it comes by a place that it has mapped before, its
/// mapper pulls it back towards the error that it had there. So maps bend, but hang together.
class DriftingPose {
 public:
  /// `drift` as in SimulateOptions.
  DriftingPose(double drift, Random random);

  /// The believed pose for the next true one, both in one frame; the first is right.
  SE2 follow(const SE2& T_building_robot);

 private:
  /// What a robot is off by: (x, y) [m] and theta [rad], added to the true pose.
  struct Offset {
    double x = 0.0, y = 0.0, theta = 0.0;
  };
  struct Remembered {
    Offset offset;
    double way;  // when it was there first
  };

  void wander(const SE2& from, const SE2& to);
  void recall(const SE2& place);

  double drift_;
  Random random_;
  double scale_;       // of ways
  double bias_ = 0.0;  // of the heading, for a metre of way [rad/m]
  Offset offset_;
  double way_ = 0.0;
  std::optional<SE2> last_;
  std::unordered_map<long long, Remembered> places_;
};

}  // namespace gridmerge::internal
