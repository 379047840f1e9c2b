// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace gridmerge::internal {

/// Random numbers that are the same with every standard library (those of <random>'s distributions are not):
/// SplitMix64 (Steele, Lea & Flood, "Fast splittable pseudorandom number generators", 2014).
/// Draw once in an expression: in which order the arguments of a call or the operands of * are computed is
/// the compiler's choice, and with it who gets which number. Braces {} compute from left to right.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits();
  /// In [0, 1).
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [low, high], both included.
  int pick(int low, int high);
  bool chance(double probability) { return uniform() < probability; }
  /// Normal (Box & Muller 1958).
  double normal(double deviation);
  /// A generator of its own, so that what one part draws does not move what another one gets.
  Random fork() { return Random(bits()); }

 private:
  std::uint64_t state_;
};

}  // namespace gridmerge::internal
