// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>
#include <functional>

namespace gridmerge::cli {

/// Runs the work of a command, and returns what it does. Ctrl-C (SIGINT), SIGTERM and SIGHUP cancel it, so
/// that it takes away files that are half written; the program ends by that signal then, as who sent it
/// expects. A second signal ends it at once. One that the program was started to ignore is ignored.
int run_interruptibly(const std::function<int()>& work);

/// Waits for Ctrl-C (SIGINT), SIGTERM or SIGHUP. While it lives, the first of these does not end the program;
/// a second one does, the same or another. Its end gives back to the others what they did before. One at a
/// time.
class Interrupt {
 public:
  /// Throws std::runtime_error when the system denies it.
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Returns once a signal has come, or raise() was called.
  void wait() const;
  /// From any thread.
  void raise() const;

 private:
  /// What the signals did before, in the order of the list that interrupt.cpp has.
  std::array<struct sigaction, 3> before_{};
  int read_end_ = -1;
};

}  // namespace gridmerge::cli
