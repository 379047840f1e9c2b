// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <gridmerge/cache/match_cache.hpp>

int main() {
  const std::filesystem::path directory = std::filesystem::temp_directory_path() / "gridmerge-consumer";
  gridmerge::MatchCache cache(directory);
  gridmerge::Merger merger;
  merger.add(gridmerge::make_grid(8, 8, 0.1));
  const gridmerge::MatchWork work = gridmerge::match_with_cache(merger, cache);
  std::filesystem::remove_all(directory);
  return work.made + work.missing == 0 ? 0 : 1;
}
