// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace gridmerge::cli {

namespace {

constexpr std::array kSignals{SIGINT, SIGTERM};

// A signal handler can reach nothing but a global, and may do little more than write.
std::atomic<int> write_end{-1};

void wake() {
  const char byte = 0;
  [[maybe_unused]] const ssize_t written = ::write(write_end, &byte, 1);
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) ::sigaddset(&action.sa_mask, signal);
  for (const int signal : kSignals) ::sigaction(signal, &action, nullptr);
}

void on_signal(int /*signal*/) {
  const int before = errno;
  handle(SIG_DFL);  // of the other signals too: whichever is the second ends the program
  wake();
  errno = before;
}

}  // namespace

Interrupt::Interrupt() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe to wait for signals");
  read_end_ = ends[0];
  write_end = ends[1];
  handle(on_signal);
}

Interrupt::~Interrupt() {
  handle(SIG_DFL);
  ::close(write_end.exchange(-1));
  ::close(read_end_);
}

void Interrupt::wait() const {
  char byte = 0;
  while (::read(read_end_, &byte, 1) < 0 && errno == EINTR) {
  }
}

void Interrupt::raise() const {
  wake();
}

}  // namespace gridmerge::cli
