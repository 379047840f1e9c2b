// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "gridmerge/cache/match_cache.hpp"

namespace gridmerge::python {

/// A cache that keeps what it warns of until it is asked: it may warn where no Python object may be touched.
/// One thread at a time may use it.
class Cache {
 public:
  explicit Cache(const nb::bytes& directory)
      : matches_(to_string(directory), [this](const std::string& line) { warnings_.push_back(line); }) {}
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;
  ~Cache() = default;

  MatchCache& matches() { return matches_; }

  /// How many matches it had, and how many were made.
  void count(std::size_t found, std::size_t made) {
    found_ += found;
    made_ += made;
  }
  std::pair<std::size_t, std::size_t> counted() const { return {found_, made_}; }

  std::vector<std::string> take_warnings() { return std::exchange(warnings_, {}); }

 private:
  std::size_t found_ = 0;
  std::size_t made_ = 0;
  std::vector<std::string> warnings_;
  MatchCache matches_;
};

}  // namespace gridmerge::python
