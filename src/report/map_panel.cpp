// SPDX-License-Identifier: Apache-2.0
#include "report/map_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "grid/parallel.hpp"
#include "report/preview_colours.hpp"
#include "report/style.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kMaxZoom = 32;
constexpr int kMargin = 12;  // of unknown space around the maps [pixels]

// What the maps say of a cell: how many call it free and occupied, and the first that does.
struct Sighting {
  std::uint32_t free = 0;
  std::uint32_t occupied = 0;
  std::uint32_t first_free = 0;
  std::uint32_t first_occupied = 0;
  bool is_wall_of_plan = false;
};

/// Calls `say` for each cell of the lattice of which a map says something.
template <typename Say>
void hear(const LogOddsPatch& patch, const Lattice& lattice, std::vector<Sighting>& sightings,
          const Say& say) {
  parallel_rows(0, patch.height, [&](int row) {
    for (int column = 0; column < patch.width; ++column) {
      const std::int16_t log_odds = patch.at(column, row);
      if (log_odds == 0) continue;
      say(log_odds,
          sightings[static_cast<std::size_t>(patch.row + row) * static_cast<std::size_t>(lattice.width) +
                    static_cast<std::size_t>(patch.column + column)]);
    }
  });
}

std::vector<Sighting> sight(const MapPanel& panel, const Lattice& lattice) {
  std::vector<Sighting> sightings(static_cast<std::size_t>(lattice.width) *
                                  static_cast<std::size_t>(lattice.height));
  for (std::size_t i = 0; i < panel.maps.size(); ++i) {
    const LogOddsPatch patch = i < panel.deformations.size()
                                   ? draw_log_odds(panel.maps[i], lattice, panel.deformations[i])
                                   : draw_log_odds(panel.maps[i], lattice);
    hear(patch, lattice, sightings, [&](std::int16_t log_odds, Sighting& cell) {
      std::uint32_t& count = log_odds > 0 ? cell.occupied : cell.free;
      if (count == 0) (log_odds > 0 ? cell.first_occupied : cell.first_free) = static_cast<std::uint32_t>(i);
      ++count;
    });
  }
  if (panel.plan) {
    hear(draw_log_odds(*panel.plan, lattice), lattice, sightings,
         [](std::int16_t log_odds, Sighting& cell) { cell.is_wall_of_plan = log_odds > 0; });
  }
  return sightings;
}

Colour colour_of(const Sighting& cell, const std::vector<Colour>& colours) {
  if (cell.is_wall_of_plan && cell.occupied == 0) return PreviewColours::kPlan;
  if (cell.free + cell.occupied > 1) return shared_colour(cell.free, cell.occupied);
  if (cell.occupied > 0) return colours[cell.first_occupied];
  if (cell.free > 0) return free_tint(colours[cell.first_free]);
  return PreviewColours::kUnknown;
}

Canvas draw_maps(const MapPanel& panel, const Lattice& lattice, int zoom) {
  const std::vector<Sighting> sightings = sight(panel, lattice);
  Canvas canvas(lattice.width * zoom + 2 * kMargin, lattice.height * zoom + 2 * kMargin,
                PreviewColours::kUnknown);
  parallel_rows(0, lattice.height, [&](int row) {
    for (int column = 0; column < lattice.width; ++column) {
      const Sighting& cell =
          sightings[static_cast<std::size_t>(row) * static_cast<std::size_t>(lattice.width) +
                    static_cast<std::size_t>(column)];
      canvas.fill(kMargin + column * zoom, kMargin + (lattice.height - 1 - row) * zoom, zoom, zoom,
                  colour_of(cell, panel.colours));
    }
  });
  return canvas;
}

// The longest of 1, 2, 5, 10, ... (or tenths) metres that is at most `limit`.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= limit) return digit * power;
  }
  return power;
}

Canvas draw_scale_bar(double metres_per_pixel, int available) {
  constexpr TextSize kText = TextSize::small;
  const double length = round_length(metres_per_pixel * std::max(available / 4, 1));
  const int bar = std::max(1, static_cast<int>(std::lround(length / metres_per_pixel)));
  const std::string label = fmt::format("{:.6g} m", length);
  const int gap = gap_of(kText), height = line_height(kText), line = std::max(1, gap / 4);
  Canvas canvas(bar + gap + text_width(label, kText), height, Style::kPage);
  const int top = baseline(kText) / 4, bottom = baseline(kText);
  canvas.fill(0, (top + bottom - line) / 2, bar, line, Style::kInk);
  canvas.fill(0, top, line, bottom - top, Style::kInk);
  canvas.fill(bar - line, top, line, bottom - top, Style::kInk);
  canvas.write(bar + gap, 0, kText, label, Style::kInk);
  return canvas;
}

}  // namespace

Colour free_tint(Colour map) {
  const auto lighten = [](std::uint8_t channel) {
    return static_cast<std::uint8_t>(255 - (255 - channel) * 24 / 100);
  };
  return {lighten(map.red), lighten(map.green), lighten(map.blue)};
}

Colour shared_colour(std::uint32_t free, std::uint32_t occupied) {
  const Colour agreed = occupied >= free ? PreviewColours::kSharedWall : PreviewColours::kSharedFree;
  return mix(agreed, PreviewColours::kDisagreement, 2.0 * std::min(free, occupied) / (free + occupied));
}

int gap_of(TextSize text) {
  return line_height(text) / 3;
}

Canvas draw_panel(const MapPanel& panel, TextSize title) {
  // One cell less than there is room for: a coarser lattice need not begin where the maps do.
  const int room = panel.max_side - 2 * kMargin - 1;
  const double coarsening = std::max(1.0, std::ceil(panel.longest_side / room));
  std::vector<PlacedMap> drawn = panel.maps;
  if (panel.plan) drawn.push_back(*panel.plan);
  const Lattice lattice = cover(drawn, panel.resolution * coarsening, panel.deformations);
  const int zoom = std::clamp(panel.min_side / std::max(lattice.width, lattice.height), 1, kMaxZoom);
  const Canvas drawing = draw_maps(panel, lattice, zoom);
  const Canvas scale_bar =
      draw_scale_bar(lattice.resolution / zoom, std::max(drawing.width(), panel.min_width));
  const int width = std::max({drawing.width(), scale_bar.width(), panel.min_width});

  const int gap = gap_of(title);
  const int drawing_y = line_height(title) + gap;
  const int bar_y = drawing_y + drawing.height() + gap;
  Canvas canvas(width, bar_y + scale_bar.height(), Style::kPage);
  canvas.write(0, 0, title, fit_width(panel.title, title, width), Style::kInk);
  canvas.draw(0, drawing_y, drawing);
  canvas.draw(0, bar_y, scale_bar);
  return canvas;
}

}  // namespace gridmerge::internal
