// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace gridmerge::internal {

struct CharacterRange {
  char32_t first;
  char32_t last;
};

/// The characters of font.png, in its order: Latin with its accents, Greek, Cyrillic, an ellipsis, and what
/// stands for all others. make_font.py reads them from here.
inline constexpr std::array<CharacterRange, 6> kFontCharacters{
    {{0x20, 0x7e}, {0xa0, 0x17f}, {0x391, 0x3c9}, {0x400, 0x45f}, {0x2026, 0x2026}, {0xfffd, 0xfffd}}};

}  // namespace gridmerge::internal
