// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridmerge::internal {

/// No grid is made of more cells, nor read from a message; a file's may be more if its reader is told so. Of
/// 32 bits, so that it is exact as a floating point number too.
inline constexpr std::uint32_t kMaxGridCells = std::uint32_t{1} << 28;

}  // namespace gridmerge::internal
