// SPDX-License-Identifier: Apache-2.0
#include "merge/pair_matches.hpp"

#include <algorithm>
#include <mutex>

#include "grid/parallel.hpp"

namespace gridmerge::internal {

namespace {

PairMatches::Pair key_of(const PairMatches::Pair& pair) {
  return std::minmax(pair.first, pair.second);
}

}  // namespace

void PairMatches::add(std::vector<Pair> pairs, const Make& make, const Progress& progress) {
  std::erase_if(pairs, [&](const Pair& pair) { return is_up_to_date(pair.first, pair.second); });
  std::mutex keeping;
  std::size_t done = 0;
  parallel_tasks(pairs.size(), [&](std::size_t i) {
    MatchResult result = make(pairs[i]);
    const std::lock_guard lock(keeping);
    keep(pairs[i], std::move(result));
    ++done;
    if (progress) progress(done, pairs.size());
  });
}

void PairMatches::keep(const Pair& pair, MatchResult match) {
  made_[key_of(pair)] = {pair.first, std::move(match)};
}

bool PairMatches::holds(MapId a, MapId b) const {
  return made_.contains(key_of({a, b}));
}

bool PairMatches::is_up_to_date(MapId a, MapId b) const {
  const auto made = made_.find(key_of({a, b}));
  return made != made_.end() && !made->second.is_outdated;
}

MatchResult PairMatches::between(MapId fixed, MapId moving) const {
  const Made& made = made_.at(key_of({fixed, moving}));
  return made.fixed == fixed ? made.match : inverse(made.match);
}

void PairMatches::for_each(const std::function<void(const Pair&, const MatchResult&)>& take) const {
  for (const auto& [pair, made] : made_) {
    if (!made.is_outdated) take(made.fixed == pair.first ? pair : Pair(pair.second, pair.first), made.match);
  }
}

void PairMatches::outdate(MapId id) {
  for (auto& [pair, made] : made_) {
    if (pair.first == id || pair.second == id) made.is_outdated = true;
  }
}

void PairMatches::forget(MapId id) {
  std::erase_if(made_, [&](const auto& made) { return made.first.first == id || made.first.second == id; });
}

}  // namespace gridmerge::internal
