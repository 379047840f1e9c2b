// SPDX-License-Identifier: Apache-2.0
#include "report/json_reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace gridmerge::internal {

JsonReader JsonReader::at(const char* key) const {
  if (!value_.is_object()) fail("is no object");
  const auto found = value_.find(key);
  const std::string place = place_.empty() ? key : place_ + "." + key;
  if (found == value_.end()) throw JsonError(place + " is missing");
  return JsonReader(*found, place);
}

JsonReader JsonReader::at(std::size_t index) const {
  if (index >= size()) fail(fmt::format("has no element {}", index));
  return JsonReader(value_[index], fmt::format("{}[{}]", place_, index));
}

std::size_t JsonReader::size() const {
  if (!value_.is_array()) fail("is no list");
  return value_.size();
}

std::string JsonReader::text() const {
  if (!value_.is_string()) fail("is no text");
  return value_.get<std::string>();
}

double JsonReader::number_in(double least, double most) const {
  if (!value_.is_number()) fail("is no number");
  const double number = value_.get<double>();
  if (!(number >= least && number <= most)) fail(fmt::format("lies outside [{}, {}]", least, most));
  return number;
}

std::int64_t JsonReader::count() const {
  constexpr std::int64_t kMax = std::int64_t{1} << 53;
  if (value_.is_number_unsigned() && value_.get<std::uint64_t>() <= static_cast<std::uint64_t>(kMax))
    return value_.get<std::int64_t>();
  fail("is no whole number from 0 to 2^53");
}

SE2 JsonReader::transform(double farthest) const {
  return {at("x").number_in(-farthest, farthest), at("y").number_in(-farthest, farthest),
          at("theta").number_in(-std::numbers::pi, std::numbers::pi)};
}

void JsonReader::fail(const std::string& what) const {
  throw JsonError((place_.empty() ? "the text" : place_) + " " + what);
}

nlohmann::json parse_json(std::string_view text) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, ...": the number says nothing to a reader.
    const std::string what = error.what();
    const std::size_t end = what.find("] ");
    throw JsonError("is no JSON: " + (end == std::string::npos ? what : what.substr(end + 2)));
  }
}

}  // namespace gridmerge::internal
