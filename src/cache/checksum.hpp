// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <tuple>

#include "grid/sha256.hpp"

namespace gridmerge::internal {

/// The bytes that end a file of a cache: the SHA-256 of all before them.
inline constexpr std::size_t kChecksum = std::tuple_size_v<Sha256::Digest>;

inline std::string checksum_of(std::string_view bytes) {
  const Sha256::Digest digest = Sha256().add(bytes).digest();
  return {digest.begin(), digest.end()};
}

}  // namespace gridmerge::internal
