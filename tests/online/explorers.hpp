// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "support/building.hpp"

namespace gridmerge::test {

/// Three robots that explore one building, 18 m x 13 m, from frames of their own, and one that explores
/// another building.
class Explorers {
 public:
  static constexpr int kSteps = 5;

  /// The map of a robot (0 to 3) after `step` of kSteps parts of its way: ever wider windows.
  OccupancyGrid map(int robot, int step) const {
    const double share = static_cast<double>(step) / kSteps;
    const Window windows[] = {
        {0, 0, 3 + 9 * share, 13}, {13 - 8 * share, 0, 18, 13}, {0, 10 - 6 * share, 18, 13}};
    if (robot == 3) return map_part(stranger_, {0, 0, 4 + 14 * share, 13}, {});
    return map_part(building_, windows[robot], T_map_building(robot));
  }

  SE2 T_map_building(int robot) const { return {3.0 * robot, -2.0, 0.7 * robot - 1.0}; }

  /// From the second robot's frame to the first one's.
  SE2 between(int first, int second) const { return T_map_building(first) * inverse(T_map_building(second)); }

 private:
  OccupancyGrid building_ = draw_building(1), stranger_ = draw_building(2);
};

}  // namespace gridmerge::test
