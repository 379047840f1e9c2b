// SPDX-License-Identifier: Apache-2.0
#include "worker.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::python {

namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(50);
constexpr auto kPatience = std::chrono::seconds(1);  // with what cannot be cancelled, when Python ends

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

  void cancel() { cancelled_ = true; }

  bool has_ended() {
    const std::lock_guard lock(mutex_);
    return ended_;
  }

  /// Whether its thread is in the process that this one was forked from.
  bool is_elsewhere() const { return fork_count() != made_after_forks_; }

 private:
  void run(const std::function<void(const Report&)>& work);

  std::atomic<bool> cancelled_{false};
  std::atomic<double> share_{0.0};
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::exception_ptr failure_;
  int made_after_forks_ = fork_count();
  std::unique_ptr<std::thread> thread_;
};

/// What is at work without the interpreter's lock. When the interpreter ends, only the thread that ends it
/// may go on: whatever still runs then may call us.
class AtWork {
 public:
  /// False if the thread may never take the lock again.
  bool leave_lock() {
    const std::lock_guard lock(mutex_);
    if (is_over()) return false;
    ++without_lock_;
    return true;
  }

  /// The same, of a thread that did leave it.
  bool may_take_lock() {
    const std::lock_guard lock(mutex_);
    if (!is_over()) return true;
    --without_lock_;
    return false;
  }

  void took_lock() {
    const std::lock_guard lock(mutex_);
    --without_lock_;
  }

  /// False if there may be no more workers.
  bool add(Worker* worker) {
    const std::lock_guard lock(mutex_);
    if (is_over()) return false;
    workers_.push_back(worker);
    return true;
  }

  void remove(Worker* worker) {
    const std::lock_guard lock(mutex_);
    std::erase(workers_, worker);
  }

  /// The calling thread ends the interpreter.
  void abandon_all() {
    const std::lock_guard lock(mutex_);
    ended_by_ = std::this_thread::get_id();
    for (Worker* worker : workers_) worker->cancel();
  }

  bool have_workers_ended() {
    const std::lock_guard lock(mutex_);
    return std::all_of(workers_.begin(), workers_.end(), [](Worker* worker) { return worker->has_ended(); });
  }

  bool is_none_without_lock() {
    const std::lock_guard lock(mutex_);
    return without_lock_ == 0;
  }

 private:
  bool is_over() const { return ended_by_ && *ended_by_ != std::this_thread::get_id(); }

  std::mutex mutex_;
  std::vector<Worker*> workers_;
  int without_lock_ = 0;  // threads
  std::optional<std::thread::id> ended_by_;
};

// Never destroyed: threads that sleep for ever may still be told of in it.
AtWork* all_work = new AtWork;

AtWork& at_work() {
  return *all_work;
}

int forks = 0;

// In a process that was just forked. A thread that is not here may have held the mutex of what was at work.
void forget_all_work() {
  ++forks;
  all_work = new AtWork;
}

Worker::Worker(const std::function<void(const Report&)>& work) {
  if (!at_work().add(this)) {
    const OthersRun for_ever;
  }
  try {
    thread_ = std::make_unique<std::thread>([this, &work] { run(work); });
  } catch (...) {
    at_work().remove(this);
    throw;
  }
}

Worker::~Worker() {
  cancelled_ = true;
  if (is_elsewhere()) {
    (void)thread_.release();  // there is nothing that could be joined or detached
    return;
  }
  {
    const OthersRun meanwhile;
    thread_->join();
  }
  at_work().remove(this);
}

bool Worker::wait_a_moment() {
  if (is_elsewhere())
    throw std::runtime_error("the process was forked during the work, and the copy has no threads at it");
  const OthersRun meanwhile;
  std::unique_lock lock(mutex_);
  return end_.wait_for(lock, kLookEvery, [this] { return ended_; });
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

/// Before an interpreter has ended it throws out the other threads that run Python code. That would unwind
/// through nanobind, which brings the process down: the thread sleeps for ever instead.
class StaysInPython {
 public:
  StaysInPython() = default;
  StaysInPython(const StaysInPython&) = delete;
  StaysInPython& operator=(const StaysInPython&) = delete;
  ~StaysInPython() {
    if (!came_back_) sleep_for_ever();
  }

  void came_back() { came_back_ = true; }

 private:
  bool came_back_ = false;
};

void call(const nb::object& progress, double share) {
  StaysInPython thread;
  try {
    progress(share);
  } catch (const std::exception&) {
    thread.came_back();
    throw;
  }
  thread.came_back();
}

void stop_all_work() {
  const nb::gil_scoped_release others_may_run;
  at_work().abandon_all();
  const auto wait_a_little = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  while (!at_work().have_workers_ended()) wait_a_little();
  // A thread that reads from a pipe may wait for ever.
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!at_work().is_none_without_lock() && std::chrono::steady_clock::now() < end) wait_a_little();
}

}  // namespace

int fork_count() {
  return forks;
}

OthersRun::OthersRun() {
  const bool may_come_back = at_work().leave_lock();
  state_ = PyEval_SaveThread();
  if (!may_come_back) sleep_for_ever();
}

OthersRun::~OthersRun() {
  if (!at_work().may_take_lock()) sleep_for_ever();
  PyEval_RestoreThread(state_);
  at_work().took_lock();
}

void run_in_worker(const nb::object& progress, const std::function<void(const Report&)>& work) {
  Worker worker(work);
  double told = 0.0;
  while (!worker.wait_a_moment()) {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    const double share = worker.share();
    if (progress.is_none() || share == told) continue;
    told = share;
    call(progress, share);
  }
  worker.rethrow_failure();
  if (!progress.is_none()) call(progress, 1.0);
}

void bind_worker(nb::module_& /*module*/) {
  nb::module_::import_("atexit").attr("register")(nb::cpp_function(&stop_all_work));
  nb::module_::import_("os").attr("register_at_fork")(nb::arg("after_in_child") =
                                                          nb::cpp_function(&forget_all_work));
}

}  // namespace gridmerge::python
