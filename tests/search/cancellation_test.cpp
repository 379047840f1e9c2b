// SPDX-License-Identifier: Apache-2.0
// A search that is cancelled ends soon, wherever it is. Its steps are counted by the memory that it asks for.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <functional>

#include "../similarity/random_grid.hpp"
#include "gridmerge/grid/execution.hpp"
#include "search/exhaustive.hpp"
#include "search/rotations.hpp"
#include "search/thorough.hpp"
#include "support/own_new.hpp"

namespace gridmerge::test {

namespace {
std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> cancel_at{0};  // an allocation; 0 for never
std::atomic<bool> cancelled{false};
}  // namespace

void* allocate(std::size_t size) noexcept {
  if (++allocations == cancel_at) cancelled = true;
  return std::malloc(size > 0 ? size : 1);
}

}  // namespace gridmerge::test

namespace gridmerge {

using namespace internal;
namespace {

/// How many allocations the work takes by one thread when it is cancelled at one of them, or at none for 0.
std::size_t allocations_of(const std::function<void()>& work, std::size_t cancelled_at) {
  test::cancelled = false;
  test::allocations = 0;
  test::cancel_at = cancelled_at;
  bool is_cancelled = false;
  try {
    with_cancellation(test::cancelled, [&] { with_threads(1, work); });
  } catch (const Cancelled&) {
    is_cancelled = true;
  }
  test::cancel_at = 0;
  EXPECT_EQ(is_cancelled, cancelled_at > 0);
  return test::allocations;
}

void expect_soon_cancelled(const std::function<void()>& search) {
  if (!test::kHasOwnNew) GTEST_SKIP() << "the sanitizer has an operator new of its own";
  allocations_of(search, 0);  // what is made once
  const std::size_t all = allocations_of(search, 0);
  ASSERT_GT(all, 2000u);
  for (std::size_t part = 1; part < 15; ++part) {  // what comes last sorts what was found
    const std::size_t at = part * all / 20;
    EXPECT_LT(allocations_of(search, at), at + all / 50) << part;
  }
}

class CancelledSearch : public testing::Test {
 protected:
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(1, 90, 70), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(2, 60, 80), 0.1);
};

TEST_F(CancelledSearch, TheThoroughOneEndsSoon) {
  expect_soon_cancelled([&] { search_thoroughly(fixed, moving); });
}

TEST_F(CancelledSearch, TheQuickOneEndsSoon) {
  expect_soon_cancelled([&] { search_all_poses(fixed, moving); });
}

TEST_F(CancelledSearch, BeginsNoOtherRotation) {
  struct Finder {
    std::size_t& looks;
    std::size_t last;
    std::atomic<bool>& cancelled;

    std::vector<Peak> look(int rotation) {
      if (++looks == last) cancelled = true;
      return {{rotation, 0, 0, 100}};
    }
    std::vector<Peak> find_all(int rotation) { return look(rotation); }
    std::vector<Peak> find_from(int /*least*/, int rotation) { return look(rotation); }
  };
  const SearchFrame frame = make_search_frame(fixed, moving, 5, 180);
  for (const std::size_t candidates : {1U, 1000U}) {       // some shifts passed over, or none
    for (const std::size_t last : {1U, 10U, 30U, 100U}) {  // among the pilots, and behind them
      std::atomic<bool> cancelled{false};
      std::size_t looks = 0;
      const auto search = [&] {
        search_rotations(frame, candidates, 1, [&] { return Finder{looks, last, cancelled}; });
      };
      EXPECT_THROW(with_cancellation(cancelled, [&] { with_threads(1, search); }), Cancelled);
      EXPECT_EQ(looks, last);
    }
  }
}

}  // namespace
}  // namespace gridmerge
