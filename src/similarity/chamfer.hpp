// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace gridmerge::internal {

inline constexpr int kChamferStep = 3;  ///< distance units of one cell
inline constexpr int kChamferDiagonal = 4;

/// A chamfer distance with a label of the place it was measured to: the label is in the low byte, so that the
/// smaller of two is the nearer one, and needs no branch.
using LabelledDistance = std::uint32_t;
inline constexpr LabelledDistance kDistanceLabels = 256;
inline constexpr LabelledDistance kFarDistance = 60000 * kDistanceLabels;

/// In place: elsewhere than at the zeros, the chamfer distance to the nearest of them, and its label. The
/// border must be kFarDistance, and stays it. O(cells); vectorised.
void chamfer_distance(std::vector<LabelledDistance>& distance, int width, int height);

}  // namespace gridmerge::internal
