// SPDX-License-Identifier: Apache-2.0
#include "grid/cancellation_scope.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge {

using namespace internal;

namespace {
thread_local const Cancellation* current = nullptr;
}  // namespace

namespace internal {

const Cancellation* current_cancellation() {
  return current;
}

CancellationScope::CancellationScope(const Cancellation* cancellation) : before_(current) {
  current = cancellation;
}

CancellationScope::~CancellationScope() {
  current = before_;
}

}  // namespace internal

Cancelled::Cancelled() : std::runtime_error("the work was cancelled") {}

void with_cancellation(const std::atomic<bool>& cancelled, const std::function<void()>& work) {
  const Cancellation own{&cancelled, current};
  const CancellationScope scope(&own);
  work();
}

void throw_if_cancelled() {
  for (const Cancellation* one = current; one != nullptr; one = one->outer) {
    if (one->flag->load(std::memory_order_relaxed)) throw Cancelled();
  }
}

}  // namespace gridmerge
