// SPDX-License-Identifier: Apache-2.0
// The engine's threads are started here, and for the rotations of a search. oneTBB orders a caller's writes
// before the work it hands over, and that work before the caller goes on; but ThreadSanitizer cannot see into
// a library that was built without it, and would call all of it a race. The atomics below say the same order
// once more, in a language that it understands, and cmake/tsan.supp passes over this file and oneTBB's own.
// What is left to report is a race of ours.
#include "grid/parallel.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "grid/cancellation_scope.hpp"
#include "grid/thread_count.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge {

using namespace internal;

void with_threads(int threads, const std::function<void()>& work) {
  if (threads < 0) throw std::invalid_argument("threads must not be negative");
  std::atomic<int> begun{0};
  std::atomic<int> ended{0};
  const Cancellation* const cancellation = current_cancellation();
  begun.store(1, std::memory_order_release);
  tbb::task_arena arena(thread_count(threads));
  arena.execute([&] {
    (void)begun.load(std::memory_order_acquire);
    const CancellationScope scope(cancellation);
    work();
    ended.store(1, std::memory_order_release);
  });
  (void)ended.load(std::memory_order_acquire);
}

namespace internal {

int thread_count(int threads) {
  // An arena has no more threads than cores, and prints a warning when it is asked for more.
  const int cores = tbb::info::default_concurrency();
  return threads == 0 ? cores : std::min(threads, cores);
}

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<int> begun{0};
  std::atomic<std::size_t> ended{0};
  const Cancellation* const cancellation = current_cancellation();
  begun.store(1, std::memory_order_release);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    (void)begun.load(std::memory_order_acquire);
    const CancellationScope scope(cancellation);
    throw_if_cancelled();
    body(i);
    ended.fetch_add(1, std::memory_order_release);
  });
  (void)ended.load(std::memory_order_acquire);
}

void parallel_tasks(std::size_t count, const std::function<void(std::size_t)>& task) {
  if (count == 1) {
    task(0);
  } else {
    parallel_for(count, [&](std::size_t i) { with_threads(1, [&] { task(i); }); });
  }
}

}  // namespace internal

}  // namespace gridmerge
