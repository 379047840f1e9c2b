// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <gridmerge/grid/se2.hpp>

// A function of the core that no other component needs (similarity/evidence.hpp).
namespace gridmerge::internal {
int facing_class(std::uint8_t a, std::uint8_t b);
}

int main() {
  return gridmerge::internal::facing_class(0, 0);
}
