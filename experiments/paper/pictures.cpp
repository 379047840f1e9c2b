// SPDX-License-Identifier: Apache-2.0
#include "pictures.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "io/png.hpp"

namespace gridmerge::paper {

using namespace internal;

std::string draw(const OccupancyGrid& map) {
  constexpr std::array<std::array<std::uint8_t, 3>, 3> kColours{
      {{255, 255, 255}, {0, 158, 96}, {204, 32, 32}}};
  const OccupancyGrid known = crop_to_known(map);
  PngImage image;
  image.width = known.width;
  image.height = known.height;
  for (int row = known.height - 1; row >= 0; --row) {
    for (int column = 0; column < known.width; ++column) {
      const auto& colour = kColours[static_cast<std::size_t>(known.at(column, row))];
      image.samples.insert(image.samples.end(), colour.begin(), colour.end());
    }
  }
  return encode_png(image);
}

std::string draw_placed(const std::vector<PlacedMap>& maps) {
  return draw(fuse(maps, maps.front().map->resolution).grid);
}

std::string draw_merged(const Pair& pair, const SE2& T_fixed_moving) {
  return draw_placed({{&pair.fixed->map, {}}, {&pair.moving->map, T_fixed_moving}});
}

}  // namespace gridmerge::paper
