// SPDX-License-Identifier: Apache-2.0
#include "grid/parallel.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge {

using namespace internal;
namespace {

TEST(ParallelFor, CallsTheBodyOnceForEveryIndex) {
  std::vector<int> calls(10000, 0);
  with_threads(2, [&] { parallel_for(calls.size(), [&](std::size_t i) { ++calls[i]; }); });
  EXPECT_EQ(calls, std::vector<int>(10000, 1));
}

TEST(ParallelFor, DoesNothingForAnEmptyRange) {
  parallel_for(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, ShowsTheCallerWhatWasWritten) {
  std::vector<std::vector<int>> written(500);
  with_threads(2, [&] { parallel_for(500, [&](std::size_t i) { written[i].assign(100, 1); }); });
  std::size_t sum = 0;
  for (const std::vector<int>& some : written) sum += some.size();
  EXPECT_EQ(sum, 50000u);
}

TEST(ParallelFor, PassesAnExceptionOn) {
  const auto work = [] {
    parallel_for(100, [](std::size_t i) {
      if (i == 50) throw std::runtime_error("fifty");
    });
  };
  EXPECT_THROW(with_threads(1, work), std::runtime_error);
  EXPECT_THROW(with_threads(2, work), std::runtime_error);
}

TEST(WithThreads, RefusesLessThanNone) {
  EXPECT_THROW(with_threads(-1, [] { FAIL(); }), std::invalid_argument);
}

TEST(ParallelTasks, ATaskOfSeveralStaysOnItsThread) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{40}}) {
    std::vector<std::set<std::thread::id>> threads(count);
    std::vector<int> calls(count, 0);
    with_threads(2, [&] {
      parallel_tasks(count, [&](std::size_t task) {
        ++calls[task];
        if (count == 1) return;
        threads[task].insert(std::this_thread::get_id());
        parallel_for(20, [&](std::size_t) { threads[task].insert(std::this_thread::get_id()); });
      });
    });
    EXPECT_EQ(calls, std::vector<int>(count, 1));
    for (const std::set<std::thread::id>& of_task : threads) EXPECT_LE(of_task.size(), 1u);
  }
  parallel_tasks(0, [](std::size_t) { FAIL(); });
}

TEST(ParallelRows, CallsTheBodyOnceForEveryRow) {
  std::vector<int> calls(10, 0);
  parallel_rows(3, 7, [&](int row) { ++calls[static_cast<std::size_t>(row)]; });
  EXPECT_EQ(calls, (std::vector<int>{0, 0, 0, 1, 1, 1, 1, 0, 0, 0}));
  parallel_rows(7, 3, [](int) { FAIL(); });
}

TEST(WithThreads, OneThreadIsTheCallersOwn) {
  std::set<std::thread::id> seen;  // unguarded: one thread only
  with_threads(1, [&] { parallel_for(1000, [&](std::size_t) { seen.insert(std::this_thread::get_id()); }); });
  EXPECT_EQ(seen, std::set<std::thread::id>{std::this_thread::get_id()});
}

// How many of the calls of one parallel_for() were under way at the same time. Each takes a while, so that
// every thread that may help comes to do so.
int most_calls_at_once() {
  std::atomic<int> under_way{0};
  std::atomic<int> most{0};
  parallel_for(200, [&](std::size_t) {
    const int now = ++under_way;
    int before = most;
    while (before < now && !most.compare_exchange_weak(before, now)) {
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --under_way;
  });
  return most;
}

TEST(WithThreads, UsesNoMoreThanItWasGiven) {
  // oneTBB itself would stop at the number of cores, which may be what was given. In an arena of eight
  // threads that there may be, only with_threads() can be what keeps them out.
  const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
  tbb::task_arena(8).execute([] {
    for (const int threads : {1, 2, 3}) {
      int most = 0;
      with_threads(threads, [&] { most = most_calls_at_once(); });
      EXPECT_LE(most, threads);
    }
  });
}

}  // namespace
}  // namespace gridmerge
