// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace gridmerge::internal {
inline namespace multiversion {

/// products[i] = the dot product of `one` with the i-th of `count` vectors, which lie one after the other.
/// All are kDescriptorSize long, and the sums must fit 32 bits.
void dot_products(const std::int16_t* one, const std::int16_t* many, std::size_t count,
                  std::int32_t* products);

/// Of two vectors of any length, whose sum must fit 32 bits.
std::int32_t dot_product(const std::int16_t* a, const std::int16_t* b, std::size_t count);

}  // namespace multiversion
}  // namespace gridmerge::internal
