// SPDX-License-Identifier: Apache-2.0
// Tables of figures that are pinned: what a room says of a few inputs, to the last digits. Such a table
// notices a change of any constant or sign that it depends on, wanted or not. Where a change is wanted, the
// environment variable GRIDMERGE_WRITE_FIGURES=1 makes the test write its table anew; its difference shows
// what changed.
#pragma once

#include <string>
#include <vector>

namespace gridmerge::test {

/// A line of a table.
struct FigureLine {
  std::string name;  ///< what the figures are of
  std::vector<double> figures;
};

/// Expects these lines in the file, in this order and no others, with figures that differ by a millionth at
/// most: sines and logarithms differ in their last bits between processors.
void expect_figures(const std::string& path, const std::vector<FigureLine>& lines);

}  // namespace gridmerge::test
