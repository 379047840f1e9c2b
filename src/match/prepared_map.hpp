// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Orders maps by what they hold, not by where they come from: by their known area, and what differs between
/// maps of the same area. Of two maps the smaller is searched in the larger one.
GRIDMERGE_INTERNAL_EXPORT bool is_smaller(const PreparedMap& a, const PreparedMap& b);

/// Whether match() takes `fixed` for the moving map: if it is the smaller one, and of maps that hold the same
/// by their origins, so that it does not matter which is called fixed.
bool are_swapped(const PreparedMap& fixed, const PreparedMap& moving);

/// The side of the cells in which two maps are compared [m]: the coarser map's, or a multiple of it for large
/// maps.
GRIDMERGE_INTERNAL_EXPORT double working_cell(const PreparedMap& fixed, const PreparedMap& moving);

}  // namespace gridmerge::internal
