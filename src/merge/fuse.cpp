// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/fuse.hpp"

namespace gridmerge {

FusedMap fuse(const std::vector<PlacedMap>&, double) { return {}; }

}  // namespace gridmerge
