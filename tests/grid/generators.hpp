// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rapidcheck.h>

#include <numbers>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// A number in [low, high], in steps of a 2^-20th of the range.
inline rc::Gen<double> between(double low, double high) {
  constexpr int kSteps = 1 << 20;
  return rc::gen::map(rc::gen::inRange(0, kSteps + 1),
                      [=](int step) { return low + (high - low) * step / static_cast<double>(kSteps); });
}

inline rc::Gen<SE2> any_pose() {
  return rc::gen::build<SE2>(rc::gen::set(&SE2::x, between(-100.0, 100.0)),
                             rc::gen::set(&SE2::y, between(-100.0, 100.0)),
                             rc::gen::set(&SE2::theta, between(-3.14, std::numbers::pi)));
}

/// A small grid of any cells at any pose; unknown cells are common, so that there is something to crop.
inline rc::Gen<OccupancyGrid> any_grid() {
  return rc::gen::exec([] {
    OccupancyGrid grid =
        make_grid(*rc::gen::inRange(1, 13), *rc::gen::inRange(1, 13), *between(0.01, 2.0), *any_pose());
    const auto any_cell =
        rc::gen::weightedElement<Cell>({{4, Cell::unknown}, {1, Cell::free}, {1, Cell::occupied}});
    grid.cells = *rc::gen::container<std::vector<Cell>>(grid.cells.size(), any_cell);
    return grid;
  });
}

}  // namespace gridmerge

namespace rc {
template <>
struct Arbitrary<gridmerge::SE2> {
  static Gen<gridmerge::SE2> arbitrary() { return gridmerge::any_pose(); }
};
template <>
struct Arbitrary<gridmerge::OccupancyGrid> {
  static Gen<gridmerge::OccupancyGrid> arbitrary() { return gridmerge::any_grid(); }
};
}  // namespace rc
