// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "merge/log_odds.hpp"
#include "report/canvas.hpp"

namespace gridmerge::internal {

/// Maps that are drawn over each other in their colours, and how large.
struct MapPanel {
  std::string title;
  std::vector<PlacedMap> maps;
  std::vector<Deformation> deformations;  ///< of the maps, as of fuse()
  std::vector<Colour> colours;            ///< one per map
  std::optional<PlacedMap> plan;          ///< its walls, drawn where no map has one
  double resolution = 0.0;                ///< of the finest drawing that makes sense [m/cell]
  double longest_side = 0.0;              ///< of the maps together, in such cells; may be too large
  int min_width = 0;                      ///< pixels of the whole panel, for its title
  int min_side = 0;                       ///< pixels: drawings below are magnified
  int max_side = 0;                       ///< pixels: drawings above, margins included, are made coarser
};

/// The panel with its title above and a scale bar below.
Canvas draw_panel(const MapPanel& panel, TextSize title);

/// Between a text and what it belongs to [pixels].
int gap_of(TextSize text);

/// The tint of free space that one map saw.
Colour free_tint(Colour map);

/// A cell that several maps know: so many call it free, so many occupied. The report page has the same rule.
Colour shared_colour(std::uint32_t free, std::uint32_t occupied);

}  // namespace gridmerge::internal
