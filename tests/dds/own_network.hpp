// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace gridmerge::test {

/// Runs this in a thread that has a network of its own, as programs that it starts have. There is the
/// loopback interface alone, and it is down. False, and nothing is run, where the system denies such a
/// network.
bool in_own_network(const std::function<void()>& body);

/// Sets the loopback interface of the thread's network up or down. Throws std::runtime_error.
void set_loopback(bool up);

}  // namespace gridmerge::test
