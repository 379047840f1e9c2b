// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "preselect/signature.hpp"

namespace gridmerge::internal {

/// Two keypoints that look alike once the moving map's is turned by quarters of a turn.
struct Proposal {
  std::int32_t product;  ///< of their descriptors
  int fixed, moving, quarters;
};

/// The `most` pairs of keypoints with the greatest products above 0, greatest first; of equal ones those come
/// first whose indices are lower. O(fixed * moving) products.
std::vector<Proposal> most_alike(const std::vector<Descriptor>& fixed, const std::vector<Descriptor>& moving,
                                 std::size_t most);

}  // namespace gridmerge::internal
