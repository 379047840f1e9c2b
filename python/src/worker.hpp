// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "bindings.hpp"

namespace gridmerge::python {

/// While it lives, its thread does without the interpreter's lock, so that other threads run. Where the
/// interpreter ends meanwhile, its end is not reached: the thread sleeps for ever, because a daemon thread
/// that asks an interpreter for its lock that has ended brings the process down. What runs meanwhile touches
/// no Python object.
class OthersRun {
 public:
  OthersRun();
  ~OthersRun();
  OthersRun(const OthersRun&) = delete;
  OthersRun& operator=(const OthersRun&) = delete;

 private:
  PyThreadState* state_;
};

/// Takes the share of the work that is done, in [0, 1], from any thread.
using Report = std::function<void(double)>;

/// Runs `work` in a thread of its own, without the interpreter's lock, while the calling thread waits. That
/// one meanwhile lets Python handle signals, and calls `progress` (None, or a function of the share) with
/// what `work` reports: about twenty times per second, and with 1.0 at the end. When a signal's handler or
/// `progress` raises, the work is cancelled, waited for, and the exception passed on. `work` touches no
/// Python object.
void run_in_worker(const nb::object& progress, const std::function<void(const Report&)>& work);

/// How often a process has been forked to become this one, since the package was loaded. A forked process has
/// none of the threads that the one before had begun: what owns some has to look.
int fork_count();

/// The same of work that has a result.
template <typename Work>
auto compute_in_worker(const nb::object& progress, Work&& work) {
  std::optional<decltype(work(Report{}))> result;
  run_in_worker(progress, [&](const Report& report) { result.emplace(work(report)); });
  return std::move(*result);
}

}  // namespace gridmerge::python
