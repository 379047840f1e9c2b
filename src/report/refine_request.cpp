// SPDX-License-Identifier: Apache-2.0
#include "report/refine_request.hpp"

#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "report/json_reader.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kFarthest = 1e7;     // [m]
constexpr double kMaxTurned = 100.0;  // [rad]: a page may have counted whole turns

SE2 read_pose(const JsonReader& json) {
  return {json.at("x").number_in(-kFarthest, kFarthest), json.at("y").number_in(-kFarthest, kFarthest),
          normalize_angle(json.at("theta").number_in(-kMaxTurned, kMaxTurned))};
}

std::size_t read_map(const JsonReader& json, std::size_t maps) {
  const auto map = static_cast<std::size_t>(json.count());
  if (map >= maps) json.fail(fmt::format("is no map: {} of {}, counted from 0", map, maps));
  return map;
}

RefineRequest read_request(const JsonReader& json, std::size_t maps) {
  RefineRequest request;
  request.moving = {read_map(json.at("moving"), maps), read_pose(json.at("transform"))};
  std::set<std::size_t> taken{request.moving.map};
  const JsonReader fixed = json.at("fixed");
  if (fixed.size() == 0) fixed.fail("holds no map");
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    const JsonReader one = fixed.at(i);
    const std::size_t map = read_map(one.at("map"), maps);
    if (map == request.moving.map) one.at("map").fail("is the moving map");
    if (!taken.insert(map).second) one.at("map").fail("is there twice");
    request.fixed.push_back({map, read_pose(one.at("transform"))});
  }
  return request;
}

}  // namespace

RefineRequest parse_refine_request(std::string_view text,
                                   const std::function<std::size_t(const std::string& merge)>& maps_of) {
  try {
    const nlohmann::json json = parse_json(text);
    const JsonReader request(json);
    return read_request(request, maps_of(request.at("merge").text()));
  } catch (const JsonError& error) {
    throw std::invalid_argument(error.what());
  }
}

std::string refined_pose_json(const RefinedPose& pose) {
  Json json{{"transform", transform_json(pose.T_fixed_moving)},
            {"score", number_json(pose.score)},
            {"probability", number_json(pose.probability)}};
  json.update(common_json(pose));
  json["start_score"] = number_json(pose.start_score);
  json["moved"] = number_json(pose.moved);
  return text_of(json, -1) + "\n";
}

}  // namespace gridmerge::internal
