// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <vector>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "gridmerge/similarity/image_similarity.hpp"

namespace gridmerge {

using namespace internal;
namespace {

TEST(Cancellation, EndsAParallelLoopLongBeforeItsEnd) {
  std::atomic<bool> cancelled{false};
  std::atomic<std::size_t> calls{0};
  const auto work = [&] {
    with_threads(2, [&] {
      parallel_for(1000000, [&](std::size_t) {
        if (++calls == 10) cancelled = true;
      });
    });
  };
  EXPECT_THROW(with_cancellation(cancelled, work), Cancelled);
  EXPECT_LT(calls.load(), 1000u);
}

TEST(Cancellation, ReachesLoopsInLoopsWithThreadsOfTheirOwn) {
  std::atomic<bool> cancelled{false};
  std::atomic<std::size_t> calls{0};
  const auto inner = [&] {
    parallel_for(1000, [&](std::size_t) {
      if (++calls == 10) cancelled = true;
    });
  };
  const auto work = [&] {
    with_threads(2, [&] { parallel_for(4, [&](std::size_t) { with_threads(1, inner); }); });
  };
  EXPECT_THROW(with_cancellation(cancelled, work), Cancelled);
  EXPECT_LT(calls.load(), 1000u);
}

TEST(Cancellation, OfTheWholeReachesAPartThatMayBeCancelledByItself) {
  std::atomic<bool> whole{false};
  const std::atomic<bool> part{false};
  std::atomic<std::size_t> calls{0};
  const auto loop = [&] {
    parallel_for(1000000, [&](std::size_t) {
      if (++calls == 10) whole = true;
    });
  };
  EXPECT_THROW(with_cancellation(whole, [&] { with_cancellation(part, [&] { with_threads(2, loop); }); }),
               Cancelled);
  EXPECT_LT(calls.load(), 1000u);
}

TEST(Cancellation, ReachesLongFunctionsOfOneThread) {
  const std::atomic<bool> cancelled{true};
  const OccupancyGrid map = make_grid(40, 30, 0.1, {}, Cell::free);
  const auto expect_cancelled = [&](const std::function<void()>& work) {
    EXPECT_NO_THROW(work());
    EXPECT_THROW(with_cancellation(cancelled, work), Cancelled);
  };
  expect_cancelled([&] { downsample(map, 2); });
  expect_cancelled([&] { content_id(map); });
  expect_cancelled([&] { make_distance_map(map, Cell::free); });
  expect_cancelled([&] { trace_distance_map(map, Cell::free); });
  expect_cancelled([&] { draw_on_lattice(map, {&map, {}}); });
  expect_cancelled([&] { count_equal_cells(map, std::vector<PlacedMap>{{&map, {}}}); });
}

TEST(Cancellation, ReachesThoseWhoAskThemselves) {
  std::atomic<bool> cancelled{true};
  EXPECT_THROW(with_cancellation(cancelled, [] { throw_if_cancelled(); }), Cancelled);
}

TEST(Cancellation, LeavesOtherWorkAlone) {
  const std::atomic<bool> cancelled{true};
  EXPECT_THROW(with_cancellation(cancelled, [] { parallel_for(1, [](std::size_t) {}); }), Cancelled);
  EXPECT_NO_THROW(throw_if_cancelled());
  std::atomic<int> calls{0};
  parallel_for(100, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls.load(), 100);
}

TEST(Cancellation, PassesAnExceptionOn) {
  const std::atomic<bool> cancelled{false};
  EXPECT_THROW(with_cancellation(cancelled, [] { throw std::out_of_range("elsewhere"); }), std::out_of_range);
  EXPECT_NO_THROW(throw_if_cancelled());
}

}  // namespace
}  // namespace gridmerge
