// SPDX-License-Identifier: Apache-2.0
#include "preselect/dot_products.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "preselect/signature.hpp"

namespace gridmerge::internal {
namespace {

std::int64_t literal(const std::int16_t* a, const std::int16_t* b, std::size_t count) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += std::int64_t{a[i]} * b[i];
  return sum;
}

TEST(DotProducts, AreThoseOfALoop) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> value(-400, 400);
  const std::size_t count = 37;
  std::vector<std::int16_t> one(kDescriptorSize), many(count * kDescriptorSize);
  for (std::int16_t& v : one) v = static_cast<std::int16_t>(value(random));
  for (std::int16_t& v : many) v = static_cast<std::int16_t>(value(random));
  std::vector<std::int32_t> products(count);
  dot_products(one.data(), many.data(), count, products.data());
  for (std::size_t i = 0; i < count; ++i)
    EXPECT_EQ(products[i], literal(one.data(), many.data() + i * kDescriptorSize, kDescriptorSize));
  for (const std::size_t length : {0, 1, 7, 16, 95})
    EXPECT_EQ(dot_product(one.data(), many.data() + 5, length), literal(one.data(), many.data() + 5, length));
}

}  // namespace
}  // namespace gridmerge::internal
