// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/search/parallel.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace gridmerge {
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

TEST(WithThreads, OneThreadIsTheCallersOwn) {
  std::set<std::thread::id> seen;  // unguarded: one thread only
  with_threads(1, [&] { parallel_for(1000, [&](std::size_t) { seen.insert(std::this_thread::get_id()); }); });
  EXPECT_EQ(seen, std::set<std::thread::id>{std::this_thread::get_id()});
}

TEST(WithThreads, UsesNoMoreThanItWasGiven) {
  std::set<std::thread::id> seen;
  std::mutex guard;
  with_threads(2, [&] {
    parallel_for(10000, [&](std::size_t) {
      const std::lock_guard<std::mutex> lock(guard);
      seen.insert(std::this_thread::get_id());
    });
  });
  EXPECT_LE(seen.size(), 2u);
}

}  // namespace
}  // namespace gridmerge
