// SPDX-License-Identifier: Apache-2.0
#include "merge_notices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "grid/thread_count.hpp"
#include "gridmerge/bag/bag.hpp"
#include "merge/copies.hpp"
#include "merge/pair_choice.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

std::string describe_duration(double seconds) {
  const auto whole = [](double value, const char* unit) {
    const double rounded = std::max(1.0, std::round(value));
    return fmt::format("{:.0f} {}{}", rounded, unit, rounded == 1.0 ? "" : "s");
  };
  constexpr double kMinute = 60.0, kHour = 3600.0, kDay = 86400.0;
  if (seconds < 1.5 * kMinute) return whole(seconds, "second");
  if (seconds < 1.5 * kHour) return whole(seconds / kMinute, "minute");
  return seconds < 1.5 * kDay ? whole(seconds / kHour, "hour") : whole(seconds / kDay, "day");
}

}  // namespace

void tell_of_copies(const GivenMaps& maps, const SearchOptions& search, bool is_any_fixed, Console& console) {
  std::vector<std::string> twice;   // named before
  std::vector<std::string> copies;  // of another file's cells
  std::set<MapIdentity> named;
  std::vector<CellCounts> counts;
  for (const OccupancyGrid& grid : maps.grids) counts.push_back(count_cells(grid));
  // Of those alone that may be copies.
  std::map<std::size_t, PreparedMap> prepared;
  const auto given = [&](std::size_t i) {
    return GivenMap{maps.grids[i], prepared.try_emplace(i, maps.grids[i]).first->second};
  };
  const auto is_copy = [&](std::size_t i, std::size_t j) {
    return counts[i].occupied == counts[j].occupied && counts[i].free == counts[j].free &&
           !(maps.known_poses[i] && maps.known_poses[j]) && is_given_twice(given(i), given(j));
  };
  for (std::size_t i = 0; i < maps.names.size(); ++i) {
    const std::optional<MapIdentity> identity = map_identity(maps.names[i]);
    const bool is_twice = identity && !named.insert(*identity).second;
    std::optional<std::size_t> original;
    for (std::size_t j = 0; j < i && !original && !is_twice; ++j) {
      if (is_copy(i, j)) original = j;
    }
    if (!(is_twice || original) || counts[i].known() == 0) continue;
    if (is_twice) {
      twice.push_back(maps.names[i]);
    } else {
      // Of the two that with a known pose is the original.
      const bool is_other = maps.known_poses[i].has_value();
      copies.push_back(fmt::format("{} (of {})", maps.names[is_other ? *original : i],
                                   maps.names[is_other ? i : *original]));
    }
  }
  const char* const count = search.up_the_tree() ? "each time" : "once";
  if (!twice.empty())
    console.warn(fmt::format("given twice, and counted {}: {}{}", count, fmt::join(twice, ", "),
                             is_any_fixed ? ". --fix takes one map: write it again before another" : ""));
  if (!copies.empty())
    console.warn(fmt::format("copies, which count {}: {}", count, fmt::join(copies, ", ")));
}

std::string describe_all_pairs(std::size_t maps, const MergeOptions& options, std::size_t shards,
                               const std::string& what_helps) {
  if (maps <= kFewMaps || !takes_all_pairs(maps, options.max_missed)) return {};
  const std::size_t pairs = maps * (maps - 1) / 2;
  const double one =
      options.match.search == SearchMethod::exhaustive ? kSecondsOfAPair : kSecondsOfAQuickLook;
  const int threads = thread_count(options.match.threads);
  const double seconds = static_cast<double>(pairs) * one / (static_cast<double>(shards) * threads);
  return fmt::format(
      "all {} pairs of {} maps are matched{}, which takes about {} of {}{}: {}", pairs, maps,
      options.max_missed > 0.0 ? fmt::format(", as --max-missed is not above {}", kHiddenShare) : "",
      describe_duration(seconds), threads == 1 ? "a thread" : fmt::format("{} threads", threads),
      shards == 1 ? "" : fmt::format(" for each of {} shards", shards), what_helps);
}

}  // namespace gridmerge::cli
