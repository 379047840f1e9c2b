// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// Calls `body(i)` for every i in [0, count), in any order and several at a time, and returns when all calls
/// have returned. No call may touch what another one writes. When calls throw, one of the exceptions is
/// passed on.
GRIDMERGE_INTERNAL_EXPORT void parallel_for(std::size_t count, const std::function<void(std::size_t)>& body);

/// The same for tasks that call parallel_for() themselves: several run by one thread each, since one that
/// waited within a task would begin another meanwhile; a single one runs by all.
GRIDMERGE_INTERNAL_EXPORT void parallel_tasks(std::size_t count,
                                              const std::function<void(std::size_t)>& task);

/// As parallel_for() for every row in [first, end) of a grid.
inline void parallel_rows(int first, int end, const std::function<void(int)>& body) {
  if (first < end)
    parallel_for(static_cast<std::size_t>(end - first),
                 [&](std::size_t i) { body(first + static_cast<int>(i)); });
}

}  // namespace gridmerge::internal
