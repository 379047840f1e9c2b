// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace gridmerge::test {

/// So many seconds the clock that says the time of day is off, for the whole program. Clocks that measure how
/// long something takes are not.
extern std::atomic<long> clock_is_off_by;

/// Sets that clock while it exists.
class SetClock {
 public:
  explicit SetClock(long seconds) { clock_is_off_by = seconds; }
  ~SetClock() { clock_is_off_by = 0; }
  SetClock(const SetClock&) = delete;
  SetClock& operator=(const SetClock&) = delete;
};

}  // namespace gridmerge::test
