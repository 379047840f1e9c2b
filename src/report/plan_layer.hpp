// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/report/merge_output.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// The plan of a merge that has one, as the report page takes it: which maps hang on it, and where it lies
/// under merged maps and maps that were left out. With its walls as cells if NamedMerge::plan is there; large
/// ones are shown coarser. O(cells of the plan).
Json plan_page_json(const NamedMerge& merge);

}  // namespace gridmerge::internal
