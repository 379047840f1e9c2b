// SPDX-License-Identifier: Apache-2.0
#include "merge/pair_looks.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace gridmerge::internal {

namespace {

/// What the first look found at so many pairs is kept for the second one: some 1.5 kB each. The others'
/// second look begins anew.
constexpr std::size_t kMostFound = 20000;

}  // namespace

PairLooks::PairLooks(MatchOptions options) : options_(std::move(options)) {}

std::vector<PairLooks::Pair> PairLooks::choose_pairs(const std::vector<MapId>& maps) {
  std::vector<Pair> pairs;
  for (auto a = maps.begin(); a != maps.end(); ++a) {
    for (auto b = std::next(a); b != maps.end(); ++b) pairs.emplace_back(*a, *b);
  }
  return pairs;
}

MatchOptions PairLooks::match_options(SearchMethod search) const {
  MatchOptions options = options_;
  options.search = search;
  return options;
}

std::vector<PairLooks::Pair> PairLooks::due_for_the_first_look(std::vector<Pair> pairs) const {
  std::erase_if(pairs, [&](const Pair& pair) { return first_.is_up_to_date(pair.first, pair.second); });
  return pairs;
}

std::vector<PairLooks::Pair> PairLooks::due_for_a_second_look(std::vector<Pair> pairs) const {
  std::erase_if(pairs, [&](const Pair& pair) { return second_.is_up_to_date(pair.first, pair.second); });
  std::stable_sort(pairs.begin(), pairs.end(), [&](const Pair& a, const Pair& b) {
    const auto key = [&](const Pair& pair) {
      return std::pair(second_.holds(pair.first, pair.second),
                       -first_.between(pair.first, pair.second).probability);
    };
    return key(a) < key(b);
  });
  return pairs;
}

void PairLooks::look(const std::vector<Pair>& pairs, const MapStore& maps, const Progress& progress) {
  const MatchOptions options = match_options(first_search());
  const auto make = [&](const Pair& pair) {
    const PreparedMap &fixed = maps.at(pair.first).prepared, &moving = maps.at(pair.second).prepared;
    if (!looks_twice()) return match(fixed, moving, options);
    QuickMatch quick = match_quickly(fixed, moving, options);
    const std::lock_guard lock(keeping_);
    if (found_.size() < kMostFound) found_[std::minmax(pair.first, pair.second)] = std::move(quick.found);
    return std::move(quick.result);
  };
  first_.add(pairs, make, progress);
}

void PairLooks::look_again(const std::vector<Pair>& pairs, const MapStore& maps, const Progress& progress) {
  const MatchOptions options = match_options(second_search());
  const auto make = [&](const Pair& pair) {
    const PreparedMap &fixed = maps.at(pair.first).prepared, &moving = maps.at(pair.second).prepared;
    const std::optional<QuickLook> found = take_found(pair);
    return found ? match_again(fixed, moving, options, *found) : match(fixed, moving, options);
  };
  second_.add(pairs, make, progress);
}

std::optional<QuickLook> PairLooks::take_found(const Pair& pair) {
  const std::lock_guard lock(keeping_);
  auto found = found_.extract(std::minmax(pair.first, pair.second));
  return found ? std::optional(std::move(found.mapped())) : std::nullopt;
}

void PairLooks::forget_found(MapId id) {
  std::erase_if(found_,
                [&](const auto& found) { return found.first.first == id || found.first.second == id; });
}

void PairLooks::hand_in(const Pair& pair, SearchMethod search, MatchResult match) {
  if (search == first_search()) {
    first_.keep(pair, std::move(match));
  } else if (looks_twice() && search == second_search()) {
    second_.keep(pair, std::move(match));
  } else {
    throw std::invalid_argument(std::string("no match by the ") + name_of(search) + " search is due");
  }
}

std::vector<std::pair<DueMatch, MatchResult>> PairLooks::matches() const {
  std::vector<std::pair<DueMatch, MatchResult>> matches;
  const auto add = [&](const PairMatches& made, SearchMethod search) {
    made.for_each([&](const Pair& pair, const MatchResult& match) {
      matches.emplace_back(DueMatch{pair.first, pair.second, search}, match);
    });
  };
  add(first_, first_search());
  if (looks_twice()) add(second_, second_search());
  return matches;
}

std::set<PairLooks::Pair> PairLooks::seen_again(const std::vector<Pair>& pairs) const {
  std::set<Pair> again;
  for (const Pair& pair : pairs) {
    if (second_.holds(pair.first, pair.second)) again.insert(std::minmax(pair.first, pair.second));
  }
  return again;
}

MatchResult PairLooks::between(MapId fixed, MapId moving, const std::set<Pair>& again) const {
  return (again.contains(std::minmax(fixed, moving)) ? second_ : first_).between(fixed, moving);
}

void PairLooks::outdate(MapId id) {
  first_.outdate(id);
  second_.outdate(id);
  forget_found(id);
}

void PairLooks::forget(MapId id) {
  first_.forget(id);
  second_.forget(id);
  forget_found(id);
}

}  // namespace gridmerge::internal
