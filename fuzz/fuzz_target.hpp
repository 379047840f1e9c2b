// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "io/image.hpp"

namespace gridmerge::fuzz {

/// Small enough that an honest large image is no finding.
constexpr std::size_t kMaxPixels = std::size_t{1} << 20;

inline std::string_view as_bytes(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Ends the process, which is how a target reports a finding, and says where. (Debian's Clang has no
/// std::source_location.)
inline void require(bool condition, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: what is required here is not so\n", file, line);
  std::abort();
}

/// What every decoder promises of its image.
inline bool is_sound(const internal::MapImage& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  return image.width > 0 && image.height > 0 && pixels <= kMaxPixels && image.white > 0 &&
         image.lightness.size() == pixels && (image.alpha.empty() || image.alpha.size() == pixels) &&
         *std::max_element(image.lightness.begin(), image.lightness.end()) <= image.white;
}

}  // namespace gridmerge::fuzz
