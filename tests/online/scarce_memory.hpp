// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>

// ThreadSanitizer has an operator new of its own, beside which there is room for no other.
#if defined(__SANITIZE_THREAD__)
#define GRIDMERGE_OWN_NEW 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define GRIDMERGE_OWN_NEW 0
#endif
#endif
#ifndef GRIDMERGE_OWN_NEW
#define GRIDMERGE_OWN_NEW 1
#endif

namespace gridmerge::test {

/// Whether memory can be made scarce.
inline constexpr bool kMemoryCanBeScarce = GRIDMERGE_OWN_NEW == 1;

/// From so many bytes on, operator new throws std::bad_alloc, in all threads; 0 for never.
extern std::atomic<std::size_t> scarce_from;

}  // namespace gridmerge::test
