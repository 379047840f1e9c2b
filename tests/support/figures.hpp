// SPDX-License-Identifier: Apache-2.0
// Tables of figures that are pinned: what a room says of a few inputs. Such a table notices a change of most
// constants and signs that it depends on, wanted or not. Where a change is wanted, GRIDMERGE_WRITE_FIGURES=1
// in the environment makes the test write its table anew; the table's difference shows what changed.
#pragma once

#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge::test {

struct Figure {
  std::string name;
  double value;
};

using Figures = std::vector<Figure>;

/// A line of a table: what its figures are of, and the figures.
struct FigureLine {
  std::string name;
  Figures figures;
};

/// Expects these lines in the file, in this order and no others. Whole numbers are equal; others differ by a
/// millionth at most, because sines and logarithms differ in their last bits between processors.
void expect_figures(const std::string& path, const std::vector<FigureLine>& lines);

/// Those of a pose, then these.
Figures with_pose(const SE2& T, const Figures& others);

/// Size, place, and sums over the cells in which their values and places are. `grid` has probabilities.
Figures figures_of(const OccupancyGrid& grid);

}  // namespace gridmerge::test
