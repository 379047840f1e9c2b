// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/report/preview.hpp"

namespace gridmerge {

/// The colours of a preview beside the maps.
struct Style {
  static constexpr Colour kPage{250, 250, 248};
  static constexpr Colour kInk{45, 45, 50};
  static constexpr Colour kLine{170, 170, 165};
};

}  // namespace gridmerge
