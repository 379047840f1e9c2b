// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "gridmerge/report/merge_output.hpp"

namespace gridmerge::internal {

/// The colours of a preview beside the maps.
struct Style {
  static constexpr Colour kPage{250, 250, 248};
  static constexpr Colour kInk{45, 45, 50};
  static constexpr Colour kLine{170, 170, 165};
};

/// `share` of b, the rest of a.
inline Colour mix(Colour a, Colour b, double share) {
  const auto channel = [share](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + (to - from) * share));
  };
  return {channel(a.red, b.red), channel(a.green, b.green), channel(a.blue, b.blue)};
}

}  // namespace gridmerge::internal
