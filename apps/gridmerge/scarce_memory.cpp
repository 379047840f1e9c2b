// SPDX-License-Identifier: Apache-2.0
#include "scarce_memory.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gridmerge::cli {

std::string describe_size(const std::string& name, const OccupancyGrid& map) {
  return fmt::format("{} ({} x {} cells)", name, map.width, map.height);
}

std::string describe_sizes(const std::vector<std::string>& names, const std::vector<OccupancyGrid>& maps) {
  const auto largest = std::max_element(
      maps.begin(), maps.end(), [](const auto& a, const auto& b) { return a.cells.size() < b.cells.size(); });
  return fmt::format("{} maps, the largest of which is {}", maps.size(),
                     describe_size(names[static_cast<std::size_t>(largest - maps.begin())], *largest));
}

}  // namespace gridmerge::cli
