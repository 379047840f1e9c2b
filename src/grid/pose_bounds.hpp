// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridmerge::internal {

// Of poses that users know: what is beyond is a mistake.
inline constexpr double kFarthestPose = 1e7;  // [m]

// Of the standard deviations of their places [m] and directions [rad]. Equations in which one is much larger
// than another have no solution in numbers of 64 bits.
inline constexpr double kMinDeviation = 1e-6;
inline constexpr double kMaxDeviation = 1e5;

inline bool is_deviation(double sd) {
  return sd >= kMinDeviation && sd <= kMaxDeviation;
}

}  // namespace gridmerge::internal
