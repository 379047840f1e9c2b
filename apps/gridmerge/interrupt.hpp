// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridmerge::cli {

/// Waits for Ctrl-C (SIGINT) or SIGTERM. While it lives, the first of these does not end the program; a
/// second one does, the same or the other. One at a time.
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
  int read_end_ = -1;
};

}  // namespace gridmerge::cli
