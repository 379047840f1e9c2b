// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "gridmerge/report/merge_record.hpp"
#include "report/interchange.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

namespace {

/// To a micrometre.
Json position_json(const Point2& p) {
  const auto rounded = [](double value) { return number_json(std::round(value * 1e6) / 1e6); };
  return Json::array({rounded(p.x), rounded(p.y)});
}

/// A polygon without holes: its ring is counter-clockwise, and ends where it begins. Null if there are no
/// corners.
Json polygon_json(const std::vector<Point2>& corners) {
  if (corners.empty()) return nullptr;
  Json ring = Json::array();
  for (const Point2& corner : corners) ring.push_back(position_json(corner));
  ring.push_back(position_json(corners.front()));
  return {{"type", "Polygon"}, {"coordinates", Json::array({std::move(ring)})}};
}

Json feature_json(const std::string& id, const std::vector<Point2>& outline, Json properties) {
  return {{"type", "Feature"},
          {"id", id},
          {"geometry", polygon_json(outline)},
          {"properties", std::move(properties)}};
}

Json member_json(const NamedMerge& merge, const std::string& file, const Member& member,
                 const std::vector<Point2>& outline) {
  return feature_json("map " + std::to_string(member.map), outline,
                      {{"kind", "map"},
                       {"source", merge.names.at(member.map)},
                       {"merged_map", file},
                       {"transform", transform_json(member.T_component_map)},
                       {"probability", probability_json(member.probability)},
                       {"sd", deviation_json(member.sd)}});
}

}  // namespace

std::string geojson_text(const NamedMerge& merge) {
  std::vector<Json> features;
  Json frames = Json::object();
  for (std::size_t i = 0; i < merge.result.components.size(); ++i) {
    const Component& component = merge.result.components[i];
    const std::string file = component_file(i);
    frames[file] = "that of " + frame_owner(merge, component);
    std::vector<Json> members;
    std::vector<Point2> all;
    for (const Member& member : component.members) {
      const std::vector<Point2> outline = known_outline(merge.maps.at(member.map), member);
      all.insert(all.end(), outline.begin(), outline.end());
      members.push_back(member_json(merge, file, member, outline));
    }
    features.push_back(
        feature_json(file, convex_hull(std::move(all)),
                     {{"kind", "merged map"}, {"merged_map", file}, {"maps", members.size()}}));
    for (Json& member : members) features.push_back(std::move(member));
  }
  const Json coordinate_frame{{"unit", "metre"},
                              {"axes", "x to the right, y up"},
                              {"note", kGeoJsonMark},
                              {"frames", std::move(frames)}};
  // A feature is a line.
  std::string text = "{\"type\": \"FeatureCollection\",\n\"coordinate_frame\": ";
  text.append(text_of(coordinate_frame, -1)).append(",\n\"features\": [\n");
  for (std::size_t i = 0; i < features.size(); ++i) {
    text += text_of(features[i], -1);
    text += i + 1 < features.size() ? ",\n" : "\n";
  }
  return text + "]}\n";
}

}  // namespace gridmerge::internal
