// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// SHA-256 (FIPS 180-4) of bytes that come one after the other: what tells content apart, wherever it lies.
class GRIDMERGE_INTERNAL_EXPORT Sha256 {
 public:
  using Digest = std::array<std::uint8_t, 32>;

  Sha256& add(std::string_view bytes);

  /// Of all bytes that were added; once only.
  Digest digest();

 private:
  void take_block(const std::uint8_t* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::uint8_t, 64> pending_{};
  std::uint64_t length_ = 0;  // [bytes]
};

/// Two lower-case digits a byte.
GRIDMERGE_INTERNAL_EXPORT std::string to_hex(const Sha256::Digest& digest);

}  // namespace gridmerge::internal
