// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::test {

/// The maps that a merge left out, in its order.
inline std::vector<std::size_t> maps_left_out(const MergeResult& result) {
  std::vector<std::size_t> maps;
  for (const LeftOut& one : result.left_out) maps.push_back(one.map);
  return maps;
}

}  // namespace gridmerge::test
