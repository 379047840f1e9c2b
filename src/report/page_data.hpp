// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/report/merge_output.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// What the report page shows, as its script reads it (docs/report.md): of a page that is saved as a file.
/// "merge" is a name for all that it tells of the merge: the same for the same one, whoever serves it.
/// Arguments and errors as report_page().
/// O(cells).
Json page_data(const NamedMerge& merge);

}  // namespace gridmerge::internal
