// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridmerge/match/match.hpp"

namespace gridmerge::cli {

/// A map and what to call it.
struct NamedMap {
  std::string name;
  const OccupancyGrid& grid;
};

/// A line for people if one of the maps, which do not fit, is a plan and not what a robot has made; "" if
/// not.
std::string plan_hint(const std::vector<NamedMap>& maps);

/// A line for people if the maps, which do not fit, do at another scale; "" if not. As long as find_scale().
std::string scale_hint(const NamedMap& fixed, const NamedMap& moving, const MatchOptions& options);

}  // namespace gridmerge::cli
