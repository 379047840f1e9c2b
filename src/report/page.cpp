// SPDX-License-Identifier: Apache-2.0
#include "report/page.hpp"

#include <string_view>

#include "report/page_data.hpp"
#include "report/page_template.hpp"

namespace gridmerge::internal {

namespace {

/// JSON as it may stand in an HTML element: nothing in it is a tag, a comment or a character reference. In
/// JSON these three occur in strings alone.
std::string as_element_text(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    switch (c) {
      case '<':
        text += "\\u003c";
        break;
      case '>':
        text += "\\u003e";
        break;
      case '&':
        text += "\\u0026";
        break;
      default:
        text += c;
    }
  }
  return text;
}

std::string assemble(std::string_view connect_source, const Json& data) {
  std::string page(kPageUpToConnect);
  page += connect_source;
  page += kPageUpToData;
  page += R"(<script type="application/json" id="report-data">)";
  page += as_element_text(text_of(data, -1));
  page += "</script>";
  page += kPageAfterData;
  return page;
}

}  // namespace

std::string report_page(const NamedMerge& merge) {
  return assemble("'none'", page_data(merge));
}

LiveReportPage live_report_page(const NamedMerge& merge, std::optional<std::uint64_t> answer) {
  Json data = page_data(merge);
  data["live"] = true;
  if (answer) data["answer"] = *answer;
  return {assemble("'self'", data), data.at("merge").get<std::string>()};
}

}  // namespace gridmerge::internal
