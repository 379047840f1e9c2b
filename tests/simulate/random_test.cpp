// SPDX-License-Identifier: Apache-2.0
#include "simulate/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace gridmerge::internal {
namespace {

TEST(Random, IsSplitMix64) {
  // The numbers that the authors' code prints for this seed.
  Random random(1234567);
  for (const std::uint64_t expected : {6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                       4593380528125082431U, 16408922859458223821U})
    EXPECT_EQ(random.bits(), expected);
}

TEST(Random, DrawsAreSpreadAsTheySay) {
  Random random(5);
  constexpr int kDraws = 40000;
  double sum = 0.0, squares = 0.0, cubes = 0.0, uniforms = 0.0, least = 5.0, most = 3.0;
  int hits = 0, beyond = 0;
  std::array<int, 5> picked{};
  for (int i = 0; i < kDraws; ++i) {
    const double normal = random.normal(2.0);
    sum += normal;
    squares += normal * normal;
    cubes += normal * normal * normal;
    beyond += std::abs(normal) > 4.0 ? 1 : 0;
    const double uniform = random.uniform(3.0, 5.0);
    uniforms += uniform;
    least = std::min(least, uniform);
    most = std::max(most, uniform);
    hits += random.chance(0.3) ? 1 : 0;
    ++picked.at(static_cast<std::size_t>(random.pick(-1, 3) + 1));
  }
  // Within four standard deviations of what is expected.
  EXPECT_NEAR(sum / kDraws, 0.0, 4.0 * 2.0 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 4.0, 4.0 * 4.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(cubes / kDraws, 0.0, 4.0 * 8.0 * std::sqrt(15.0 / kDraws));
  EXPECT_NEAR(beyond / static_cast<double>(kDraws), 0.0455, 0.005);  // two deviations
  EXPECT_NEAR(uniforms / kDraws, 4.0, 0.012);
  EXPECT_GE(least, 3.0);
  EXPECT_LT(most, 5.0);
  EXPECT_GT(most - least, 1.99);
  EXPECT_NEAR(hits / static_cast<double>(kDraws), 0.3, 0.01);
  for (const int count : picked) EXPECT_NEAR(count, kDraws / 5.0, 4.0 * std::sqrt(kDraws / 5.0));
}

TEST(Random, AForkGoesItsOwnWay) {
  Random one(9), other(9);
  Random fork = one.fork();
  EXPECT_EQ(fork.bits(), Random(other.bits()).bits());
  for (int i = 0; i < 10; ++i) fork.bits();
  EXPECT_EQ(one.bits(), other.bits());
}

}  // namespace
}  // namespace gridmerge::internal
