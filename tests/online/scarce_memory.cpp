// SPDX-License-Identifier: Apache-2.0
#include "scarce_memory.hpp"

#include <cstdlib>

namespace gridmerge::test {

std::atomic<std::size_t> scarce_from{0};

void* allocate(std::size_t size) noexcept {
  const std::size_t least = scarce_from;
  return least > 0 && size >= least ? nullptr : std::malloc(size > 0 ? size : 1);
}

}  // namespace gridmerge::test
