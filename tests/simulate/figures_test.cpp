// SPDX-License-Identifier: Apache-2.0
// What robots bring home from each kind of building: the same options give the same maps in every version,
// unless a change is wanted, so that figures of the documentation can be made again.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge {
namespace {

using test::FigureLine;

TEST(Figures, OfEachKindOfBuilding) {
  std::vector<FigureLine> lines;
  for (const BuildingKind kind : building_kinds()) {
    SimulateOptions options;
    options.kind = kind;
    options.width = 22.0;
    options.height = 16.0;
    options.robots = 2;
    options.resolution = 0.1;
    options.seed = 9;
    const Simulation simulation = simulate(options);
    for (std::size_t i = 0; i < simulation.maps.size(); ++i) {
      const SimulatedMap& map = simulation.maps[i];
      const OccupancyGrid& grid = map.grid;
      double occupied = 0.0, free = 0.0, places = 0.0, probability = 0.0;
      for (int row = 0; row < grid.height; ++row) {
        for (int column = 0; column < grid.width; ++column) {
          const Cell cell = grid.at(column, row);
          if (cell == Cell::unknown) continue;
          (cell == Cell::occupied ? occupied : free) += 1.0;
          if (cell == Cell::occupied) places += 3.0 * row + column;
          probability += grid.probability[grid.index(column, row)];
        }
      }
      const SE2& T = map.T_building_map;
      lines.push_back({std::string(name_of(kind)) + ", map " + std::to_string(i),
                       {static_cast<double>(grid.width), static_cast<double>(grid.height), grid.origin.x,
                        grid.origin.y, occupied, free, places, probability, T.x, T.y, T.theta, map.bend,
                        static_cast<double>(map.path.size())}});
    }
    for (const SimulatedPair& pair : simulation.pairs) {
      const SE2& T = pair.T_fixed_moving;
      lines.push_back({std::string(name_of(kind)) + ", pair",
                       {T.x, T.y, T.theta, pair.tolerance, pair.overlap, pair.shared_wall,
                        static_cast<double>(pair.tier)}});
    }
  }
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge
