// SPDX-License-Identifier: Apache-2.0
#include "grid/cancellation_scope.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge {

using namespace internal;

namespace {
thread_local const std::atomic<bool>* current = nullptr;
}  // namespace

namespace internal {

const std::atomic<bool>* current_cancellation() {
  return current;
}

CancellationScope::CancellationScope(const std::atomic<bool>* flag) : outer_(current) {
  current = flag;
}

CancellationScope::~CancellationScope() {
  current = outer_;
}

}  // namespace internal

Cancelled::Cancelled() : std::runtime_error("the work was cancelled") {}

void with_cancellation(const std::atomic<bool>& cancelled, const std::function<void()>& work) {
  const CancellationScope scope(&cancelled);
  work();
}

void throw_if_cancelled() {
  if (current != nullptr && current->load(std::memory_order_relaxed)) throw Cancelled();
}

}  // namespace gridmerge
