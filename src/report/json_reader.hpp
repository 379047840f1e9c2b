// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge::internal {

/// Text that is not the JSON that was expected. The message names the place: "joins[2].transform.x is no
/// number".
class JsonError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A value in a JSON text that nobody vouches for, and where it stands. Every failure is a JsonError.
class JsonReader {
 public:
  /// `place` is what messages call it; "" for the whole text. `value` outlives this.
  explicit JsonReader(const nlohmann::json& value, std::string place = {})
      : value_(value), place_(std::move(place)) {}

  /// A key that has to be there, of an object.
  JsonReader at(const char* key) const;
  /// Whether an object has it; the value must be one.
  bool has(const char* key) const { return value_.contains(key); }
  /// An element of an array.
  JsonReader at(std::size_t index) const;
  /// The number of elements of an array.
  std::size_t size() const;
  bool is_null() const { return value_.is_null(); }

  std::string text() const;
  double number_in(double least, double most) const;  ///< finite
  std::int64_t count() const;                         ///< 0 or more, at most 2^53
  /// x and y within `farthest` [m], theta in [-pi, pi].
  SE2 transform(double farthest) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  const nlohmann::json& value_;
  std::string place_;
};

/// The value of a text. Throws JsonError.
nlohmann::json parse_json(std::string_view text);

}  // namespace gridmerge::internal
