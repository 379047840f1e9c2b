// SPDX-License-Identifier: Apache-2.0
// What robots bring home from each kind of building: the same options give the same maps in every version,
// unless a change is wanted, so that figures of the documentation can be made again.
#include "support/figures.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge {
namespace {

using test::FigureLine;
using test::with_pose;

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
      const std::string name = std::string(name_of(kind)) + ", map " + std::to_string(i);
      lines.push_back({name, test::figures_of(map.grid)});
      lines.push_back({name + " on the building",
                       with_pose(map.T_building_map,
                                 {{"bend", map.bend}, {"scans", static_cast<double>(map.path.size())}})});
    }
    for (const SimulatedPair& pair : simulation.pairs)
      lines.push_back({std::string(name_of(kind)) + ", pair of tier " + pair.tier,
                       with_pose(pair.T_fixed_moving, {{"tolerance", pair.tolerance},
                                                       {"overlap", pair.overlap},
                                                       {"shared_wall", pair.shared_wall}})});
  }
  test::expect_figures(GRIDMERGE_TEST_DATA "/figures.tsv", lines);
}

}  // namespace
}  // namespace gridmerge
