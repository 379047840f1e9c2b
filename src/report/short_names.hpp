// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace gridmerge::internal {

/// Names without the folders that all of them lie in, as the report page has them: enough to tell maps apart.
/// O(length of all).
std::vector<std::string> short_names(const std::vector<std::string>& names);

}  // namespace gridmerge::internal
