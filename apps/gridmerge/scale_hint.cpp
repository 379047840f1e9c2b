// SPDX-License-Identifier: Apache-2.0
#include "scale_hint.hpp"

#include <fmt/format.h>

#include <optional>

#include "gridmerge/io/file_error.hpp"
#include "match/drawing.hpp"
#include "match/scale.hpp"

namespace gridmerge::cli {

using namespace internal;

std::string plan_hint(const NamedMap& map, const std::string& what_helps) {
  if (!is_drawing(map.grid)) return {};
  return fmt::format("hint: {} looks like a drawing of walls: {}\n", escape_controls(map.name), what_helps);
}

std::string scale_hint(const NamedMap& fixed, const NamedMap& moving, const MatchOptions& options) {
  const std::optional<ScaleFound> found = find_scale(fixed.grid, moving.grid, options);
  if (!found) return {};
  return fmt::format(
      "hint: {} fits {} at {:g} times its scale (probability {:.4f}): is its resolution {:g} m and not {:g} "
      "m, or "
      "that of {} {:g} m and not {:g} m?\n",
      escape_controls(moving.name), escape_controls(fixed.name), found->factor, found->probability,
      found->factor * moving.grid.resolution, moving.grid.resolution, escape_controls(fixed.name),
      fixed.grid.resolution / found->factor, fixed.grid.resolution);
}

}  // namespace gridmerge::cli
