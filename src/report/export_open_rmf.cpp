// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "gridmerge/report/merge_record.hpp"
#include "report/interchange.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

namespace {

/// Behind the mark.
constexpr const char* kHeader =
    "copy the reference_coordinates of a\n"
    "# fleet's map to the fleet's configuration, and call the level what the building's map calls it.\n"
    "# A fleet has one reference_coordinates for each level, so all its robots must use one map's frame.\n"
    "# \"robot\" has points in metres of the map's own frame, and \"rmf\" the same points in the "
    "building's.\n"
    "# reference_image is for a building that is drawn on the merged map's picture: metres from its upper\n"
    "# left corner, y up. cartesian_meters is for a building in the merged map's frame. Both are values of\n"
    "# coordinate_system in the building's file.\n"
    "# Adapters fit one similarity to the points. It enlarges the robot's map by \"scale\", and misses the\n"
    "# points by \"residual\" [m] (root mean square), which is more than 0 of a map that is bent.\n";

/// To a micrometre, and never with an exponent: YAML 1.1 takes "1e-05" for a text.
std::string point_text(const Point2& p) {
  const auto rounded = [](double value) { return std::round(value * 1e6) / 1e6 + 0.0; };  // no -0
  return fmt::format("[{:.6f}, {:.6f}]", rounded(p.x), rounded(p.y));
}

std::string points_text(const std::vector<Point2>& points) {
  std::string text;
  for (const Point2& p : points) text += (text.empty() ? "" : ", ") + point_text(p);
  return "[" + text + "]";
}

std::string coordinates_text(const char* coordinate_system, const std::string& level,
                             const std::vector<Point2>& rmf, const std::vector<Point2>& robot) {
  return fmt::format(
      "    {}:\n      reference_coordinates:\n        {}:\n          rmf: {}\n          robot: {}\n",
      coordinate_system, level, points_text(rmf), points_text(robot));
}

/// Of the merged map's picture, in the merged map's frame. A result without pictures has them where merge()
/// would draw them.
Point2 upper_left_of(const NamedMerge& merge, std::size_t component) {
  const OccupancyGrid& drawn = merge.result.components[component].fused.grid;
  if (!drawn.cells.empty()) return drawn.origin * Point2{0.0, drawn.height * drawn.resolution};
  const FusedWindows windows = windows_of(merge, component);
  const Lattice& lattice = windows.lattice();
  return {lattice.corner.x, lattice.corner.y + lattice.height * lattice.resolution};
}

/// The points of a map that adapters are given. Four corners fix a similarity best; of a map that no
/// similarity places, points all over it make the fitted one the best for the whole map.
std::vector<Point2> reference_points(const OccupancyGrid& map, const Deformation& deformation) {
  std::vector<Point2> points = known_corners(map);
  const MapTransform kind = deformation.kind();
  if (kind == MapTransform::rigid || kind == MapTransform::similarity) return points;
  const std::vector<Point2> more = spread_cells(map);
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

struct Similarity {
  double scale = 1.0;
  double residual = 0.0;  // root mean square [m]
};

/// The one that takes points to others best (least squares).
Similarity similarity_of(const std::vector<Point2>& from, const std::vector<Point2>& to) {
  using Complex = std::complex<double>;
  if (from.empty()) return {};
  const auto count = static_cast<double>(from.size());
  Complex from_mean, to_mean, together;
  for (const Point2& p : from) from_mean += Complex(p.x, p.y) / count;
  for (const Point2& p : to) to_mean += Complex(p.x, p.y) / count;
  double spread = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Complex p = Complex(from[i].x, from[i].y) - from_mean;
    together += std::conj(p) * (Complex(to[i].x, to[i].y) - to_mean);
    spread += std::norm(p);
  }
  const Complex turn = together / spread;
  double missed = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
    missed +=
        std::norm(turn * (Complex(from[i].x, from[i].y) - from_mean) + to_mean - Complex(to[i].x, to[i].y));
  return {std::abs(turn), std::sqrt(missed / count)};
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
  const auto& [names, maps, result, plan] = merge;
  std::string text = std::string(kOpenRmfMark) + kHeader;
  const auto out = std::back_inserter(text);
  text += "merged_maps:\n";
  std::vector<Point2> upper_left;
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    upper_left.push_back(upper_left_of(merge, i));
    fmt::format_to(out, "  {}: {{upper_left: {}}}\n", component_file(i), point_text(upper_left.back()));
  }
  text += "maps:\n";
  for (std::size_t i = 0; i < result.components.size(); ++i) {
    const std::string file = component_file(i), level = std::filesystem::path(file).stem().string();
    for (const Member& member : result.components[i].members) {
      const std::vector<Point2> robot = reference_points(maps.at(member.map), member.deformation);
      std::vector<Point2> building, drawing;
      for (const Point2& point : robot) {
        building.push_back(member.to_component(point));
        drawing.push_back({building.back().x - upper_left[i].x, building.back().y - upper_left[i].y});
      }
      const Similarity best = similarity_of(robot, building);
      fmt::format_to(out, "  - source: {}\n    merged_map: {}\n    scale: {:.6f}\n    residual: {:.6f}\n",
                     quoted(names.at(member.map)), file, best.scale, best.residual);
      text += coordinates_text("reference_image", level, drawing, robot);
      text += coordinates_text("cartesian_meters", level, building, robot);
    }
  }
  return text;
}

}  // namespace gridmerge::internal
