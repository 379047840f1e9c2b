// SPDX-License-Identifier: Apache-2.0
#include "io/map_yaml.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string>

#include "gridmerge/io/map_file.hpp"
#include "io/number.hpp"
#include "io/parse_error.hpp"
#include "io/yaml.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::array<const char*, 3> kModeNames{"trinary", "scale", "raw"};

// A value as errors show it: the whole of it may be a megabyte.
std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  return text.size() <= kShown ? fmt::format("'{}'", text) : fmt::format("'{}...'", text.substr(0, kShown));
}

// YAML 1.1 writes its words in three ways: true, True, TRUE.
std::string to_lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

// YAML forbids it; yaml-cpp takes the first value, Python's loaders the last, so that nobody can say what was
// meant.
void check_keys_differ(const YAML::Node& map) {
  std::set<std::string> keys;
  for (const auto& entry : map) {
    if (entry.first.IsScalar() && !keys.insert(entry.first.Scalar()).second)
      throw ParseError(fmt::format("{} is given twice", in_quotes(entry.first.Scalar())));
  }
}

const std::string& scalar(const YAML::Node& node, const char* key) {
  if (!node.IsScalar()) throw ParseError(fmt::format("'{}' is not a single value", key));
  return node.Scalar();
}

YAML::Node required(const YAML::Node& map, const char* key) {
  const YAML::Node node = map[key];
  if (!node.IsDefined()) throw ParseError(fmt::format("missing key '{}'", key));
  return node;
}

double to_number(const YAML::Node& node, const char* key) {
  const std::string& text = scalar(node, key);
  const auto number = parse_number(text);
  if (!number) throw ParseError(fmt::format("'{}' is {}, not a finite number", key, in_quotes(text)));
  return *number;
}

std::string read_image(const YAML::Node& map) {
  const std::string& image = scalar(required(map, "image"), "image");
  if (image.empty()) throw ParseError("'image' is empty");
  // The system would read the name up to there, and open another file than the one that messages show.
  if (image.find('\0') != std::string::npos) throw ParseError("'image' holds a NUL character");
  return image;
}

// As C, Python and YAML write it: nan, -nan, NaN, .nan.
bool is_nan(const std::string& text) {
  const std::string word = to_lower(text);
  return word == "nan" || word == "-nan" || word == "+nan" || word == ".nan";
}

// Of a quaternion of four zeros, which some writers leave as it was made, the yaw is no number.
double read_yaw(const YAML::Node& node, std::vector<MapWarning>& warnings) {
  if (!node.IsScalar() || !is_nan(node.Scalar())) return to_number(node, "origin");
  warnings.push_back(
      {MapWarningKind::yaw_not_a_number,
       fmt::format("the origin's yaw is {}, no number: it is read as 0", in_quotes(node.Scalar()))});
  return 0.0;
}

SE2 read_origin(const YAML::Node& map, std::vector<MapWarning>& warnings) {
  const YAML::Node node = required(map, "origin");
  if (!node.IsSequence() || (node.size() != 3 && node.size() != 4))
    throw ParseError("'origin' is not a list of three numbers [x, y, yaw]");
  const double x = to_number(node[0], "origin");
  const double y = to_number(node[1], "origin");
  const double yaw = read_yaw(node[2], warnings);
  if (node.size() == 4) {
    warnings.push_back(
        {MapWarningKind::long_origin,
         fmt::format("the origin has four numbers: x, y and yaw are the first three, as in ROS 1, "
                     "and {} is passed over",
                     in_quotes(scalar(node[3], "origin")))});
  }
  if (std::max(std::abs(x), std::abs(y)) > kMaxOrigin) {
    throw ParseError(fmt::format("'origin' is further than {} m from zero", kMaxOrigin));
  }
  return {x, y, normalize_angle(yaw)};
}

double read_threshold(const YAML::Node& map, const char* key) {
  const double threshold = to_number(required(map, key), key);
  if (threshold < 0.0 || threshold > 1.0)
    throw ParseError(fmt::format("'{}' is {}, not in 0..1", key, threshold));
  return threshold;
}

bool read_negate(const YAML::Node& map) {
  const std::string& text = scalar(required(map, "negate"), "negate");
  const std::string word = to_lower(text);
  const auto is_word = [&](const char* candidate) { return word == candidate; };
  if (std::ranges::any_of(std::array{"1", "true", "yes", "on", "y"}, is_word)) return true;
  if (std::ranges::any_of(std::array{"0", "false", "no", "off", "n"}, is_word)) return false;
  throw ParseError(fmt::format("'negate' is {}, not 0, 1, true or false", in_quotes(text)));
}

MapMode read_mode(const YAML::Node& map) {
  const YAML::Node node = map["mode"];
  if (!node.IsDefined()) return MapMode::trinary;
  const std::string& text = scalar(node, "mode");
  const auto found = std::ranges::find(kModeNames, to_lower(text));
  if (found == kModeNames.end())
    throw ParseError(fmt::format("'mode' is {}, not trinary, scale or raw", in_quotes(text)));
  return static_cast<MapMode>(found - kModeNames.begin());
}

// Quoted only where need be: plain names are for scripts that take YAML apart by the line.
std::string yaml_string(const std::string& text) {
  constexpr std::string_view kAlwaysPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  if (text.find_first_not_of(kAlwaysPlain) == std::string::npos && !text.starts_with('-')) return text;
  YAML::Emitter emitter;
  emitter << YAML::DoubleQuoted << text;
  return emitter.c_str();
}

}  // namespace

MapYaml parse_map_yaml(std::string_view text) {
  const YAML::Node document = load_yaml(text);
  if (!document.IsMap()) throw ParseError("not a YAML map of keys and values");
  check_keys_differ(document);
  MapYaml map;
  map.image = read_image(document);
  map.resolution = to_number(required(document, "resolution"), "resolution");
  check_resolution(map.resolution);
  map.origin = read_origin(document, map.warnings);
  map.occupied_thresh = read_threshold(document, "occupied_thresh");
  map.free_thresh = read_threshold(document, "free_thresh");
  if (map.free_thresh > map.occupied_thresh) {
    throw ParseError(
        fmt::format("'free_thresh' {} is above 'occupied_thresh' {}", map.free_thresh, map.occupied_thresh));
  }
  map.negate = read_negate(document);
  map.mode = read_mode(document);
  return map;
}

std::string format_map_yaml(const MapYaml& map) {
  const std::string image = yaml_string(map.image);
  std::string text = fmt::format(
      "image: {}\n"
      "mode: {}\n"
      "resolution: {}\n"
      "origin: [{}, {}, {}]\n"
      "negate: {}\n"
      "occupied_thresh: {}\n"
      "free_thresh: {}\n",
      image, kModeNames[static_cast<std::size_t>(map.mode)], format_number(map.resolution),
      format_number(map.origin.x), format_number(map.origin.y), format_number(map.origin.theta),
      map.negate ? 1 : 0, format_number(map.occupied_thresh), format_number(map.free_thresh));
  if (parse_map_yaml(text).image != map.image) {
    throw ParseError("the image's name cannot be written in YAML");
  }
  return text;
}

void check_resolution(double resolution) {
  if (!is_resolution(resolution)) {
    throw ParseError(fmt::format("the resolution {} is not in {}..{} metres per cell", resolution,
                                 kMinResolution, kMaxResolution));
  }
}

}  // namespace gridmerge::internal
