// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "internal_export.hpp"

namespace gridmerge::internal {

/// How many threads with_threads() uses when it is asked for so many: 0 = one per core, and there are never
/// more.
GRIDMERGE_INTERNAL_EXPORT int thread_count(int threads);

}  // namespace gridmerge::internal
