// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

namespace gridmerge::internal {

/// What stops work: a flag, and whatever stops the work that it is a part of.
struct Cancellation {
  const std::atomic<bool>* flag;
  const Cancellation* outer;  // null where there is none
};

/// What this thread's work is stopped by; null where there is nothing.
const Cancellation* current_cancellation();

/// Makes `cancellation` this thread's while it lives. A thread of TBB that waits may begin with another's
/// work in between, so scopes nest.
class CancellationScope {
 public:
  explicit CancellationScope(const Cancellation* cancellation);
  ~CancellationScope();
  CancellationScope(const CancellationScope&) = delete;
  CancellationScope& operator=(const CancellationScope&) = delete;

 private:
  const Cancellation* before_;
};

}  // namespace gridmerge::internal
