// SPDX-License-Identifier: Apache-2.0
// Merges the map files named on the command line and says where each of them lies.
#include <cstdio>
#include <exception>
#include <vector>

#include "gridmerge/io/map_file.hpp"
#include "gridmerge/merge/merge.hpp"

int main(int argc, char** argv) try {
  std::vector<gridmerge::OccupancyGrid> maps;
  for (int i = 1; i < argc; ++i) maps.push_back(gridmerge::load_map(argv[i]).grid);

  const gridmerge::MergeResult result = gridmerge::merge(maps);

  for (const gridmerge::Component& component : result.components) {
    std::printf("one map of %zu inputs, %d x %d cells\n", component.members.size(),
                component.fused.grid.width, component.fused.grid.height);
    for (const gridmerge::Member& member : component.members) {
      const gridmerge::SE2& T = member.T_component_map;
      std::printf("  %s at x %.2f m, y %.2f m, %.2f rad\n", argv[member.map + 1], T.x, T.y, T.theta);
    }
  }
  for (const gridmerge::LeftOut& one : result.left_out) std::printf("left out: %s\n", argv[one.map + 1]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "merge_maps: %s\n", error.what());
  return 1;
}
