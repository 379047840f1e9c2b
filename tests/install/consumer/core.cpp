// SPDX-License-Identifier: Apache-2.0
#include <gridmerge/gridmerge.hpp>

int main() {
  gridmerge::OccupancyGrid map = gridmerge::make_grid(40, 30, 0.1, {}, gridmerge::Cell::free);
  for (int column = 0; column < map.width; ++column) map.at(column, 0) = gridmerge::Cell::occupied;
  const gridmerge::MatchResult result = gridmerge::match(map, map);
  return result.verdict == gridmerge::Verdict::refused ? 0 : 1;  // one wall holds nothing
}
