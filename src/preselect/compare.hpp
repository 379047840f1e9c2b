// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "internal_export.hpp"
#include "preselect/signature.hpp"

namespace gridmerge::internal {

/// What two signatures say of each other under the best pose that they find.
struct SignatureMatch {
  SE2 T_fixed_moving;       ///< between map frames
  double seen = 0.0;        ///< length of the sampled walls that lie where the other map has seen [m]
  double met = 0.0;         ///< of it, the length that meets a wall which faces the same side [m]
  double open = 0.0;        ///< of it, the length that lies in the open [m]
  double chance = 0.0;      ///< length that chance would let meet [m]
  double votes = 0.0;       ///< likeness of the most alike keypoints that lie so, summed
  double next_votes = 0.0;  ///< the same of the pose elsewhere that most keypoints propose
  double likeness = 0.0;    ///< of the most alike keypoints, in [-1, 1]
};

/// Compares corners of walls, checks the poses that the most alike ones propose, and refines the best few.
/// Neither map is preferred, but for rounding. O(keypoints^2 + sampled walls).
GRIDMERGE_INTERNAL_EXPORT SignatureMatch compare(const Signature& fixed, const Signature& moving);

}  // namespace gridmerge::internal
