// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace gridmerge::internal {

/// A probability or an index, as it is written beside a threshold: what falls short of it must not look as if
/// it reached it.
inline double rounded_down(double share, int digits = 4) {
  constexpr double kSums = 1e-9;  // 0.57 is 5699.999999999999 of ten thousand
  const double parts = std::pow(10.0, digits);
  return std::floor(share * parts + kSums) / parts;
}

}  // namespace gridmerge::internal
