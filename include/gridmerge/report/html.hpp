// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// `report.html` of a merge: one page that needs nothing but itself (the preview is inside, no script, no
/// network), for light and dark screens of any width: every component's maps with their transforms, every
/// comparison with its figures, and the maps that were left out.
/// `names[i]` is what to call map i; names may hold any bytes and are shown as text only. `preview_png` holds
/// the bytes of a PNG. Throws std::out_of_range when there are fewer names than maps.
std::string report_html(const std::vector<std::string>& names, const MergeResult& result,
                        std::string_view preview_png);

}  // namespace gridmerge
