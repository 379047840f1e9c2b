// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "evaluate/known_moments.hpp"
#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge::internal {

struct EvaluatedMap {
  OccupancyGrid grid;
  KnownMoments moments;
};

/// Reads maps once and keeps those used last, as far as they fit.
class MapCache {
 public:
  MapCache(const LoadOptions& load, std::size_t max_bytes, std::function<void(const std::string&)> warn);

  /// The map, from memory if it is there. It lives on with its user when the cache drops it. Throws
  /// FileError.
  std::shared_ptr<const EvaluatedMap> get(const std::filesystem::path& path);

  /// The map, to keep: it is not put into the cache. Throws FileError.
  EvaluatedMap read(const std::filesystem::path& path);

  std::size_t bytes() const { return bytes_; }

 private:
  using Entry = std::pair<std::filesystem::path, std::shared_ptr<const EvaluatedMap>>;

  LoadOptions load_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::list<Entry> entries_;  ///< used last first
  std::set<std::filesystem::path> warned_;
  std::function<void(const std::string&)> warn_;
};

}  // namespace gridmerge::internal
