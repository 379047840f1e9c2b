// SPDX-License-Identifier: Apache-2.0
#include "maps.hpp"

#include <array>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/io/png.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/similarity/agreement.hpp"

namespace gridmerge::paper {

std::vector<RobotMap> make_maps(int side) {
  constexpr double kExtent = 100.0;  // [m]
  constexpr double kRange = 20.0;    // [m]
  const Building building(20060701);
  const std::vector<std::vector<Point2>> paths{
      {{20.0, 48.0}, {38.0, 48.0}, {45.0, 55.0}, {64.0, 40.0}, {74.0, 39.7}},  // hall, and two corridors
      {{30.0, 48.0}, {45.0, 40.0}, {62.0, 42.0}, {84.0, 39.7}},                // the same, more to the east
      {{92.0, 39.7}, {68.0, 39.7}, {60.0, 46.0}, {58.0, 58.0}, {58.0, 90.0}},  // east, hall, north
      {{41.5, 8.0}, {41.5, 28.4}},                 // south corridor, with a glance into the hall
      {{58.0, 90.0}, {58.0, 58.0}, {50.0, 50.0}},  // north corridor and hall
      {{92.0, 39.7},
       {64.0, 39.7},
       {44.0, 40.0},
       {41.5, 34.0},
       {41.5, 10.0}},  // east and south corridors, hall
  };
  std::vector<RobotMap> maps;
  for (std::size_t i = 0; i < paths.size(); ++i)
    maps.push_back(explore(building, paths[i], kRange, side, kExtent / side, 100 + i));
  return maps;
}

SharedCells measure_shared(const Pair& pair) {
  const AgreementCounts counts = count_agreement(pair.fixed->map, pair.moving->map, pair.truth());
  const auto share = [&](const OccupancyGrid& map) {
    return static_cast<double>(counts.both_known()) / static_cast<double>(count_cells(map).known());
  };
  return {share(pair.fixed->map), share(pair.moving->map)};
}

std::string draw(const OccupancyGrid& map) {
  const OccupancyGrid known = crop_to_known(map);
  constexpr std::array<std::array<std::uint8_t, 3>, 3> kColours{
      {{255, 255, 255}, {0, 158, 96}, {204, 32, 32}}};
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

std::string draw_merged(const Pair& pair, const SE2& T_fixed_moving) {
  return draw(
      fuse({{&pair.fixed->map, {}}, {&pair.moving->map, T_fixed_moving}}, pair.fixed->map.resolution).grid);
}

}  // namespace gridmerge::paper
