// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::cli {

/// In the order of a page that shows them.
using ShownMaps = std::vector<std::shared_ptr<const OccupancyGrid>>;

/// The best fit near where a page lays a map, as it asks for with the body of a request, in JSON. `maps_of`
/// has the maps of the merge that the page names, and throws OtherMerge where it is not served. Throws that
/// too, and std::invalid_argument for a body that makes no sense. May be cancelled.
std::string answer_refine(const std::string& body,
                          const std::function<ShownMaps(const std::string& merge)>& maps_of, int threads);

}  // namespace gridmerge::cli
