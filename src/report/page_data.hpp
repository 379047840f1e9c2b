// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// What the report page shows, as its script reads it (docs/report.md): of a page that is saved as a file.
/// Arguments and errors as report_page(). O(cells).
Json page_data(const std::vector<std::string>& names, const std::vector<OccupancyGrid>& maps,
               const MergeResult& result);

}  // namespace gridmerge::internal
