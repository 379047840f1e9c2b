// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <tuple>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::cli {

namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};

// A signal handler can reach nothing but globals, and may do little more than write.
std::atomic<int> write_end{-1};
std::atomic<int> received{0};
std::atomic<bool> cancelled{false};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void wake() {
  const char byte = 0;
  [[maybe_unused]] const ssize_t written = ::write(write_end, &byte, 1);
}

void handle(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  ::sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) ::sigaddset(&action.sa_mask, signal);
  for (const int signal : kSignals) {
    struct sigaction before {};
    const bool is_ignored = ::sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN;
    if (!is_ignored) ::sigaction(signal, &action, nullptr);
  }
}

void on_signal(int /*signal*/) {
  const int before = errno;
  handle(SIG_DFL, 0);  // of the other signals too: whichever is the second ends the program
  wake();
  errno = before;
}

void cancel(int signal) {
  const int before = errno;
  handle(SIG_DFL, 0);
  received = signal;
  cancelled = true;
  errno = before;
}

/// Whatever the work has come to since, it is the signal that ended it.
void end_if_received() {
  if (received != 0) ::raise(received);
}

}  // namespace

int run_interruptibly(const std::function<int()>& work) {
  handle(cancel, 0);  // without SA_RESTART: a read that waits has to end
  int result = 0;
  try {
    with_cancellation(cancelled, [&] { result = work(); });
  } catch (...) {
    end_if_received();
    throw;
  }
  end_if_received();
  return result;
}

Interrupt::Interrupt() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe to wait for signals");
  read_end_ = ends[0];
  write_end = ends[1];
  static_assert(std::tuple_size_v<decltype(before_)> == kSignals.size());
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], nullptr, &before_[i]);
  handle(on_signal, SA_RESTART);
}

Interrupt::~Interrupt() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction now {};
    // After a first signal, the next one is to end the program still.
    if (::sigaction(kSignals[i], nullptr, &now) == 0 && now.sa_handler == on_signal)
      ::sigaction(kSignals[i], &before_[i], nullptr);
  }
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
