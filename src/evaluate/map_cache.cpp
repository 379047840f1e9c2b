// SPDX-License-Identifier: Apache-2.0
#include "evaluate/map_cache.hpp"

#include <algorithm>

#include "gridmerge/bag/bag.hpp"

namespace gridmerge::internal {

namespace {
std::size_t size_in_bytes(const EvaluatedMap& map) {
  return map.grid.cells.size() * sizeof(Cell) + map.grid.probability.size() * sizeof(float);
}
}  // namespace

MapCache::MapCache(const LoadOptions& load, std::size_t max_bytes,
                   std::function<void(const std::string&)> warn)
    : load_(load), max_bytes_(max_bytes), warn_(std::move(warn)) {}

std::shared_ptr<const EvaluatedMap> MapCache::get(const std::filesystem::path& path) {
  // A handful of maps fit, so a list that is walked is all it takes.
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.first == path; });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
    return entries_.front().second;
  }
  auto map = std::make_shared<const EvaluatedMap>(read(path));
  entries_.emplace_front(path, map);
  bytes_ += size_in_bytes(*map);
  while (bytes_ > max_bytes_) {
    bytes_ -= size_in_bytes(*entries_.back().second);
    entries_.pop_back();
  }
  return map;
}

EvaluatedMap MapCache::read(const std::filesystem::path& path) {
  LoadedMap loaded = load_any_map(path, load_);
  if (warn_ && !loaded.warnings.empty() && warned_.insert(path).second) {
    for (const MapWarning& warning : loaded.warnings) warn_(path.string() + ": " + warning.text);
  }
  const KnownMoments moments = known_moments(loaded.grid);
  return {std::move(loaded.grid), moments};
}

}  // namespace gridmerge::internal
