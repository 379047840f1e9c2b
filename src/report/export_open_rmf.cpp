// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "gridmerge/report/merge_record.hpp"
#include "report/interchange.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

namespace {

/// To a micrometre, and never with an exponent: YAML 1.1 takes "1e-05" for a text.
std::string points_text(const std::vector<Point2>& points) {
  std::string text;
  for (const Point2& p : points)
    fmt::format_to(std::back_inserter(text), "{}[{:.6f}, {:.6f}]", text.empty() ? "" : ", ", p.x, p.y);
  return "[" + text + "]";
}

/// What YAML readers take for no printable character, or for the end of a line.
bool must_be_escaped(char32_t c) {
  return c < 0x20 || (c >= 0x7f && c <= 0x9f) || c == 0x2028 || c == 0x2029 || c == 0xfeff || c == 0xfffe ||
         c == 0xffff;
}

}  // namespace

std::string quoted(const std::string& text) {
  std::string result;
  const std::string json = text_of(Json(text), -1);  // in UTF-8 now, and ", \ and lower controls are escaped
  for (std::size_t i = 0; i < json.size();) {
    const auto lead = static_cast<unsigned char>(json[i]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    char32_t c = length == 1 ? lead : lead & (0x7fu >> length);
    for (std::size_t k = 1; k < length; ++k) c = c << 6 | (static_cast<unsigned char>(json[i + k]) & 0x3fu);
    if (must_be_escaped(c)) {
      fmt::format_to(std::back_inserter(result), "\\u{:04x}", static_cast<std::uint32_t>(c));
    } else {
      result.append(json, i, length);
    }
    i += length;
  }
  return result;
}

std::string open_rmf_text(const NamedMerge& merge) {
  const auto& [names, maps, result] = merge;
  std::string text(kOpenRmfMark);
  text +=
      "robot's map to\n"
      "# its fleet's configuration. \"robot\" has the corners of what the map knows, in metres of the map's "
      "own "
      "frame, and\n"
      "# \"rmf\" the same points in the merged map's frame. Call the level what the building's map calls "
      "it.\n"
      "maps:\n";
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    const std::string file = component_file(i);
    for (const Member& member : result.components[i].members) {
      const std::vector<Point2> robot = known_corners(maps.at(member.map));
      std::vector<Point2> rmf;
      rmf.reserve(robot.size());
      for (const Point2& point : robot) rmf.push_back(member.T_component_map * point);
      fmt::format_to(out,
                     "  - source: {}\n    merged_map: {}\n    reference_coordinates:\n      {}:\n"
                     "        rmf: {}\n        robot: {}\n",
                     quoted(names.at(member.map)), file, std::filesystem::path(file).stem().string(),
                     points_text(rmf), points_text(robot));
    }
  }
  return text;
}

}  // namespace gridmerge::internal
