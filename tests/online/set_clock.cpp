// SPDX-License-Identifier: Apache-2.0
#include "set_clock.hpp"

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

namespace gridmerge::test {

std::atomic<long> clock_is_off_by{0};

}  // namespace gridmerge::test

// In the place of the system's, for the whole program: libraries have to see it as well.
extern "C" __attribute__((visibility("default"))) int clock_gettime(clockid_t clock,
                                                                    timespec* time) noexcept {
  const int result = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += gridmerge::test::clock_is_off_by;
  return result;
}
