// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>

namespace gridmerge::internal {

// Vectors (GCC's and Clang's `vector_size`) from and to memory that need not be aligned for them; one
// instruction each. Never through a pointer to a vector type with an `aligned` of its own: Clang forgets that
// attribute and traps. By reference: returned by value, vectors would have another ABI in each version of a
// function.

template <typename Vector, typename Value>
inline __attribute__((always_inline)) void load(const Value* from, Vector& vector) {
  std::memcpy(&vector, from, sizeof vector);
}

template <typename Vector, typename Value>
inline __attribute__((always_inline)) void store(const Vector& vector, Value* to) {
  std::memcpy(to, &vector, sizeof vector);
}

}  // namespace gridmerge::internal
