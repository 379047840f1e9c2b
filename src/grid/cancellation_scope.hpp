// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace gridmerge::internal {

/// The flag that this thread's work is stopped by; null where there is none.
const std::atomic<bool>* current_cancellation();

/// Makes `flag` this thread's while it lives. A thread of TBB that waits may begin with another's work in
/// between, so scopes nest.
class CancellationScope {
 public:
  explicit CancellationScope(const std::atomic<bool>* flag);
  ~CancellationScope();
  CancellationScope(const CancellationScope&) = delete;
  CancellationScope& operator=(const CancellationScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

}  // namespace gridmerge::internal
