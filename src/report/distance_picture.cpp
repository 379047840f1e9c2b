// SPDX-License-Identifier: Apache-2.0
#include "report/distance_picture.hpp"

#include <algorithm>

#include "report/canvas.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kMaxNumbered = 40;   // cells per side: fills a screen
constexpr int kNumberedCell = 24;  // pixels: three digits fit
constexpr int kLine = 1;           // between magnified cells

constexpr Colour kBlack{0, 0, 0};
constexpr Colour kWhite{255, 255, 255};

/// The farthest distance of the map; 0 if there is none.
int farthest(const DistanceMap& map) {
  int most = 0;
  for (const std::uint16_t distance : map.distances) {
    if (distance != kNoDistance) most = std::max(most, int{distance});
  }
  return most;
}

Colour shade(std::uint16_t distance, int most) {
  if (distance == kNoDistance) return kWhite;
  const auto gray = static_cast<std::uint8_t>(255 * distance / std::max(1, most));
  return {gray, gray, gray};
}

void write_number(Canvas& canvas, int x, int y, std::uint16_t distance, Colour background) {
  const std::string number = distance == kNoDistance ? "inf" : std::to_string(distance);
  const int left = (kNumberedCell - text_width(number, TextSize::tiny)) / 2;
  const int top = (kNumberedCell - line_height(TextSize::tiny)) / 2;
  canvas.write(x + left, y + top, TextSize::tiny, number, background.red < 128 ? kWhite : kBlack);
}

}  // namespace

std::string distance_map_png(const DistanceMap& map) {
  const bool numbered = std::max(map.width, map.height) <= kMaxNumbered;
  const int cell = numbered ? kNumberedCell : 1;
  const int line = numbered ? kLine : 0;
  const int most = farthest(map);
  Canvas canvas(map.width * cell + line, map.height * cell + line, {128, 128, 128});
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const std::uint16_t distance = map.at(column, row);
      const Colour colour = shade(distance, most);
      const int x = column * cell, y = (map.height - 1 - row) * cell;
      canvas.fill(x + line, y + line, cell - line, cell - line, colour);
      if (numbered) write_number(canvas, x, y, distance, colour);
    }
  }
  return encode_png(canvas.image());
}

}  // namespace gridmerge::internal
