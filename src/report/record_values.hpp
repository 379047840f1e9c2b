// SPDX-License-Identifier: Apache-2.0
// What the readers of the parts of transforms.json have in common. Each throws JsonError.
#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "gridmerge/match/match_result.hpp"
#include "report/json_reader.hpp"

namespace gridmerge::internal {

/// [m]: maps' origins are within 1e9, and poses were multiplied a few times.
inline constexpr double kFarthest = 1e12;

/// A number in [0, 1], but for rounding: probabilities are differences, too.
double read_share(const JsonReader& json);

/// The one of `values` that name_of() calls so.
template <typename Enum, std::size_t N>
Enum one_of(const JsonReader& json, const std::array<Enum, N>& values) {
  const std::string name = json.text();
  const auto found =
      std::find_if(values.begin(), values.end(), [&](Enum value) { return name == name_of(value); });
  if (found == values.end()) json.fail("is unknown: '" + name + "'");
  return *found;
}

Reason read_reason(const JsonReader& json);

}  // namespace gridmerge::internal
