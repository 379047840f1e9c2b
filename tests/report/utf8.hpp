// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gridmerge::test {

/// A character below U+10000 in UTF-8.
inline std::string utf8(char32_t character) {
  const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
  if (character < 0x80) return {byte(character)};
  if (character < 0x800) return {byte(0xC0 | character >> 6), byte(0x80 | (character & 0x3F))};
  return {byte(0xE0 | character >> 12), byte(0x80 | (character >> 6 & 0x3F)),
          byte(0x80 | (character & 0x3F))};
}

}  // namespace gridmerge::test
