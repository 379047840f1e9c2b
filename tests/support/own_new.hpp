// SPDX-License-Identifier: Apache-2.0
// A program that own_new.cpp is linked into has its own operator new. Alignments beyond the usual one are not
// its matter.
#pragma once

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

/// Whether memory is asked of allocate().
inline constexpr bool kHasOwnNew = GRIDMERGE_OWN_NEW == 1;

/// What operator new takes: memory for std::free(), or null, which makes it fail. The program defines it.
void* allocate(std::size_t size) noexcept;

/// What operator new does without memory: calls the new handler if there is one, and throws std::bad_alloc.
[[noreturn]] void fail_to_allocate();

}  // namespace gridmerge::test
