// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/report/merge_output.hpp"

namespace gridmerge::internal {

/// The colours of a preview. Free space that one map saw has a light tint of the map's colour.
struct PreviewColours {
  static constexpr Colour kUnknown{221, 221, 217};     ///< known to no map
  static constexpr Colour kSharedFree{255, 255, 255};  ///< free in two maps or more
  static constexpr Colour kSharedWall{32, 32, 36};     ///< occupied in two maps or more
  /// Free in as many maps as occupied; nothing else has it. The fewer say otherwise than the rest, the nearer
  /// to what the rest say.
  static constexpr Colour kDisagreement{213, 94, 0};
  /// Walls of a plan where no map has one; as on the report page.
  static constexpr Colour kPlan{112, 48, 16};
};

}  // namespace gridmerge::internal
