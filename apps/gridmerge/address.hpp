// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace gridmerge::cli {

/// An internet address, of either version.
struct Address {
  std::string number;        ///< "127.0.0.1", "::1"
  bool is_any = false;       ///< stands for all that this machine has
  bool is_loopback = false;  ///< can be reached from this machine alone
};

/// What a name or a number in any spelling ("127.1", "::0") stands for, in the system's order; nothing when
/// it is unknown. May ask name servers.
std::vector<Address> resolve(const std::string& text);

}  // namespace gridmerge::cli
