// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

namespace gridmerge::internal {

/// Calls `visit(index)` for each of `count` bytes that is `value`, in order. Where few are, this skips the
/// others a register at a time. O(count).
template <typename Byte, typename Visit>
void for_each_equal(const Byte* bytes, std::size_t count, Byte value, Visit visit) {
  static_assert(sizeof(Byte) == 1);
  const Byte* const end = bytes + count;
  for (const Byte* at = bytes; at != end; ++at) {
    at = static_cast<const Byte*>(
        std::memchr(at, static_cast<int>(value), static_cast<std::size_t>(end - at)));
    if (at == nullptr) return;
    visit(static_cast<std::size_t>(at - bytes));
  }
}

}  // namespace gridmerge::internal
