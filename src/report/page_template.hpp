// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace gridmerge::internal {

// The report page without what differs from report to report; made from web/ when the project is built.
extern const std::string_view kPageUpToConnect;  ///< up to the value of the policy's connect-src
extern const std::string_view kPageUpToData;     ///< from there to where the data block belongs
extern const std::string_view kPageAfterData;

}  // namespace gridmerge::internal
