// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/deformation.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// The deformation seen from another frame of the same map: bends points of frame a as `deformation` bends
/// those of frame b. O(1) and a copy of the lattice.
GRIDMERGE_INTERNAL_EXPORT Deformation seen_from(const SE2& T_a_b, const Deformation& deformation);

}  // namespace gridmerge::internal
