// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>

#include "gridmerge/export.hpp"

namespace gridmerge {

/// Runs `work` in a TBB arena of up to `threads` threads; 0 = one per core, and there are never more.
/// Functions that say that they run in the calling TBB arena use these threads. Functions with a number of
/// threads among their options or arguments use that number instead. Throws std::invalid_argument for a
/// negative number; an exception of `work` is passed on.
GRIDMERGE_EXPORT void with_threads(int threads, const std::function<void()>& work);

/// What work ends with that was asked to stop.
class GRIDMERGE_EXPORT Cancelled : public std::runtime_error {
 public:
  /// With a message that says so.
  Cancelled();
};

/// Runs `work` so that it ends with Cancelled soon after `cancelled` becomes true, from whichever thread. All
/// long functions of the library look at it, in the threads too that they use; RosNode::run() is ended by
/// RosNode::stop() alone. Within other work that may be cancelled, either flag ends it. An exception of
/// `work` is passed on.
GRIDMERGE_EXPORT void with_cancellation(const std::atomic<bool>& cancelled,
                                        const std::function<void()>& work);

/// For long loops of your own: throws Cancelled if the work they belong to was asked to stop.
/// A few nanoseconds; without with_cancellation() it never throws.
GRIDMERGE_EXPORT void throw_if_cancelled();

}  // namespace gridmerge
