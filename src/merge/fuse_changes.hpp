// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/merge/fuse.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// What fuse(now, resolution) gives, where `before` is what fuse(was, resolution) gave; omega to some cells,
/// since a centre on the edge between two cells may go to either. Where only cells of some maps have changed,
/// what lies over these is drawn: O(changed cells * maps), and a look at all cells. All is fused where a pose
/// has changed, or the frame or the size of a map, or the number of maps, or what they cover. Throws as
/// fuse().
GRIDMERGE_INTERNAL_EXPORT FusedMap fuse_changes(FusedMap before, const std::vector<PlacedMap>& was,
                                                const std::vector<PlacedMap>& now, double resolution);

}  // namespace gridmerge::internal
