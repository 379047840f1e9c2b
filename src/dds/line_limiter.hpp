// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace gridmerge::internal {

/// Writes lines, and keeps those that are alike from flooding: what peers do decides how many there are.
class LineLimiter {
 public:
  using Clock = std::chrono::steady_clock;

  /// Of each kind, `at_once` lines are written. What follows within kWindow is counted.
  LineLimiter(std::size_t at_once, std::function<void(const std::string&)> write);

  /// A line that stands for `count` of its kind.
  void write(const std::string& kind, const std::string& line, Clock::time_point now,
             std::uint64_t count = 1);

  /// Writes how many more there were, where a window is over. To be called now and then.
  void tell_more(Clock::time_point now);

  static constexpr std::chrono::seconds kWindow{60};
  /// Further kinds count as one.
  static constexpr std::size_t kMaxKinds = 1024;

 private:
  struct Kind {
    Clock::time_point began;
    std::size_t written = 0;
    std::uint64_t untold = 0;
    std::string last;
  };

  std::size_t at_once_;
  std::function<void(const std::string&)> write_;
  std::map<std::string, Kind> kinds_;
};

/// What lines have in common that differ in numbers, addresses and the like: their first words without any.
std::string kind_of_line(const std::string& line);

}  // namespace gridmerge::internal
