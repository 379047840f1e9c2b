// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::cli {

/// The best fit near where a page lays a map, as it asks for with the body of a request, in JSON. Of `maps`
/// maps `map(i)` is one. Throws std::invalid_argument for a body that makes no sense. May be cancelled.
std::string answer_refine(const std::string& body, std::size_t maps,
                          const std::function<const OccupancyGrid&(std::size_t)>& map, int threads);

}  // namespace gridmerge::cli
