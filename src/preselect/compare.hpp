// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "internal_export.hpp"
#include "preselect/signature.hpp"

namespace gridmerge::internal {

/// What two signatures say of each other under the best pose that they find.
struct SignatureMatch {
  SE2 T_fixed_moving;  ///< between map frames
  double score = 0.0;  ///< log-likelihood ratio of the sampled walls: this place against any [nats a metre of
                       ///< wall, summed]
  double next = 0.0;   ///< the same of the best pose elsewhere
  double met = 0.0;  ///< of the sampled walls that lie where the other map has seen, the share that meets one
  double seen = 0.0;      ///< length of the walls that lie where the other map has seen [m]
  double likeness = 0.0;  ///< of the most alike descriptors, in [-1, 1]
};

/// Compares corners of walls, checks the poses that the most alike ones propose, and refines the best few.
/// Neither map is preferred, but for rounding. O(keypoints^2 + sampled walls).
GRIDMERGE_INTERNAL_EXPORT SignatureMatch compare(const Signature& fixed, const Signature& moving);

}  // namespace gridmerge::internal
