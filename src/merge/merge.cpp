// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge.hpp"

namespace gridmerge {

MergeResult merge(const std::vector<OccupancyGrid>&, const MergeOptions&) { return {}; }

}  // namespace gridmerge
