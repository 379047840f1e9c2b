// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::cli {

/// "a.yaml (400 x 300 cells)".
std::string describe_size(const std::string& name, const OccupancyGrid& map);

/// The size of the largest of the maps, and how many there are.
std::string describe_sizes(const std::vector<std::string>& names, const std::vector<OccupancyGrid>& maps);

/// Calls `work`. Where memory runs out, throws std::runtime_error with what `describe` says: a text behind
/// "out of memory".
template <typename Work, typename Describe>
auto with_scarce_memory(const Work& work, const Describe& describe) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("out of memory " + describe());
  }
}

}  // namespace gridmerge::cli
