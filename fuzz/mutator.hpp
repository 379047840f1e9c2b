// SPDX-License-Identifier: Apache-2.0
// What the structure-aware mutators share. libFuzzer calls LLVMFuzzerCustomMutator where a target defines it,
// and would change bytes at random where it does not: few of those changes get past the first syntax error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <string_view>

/// libFuzzer's own change of bytes; returns the new size.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace gridmerge::fuzz {

using Random = std::minstd_rand;

/// Below `count`, which is not 0.
inline std::size_t below(std::size_t count, Random& random) {
  return random() % count;
}

/// One of `values`, of which there are some.
template <typename Values>
auto& any_of(Values&& values, Random& random) {
  return values[below(std::size(values), random)];
}

/// The text with some of its bytes changed; at most `room` longer.
inline std::string with_changed_bytes(std::string text, std::size_t room = 16) {
  const std::size_t size = text.size();
  text.resize(size + room);
  text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
  return text;
}

/// Puts `text` into libFuzzer's buffer, or, if it does not fit, changes the bytes that are there.
inline std::size_t put(std::string_view text, std::uint8_t* data, std::size_t size, std::size_t max_size) {
  if (text.empty() || text.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

}  // namespace gridmerge::fuzz
