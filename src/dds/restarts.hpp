// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>

namespace gridmerge::internal {

/// How often a robot started anew. No robot does so again and again: two robots on one topic look so.
class Restarts {
 public:
  using Clock = std::chrono::steady_clock;

  void count(Clock::time_point now) {
    ++total_;
    lately_.push_back(now);
    if (lately_.size() > kMany) lately_.pop_front();
  }

  std::uint64_t total() const { return total_; }
  /// Whether the last kMany were all within a minute before.
  bool are_many(Clock::time_point now) const {
    return lately_.size() == kMany && now - lately_.front() < std::chrono::minutes(1);
  }

  static constexpr std::size_t kMany = 4;

 private:
  std::uint64_t total_ = 0;
  std::deque<Clock::time_point> lately_;
};

}  // namespace gridmerge::internal
