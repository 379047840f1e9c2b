// SPDX-License-Identifier: Apache-2.0
#include "worker.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "gridmerge/grid/cancellation.hpp"

namespace gridmerge::python {

namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(50);

[[noreturn]] void sleep_for_ever() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

class Worker {
 public:
  explicit Worker(const std::function<void(const Report&)>& work);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Whether the work has ended, after waiting a moment for it.
  bool wait_a_moment();

  double share() const { return share_; }

  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  /// The interpreter is about to end: stops the work, and lets the thread that waits for it sleep, since a
  /// daemon thread that asks an interpreter for its lock that has ended brings the process down.
  void abandon() {
    abandoned_ = true;
    cancelled_ = true;
  }

  bool has_ended() {
    const std::lock_guard lock(mutex_);
    return ended_;
  }

 private:
  /// Calls `wait` without the interpreter's lock.
  template <typename Wait>
  void let_others_run(Wait&& wait) {
    const nb::gil_scoped_release released;
    wait();
    if (abandoned_) sleep_for_ever();
  }

  void run(const std::function<void(const Report&)>& work);

  std::atomic<bool> cancelled_{false};
  std::atomic<bool> abandoned_{false};
  std::atomic<double> share_{0.0};
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // the last: it uses the others
};

/// The workers there are.
class Registry {
 public:
  void add(Worker* worker) {
    const std::lock_guard lock(mutex_);
    workers_.push_back(worker);
  }

  void remove(Worker* worker) {
    const std::lock_guard lock(mutex_);
    std::erase(workers_, worker);
  }

  void abandon_all() {
    const std::lock_guard lock(mutex_);
    for (Worker* worker : workers_) worker->abandon();
  }

  bool have_all_ended() {
    const std::lock_guard lock(mutex_);
    return std::all_of(workers_.begin(), workers_.end(), [](Worker* worker) { return worker->has_ended(); });
  }

 private:
  std::mutex mutex_;
  std::vector<Worker*> workers_;
};

// Never destroyed: threads that sleep for ever may still be told of in it.
Registry& registry() {
  static auto* const one = new Registry;
  return *one;
}

Worker::Worker(const std::function<void(const Report&)>& work) : thread_([this, &work] { run(work); }) {
  registry().add(this);
}

Worker::~Worker() {
  cancelled_ = true;
  let_others_run([this] { thread_.join(); });
  registry().remove(this);
}

bool Worker::wait_a_moment() {
  bool ended = false;
  let_others_run([&] {
    std::unique_lock lock(mutex_);
    ended = end_.wait_for(lock, kLookEvery, [this] { return ended_; });
  });
  return ended;
}

void Worker::run(const std::function<void(const Report&)>& work) {
  try {
    with_cancellation(cancelled_, [&] { work([this](double share) { share_ = share; }); });
  } catch (...) {
    failure_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  ended_ = true;
  end_.notify_all();
}

void stop_all_work() {
  const nb::gil_scoped_release others_may_run;
  registry().abandon_all();
  while (!registry().have_all_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

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

void bind_worker(nb::module_& /*module*/) {
  nb::module_::import_("atexit").attr("register")(nb::cpp_function(&stop_all_work));
}

}  // namespace gridmerge::python
