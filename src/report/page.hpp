// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "gridmerge/report/merge_output.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// `report.html` of a merge: one interactive page that needs nothing but itself. Its script draws all maps
/// and shows the figures behind every join, from the data block that the page holds. A policy in the page
/// lets the browser run that script alone and fetch nothing.
///
/// Names may hold any bytes and are data only (what is not UTF-8 appears as U+FFFD). A fused map that is
/// empty (0 x 0) is shown as a component without cells. Depends on nothing else: the same input gives the
/// same bytes. O(cells): about 0.1 s for a map of 4000 x 4000.
std::string report_page(const NamedMerge& merge);

/// A page for a server, and the name of its merge, by which it asks about maps (page_data()).
struct LiveReportPage {
  std::string html;
  std::string merge;
};

/// The same for a server that answers what the page asks: its data says that it is `live`, and the policy
/// lets it talk to where it came from. With the number of an `answer` the page asks the server at "/news"
/// which one is the newest, and loads itself anew when that is another. Throws as report_page().
GRIDMERGE_INTERNAL_EXPORT LiveReportPage live_report_page(const NamedMerge& merge,
                                                          std::optional<std::uint64_t> answer = {});

}  // namespace gridmerge::internal
