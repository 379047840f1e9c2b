// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/maps_left_out.hpp"
#include "support/building.hpp"

namespace gridmerge::test {

/// Robots that each saw a part of one building, 18 m x 13 m, from frames of their own; the last map is of
/// another building.
struct Team {
  Team() {
    const OccupancyGrid building = draw_building(1);
    const std::vector<Window> windows{{0, 0, 11, 13}, {5, 0, 18, 13}, {0, 4, 18, 13}, {0, 0, 18, 8}};
    for (std::size_t i = 0; i < windows.size(); ++i) {
      T_map_building.push_back({3.0 * static_cast<double>(i), -2.0, 0.7 * static_cast<double>(i) - 1.0});
      maps.push_back(map_part(building, windows[i], T_map_building.back()));
    }
    maps.push_back(draw_building(2));
  }

  SE2 T(std::size_t fixed, std::size_t moving) const {
    return T_map_building[fixed] * inverse(T_map_building[moving]);
  }

  /// All but the last in one component, where they belong.
  void expect_merged(const MergeResult& result, double tolerance = 0.1) const {
    ASSERT_EQ(result.components.size(), 1u);
    const std::vector<Member>& members = result.components[0].members;
    ASSERT_EQ(members.size(), 4u);
    const SE2 T_frame_first = members[0].T_component_map;
    for (const Member& member : members) {
      const SE2 found = inverse(T_frame_first) * member.T_component_map;
      const SE2 expected = T(members[0].map, member.map);
      EXPECT_NEAR(found.x, expected.x, tolerance);
      EXPECT_NEAR(found.y, expected.y, tolerance);
      EXPECT_NEAR(normalize_angle(found.theta - expected.theta), 0.0, 0.02);
    }
    EXPECT_EQ(maps_left_out(result), std::vector<std::size_t>{4});
  }

  std::vector<OccupancyGrid> maps;
  std::vector<SE2> T_map_building;
};

inline void expect_same(const MergeResult& a, const MergeResult& b) {
  ASSERT_EQ(a.components.size(), b.components.size());
  for (std::size_t i = 0; i < a.components.size(); ++i) {
    ASSERT_EQ(a.components[i].members.size(), b.components[i].members.size());
    for (std::size_t k = 0; k < a.components[i].members.size(); ++k) {
      const Member &one = a.components[i].members[k], &two = b.components[i].members[k];
      EXPECT_EQ(one.map, two.map);
      EXPECT_EQ(one.T_component_map, two.T_component_map);
      EXPECT_EQ(one.probability, two.probability);
    }
    EXPECT_EQ(a.components[i].fused.grid.cells, b.components[i].fused.grid.cells);
  }
  ASSERT_EQ(a.joins.size(), b.joins.size());
  for (std::size_t i = 0; i < a.joins.size(); ++i) {
    EXPECT_EQ(a.joins[i].outcome, b.joins[i].outcome);
    EXPECT_EQ(a.joins[i].T_fixed_moving, b.joins[i].T_fixed_moving);
  }
  EXPECT_EQ(a.left_out, b.left_out);
}

}  // namespace gridmerge::test
