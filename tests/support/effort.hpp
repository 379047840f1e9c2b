// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridmerge::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif

/// How often a test repeats what takes long: less under a sanitizer, which makes it tens of times slower and
/// looks for faults that one round shows as well as ten.
template <typename Count>
constexpr Count repeats(Count usual, Count sanitized) {
  return kSanitized ? sanitized : usual;
}

}  // namespace gridmerge::test
