// SPDX-License-Identifier: Apache-2.0
#include "preselect/dot_products.hpp"

#include "grid/multiversion.hpp"
#include "preselect/signature.hpp"

namespace gridmerge::internal {
inline namespace multiversion {

GRIDMERGE_MULTIVERSION void dot_products(const std::int16_t* one, const std::int16_t* many, std::size_t count,
                                         std::int32_t* products) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int16_t* other = many + i * kDescriptorSize;
    std::int32_t sum = 0;
    for (std::size_t k = 0; k < kDescriptorSize; ++k) sum += std::int32_t{one[k]} * other[k];
    products[i] = sum;
  }
}

GRIDMERGE_MULTIVERSION std::int32_t dot_product(const std::int16_t* a, const std::int16_t* b,
                                                std::size_t count) {
  std::int32_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::int32_t{a[i]} * b[i];
  return sum;
}

}  // namespace multiversion
}  // namespace gridmerge::internal
