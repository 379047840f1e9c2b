// SPDX-License-Identifier: Apache-2.0
#include "simulate/random.hpp"

#include <cmath>
#include <numbers>

namespace gridmerge::internal {

std::uint64_t Random::bits() {
  state_ += 0x9e3779b97f4a7c15ULL;
  std::uint64_t bits = state_;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31);
}

double Random::uniform() {
  return static_cast<double>(bits() >> 11) * 0x1p-53;
}

int Random::pick(int low, int high) {
  return low + static_cast<int>(uniform() * (high - low + 1));
}

double Random::normal(double deviation) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return deviation * radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace gridmerge::internal
