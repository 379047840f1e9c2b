// SPDX-License-Identifier: Apache-2.0
#include "report/base64.hpp"

#include <algorithm>
#include <cstdint>

namespace gridmerge::internal {

std::string to_base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t start = 0; start < bytes.size(); start += 3) {
    const std::size_t taken = std::min<std::size_t>(3, bytes.size() - start);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      bits = bits << 8 | (i < taken ? static_cast<unsigned char>(bytes[start + i]) : 0u);
    }
    for (std::size_t i = 0; i < 4; ++i) text += i <= taken ? kDigits[bits >> (18 - 6 * i) & 63u] : '=';
  }
  return text;
}

}  // namespace gridmerge::internal
