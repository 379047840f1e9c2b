// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace gridmerge::test {

/// So many seconds the clock that says the time of day is off, for the whole program. Clocks that measure how
/// long something takes are not.
extern std::atomic<long> clock_is_off_by;

}  // namespace gridmerge::test
