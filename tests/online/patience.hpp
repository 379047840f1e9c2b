// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "gridmerge/online/team.hpp"

namespace gridmerge::test {

/// How long a test waits for a team: none fails because a machine is slow.
inline constexpr std::chrono::seconds kLong{600};

/// Of a team that finds out all at once.
inline TeamOptions impatient() {
  TeamOptions options;
  options.quiet = std::chrono::milliseconds(0);
  return options;
}

}  // namespace gridmerge::test
