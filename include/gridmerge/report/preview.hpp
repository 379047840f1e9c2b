// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "gridmerge/export.hpp"
#include "gridmerge/report/named_merge.hpp"

namespace gridmerge {

/// A colour, 8 bits a channel.
struct Colour {
  std::uint8_t red = 0;    ///< 0 to 255
  std::uint8_t green = 0;  ///< 0 to 255
  std::uint8_t blue = 0;   ///< 0 to 255

  /// Whether all channels are equal.
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// The colours of a preview. Free space that one map saw has a light tint of the map's colour.
struct PreviewColours {
  static constexpr Colour kUnknown{221, 221, 217};     ///< known to no map
  static constexpr Colour kSharedFree{255, 255, 255};  ///< free in two maps or more
  static constexpr Colour kSharedWall{32, 32, 36};     ///< occupied in two maps or more
  /// Free in as many maps as occupied; nothing else has it. The fewer say otherwise than the rest, the nearer
  /// to what the rest say.
  static constexpr Colour kDisagreement{213, 94, 0};
};

/// The colour of input map i, of its walls. The first six are distinct to colour-blind eyes too; further maps
/// get darker and lighter shades of them.
GRIDMERGE_EXPORT Colour map_colour(std::size_t map);

/// A PNG that shows a merge: each component with its maps in their own colours, what they share and where
/// they disagree, a scale bar in metres, and the colours' meaning; below, the maps that were left out, each
/// by itself in its own frame. Of each kind the first twelve are shown, and how many more there are. Small
/// maps are magnified, large ones drawn at a coarser resolution: the picture is at most 2400 pixels wide, and
/// no map in it higher. Names are UTF-8; folders that all of them lie in are not shown.
GRIDMERGE_EXPORT std::string preview_png(const NamedMerge& merge);

}  // namespace gridmerge
