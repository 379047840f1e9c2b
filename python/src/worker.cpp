// SPDX-License-Identifier: Apache-2.0
#include "worker.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "gridmerge/grid/cancellation.hpp"

namespace gridmerge::python {

namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(50);

class Worker {
 public:
  explicit Worker(const std::function<void(const Report&)>& work)
      : thread_([this, &work] {
          try {
            with_cancellation(cancelled_, [&] { work([this](double share) { share_ = share; }); });
          } catch (...) {
            failure_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          ended_ = true;
          end_.notify_all();
        }) {}

  ~Worker() {
    cancelled_ = true;
    const nb::gil_scoped_release others_may_run;
    thread_.join();
  }

  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Whether the work has ended, after waiting a moment for it.
  bool wait_a_moment() {
    const nb::gil_scoped_release others_may_run;
    std::unique_lock lock(mutex_);
    return end_.wait_for(lock, kLookEvery, [this] { return ended_; });
  }

  double share() const { return share_; }

  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  std::atomic<bool> cancelled_{false};
  std::atomic<double> share_{0.0};
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // the last: it uses the others
};

}  // namespace

void run_in_worker(const nb::object& progress, const std::function<void(const Report&)>& work) {
  Worker worker(work);
  double told = 0.0;
  while (!worker.wait_a_moment()) {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    const double share = worker.share();
    if (progress.is_none() || share == told) continue;
    told = share;
    progress(share);
  }
  worker.rethrow_failure();
  if (!progress.is_none()) progress(1.0);
}

}  // namespace gridmerge::python
