// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gridmerge/match/match.hpp"

namespace gridmerge::cli {

/// A map and what to call it.
struct NamedMap {
  std::string name;
  const OccupancyGrid& grid;
};

/// A line for people if a map, which does not fit, is a plan and not what a robot has made, with what helps
/// then; "" if not. O(cells).
std::string plan_hint(const NamedMap& map, const std::string& what_helps);

/// A line for people if the maps, which do not fit, do at another scale; "" if not. As long as find_scale().
std::string scale_hint(const NamedMap& fixed, const NamedMap& moving, const MatchOptions& options);

/// A line for people if a map and a plan, which do not fit at any of these scales, are of such sizes that
/// other ones are likely, with the range that `option` should have; "" if not, or if not one of the two is a
/// drawing. O(cells).
std::string range_hint(const NamedMap& fixed, const NamedMap& moving, const ScaleRange& scales,
                       const std::string& option);

}  // namespace gridmerge::cli
