// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/merge/fuse.hpp"

namespace gridmerge::internal {

/// What fuse(now, resolution) gives. `before` is what fuse(was, resolution) gave. Where nothing but cells of
/// some maps has changed in between, only what lies over these is drawn: O(changed cells * maps), and a look
/// at all cells. Otherwise, where a pose, the frame or the size of a map, the number of maps or what they
/// cover has changed, all is fused. Throws as fuse().
FusedMap fuse_again(FusedMap before, const std::vector<PlacedMap>& was, const std::vector<PlacedMap>& now,
                    double resolution);

}  // namespace gridmerge::internal
