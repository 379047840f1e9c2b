// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

#include "support/own_new.hpp"

namespace gridmerge::test {

/// Whether memory can be made scarce.
inline constexpr bool kMemoryCanBeScarce = kHasOwnNew;

/// From so many bytes on, operator new throws std::bad_alloc, in all threads; 0 for never.
extern std::atomic<std::size_t> scarce_from;

}  // namespace gridmerge::test
