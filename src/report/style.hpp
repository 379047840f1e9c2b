// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/report/preview.hpp"

namespace gridmerge {

/// The colours of a preview beside the maps.
struct Style {
  static constexpr Colour page{250, 250, 248};
  static constexpr Colour ink{45, 45, 50};
  static constexpr Colour line{170, 170, 165};
};

}  // namespace gridmerge
