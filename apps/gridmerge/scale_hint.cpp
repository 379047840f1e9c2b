// SPDX-License-Identifier: Apache-2.0
#include "scale_hint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "gridmerge/io/file_error.hpp"
#include "gridmerge/merge/plan.hpp"
#include "match/drawing.hpp"
#include "match/rounded_down.hpp"
#include "match/scale.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

/// Whether the drawing has walls that maps can hang on.
bool can_be_plan(const OccupancyGrid& drawing) {
  try {
    validate_plan({}, drawing);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace

std::string plan_hint(const NamedMap& map, const std::string& what_helps) {
  if (!is_drawing(map.grid) || !can_be_plan(map.grid)) return {};
  return fmt::format("hint: {} looks like a drawing of walls: {}\n", escape_controls(map.name), what_helps);
}

std::string scale_hint(const NamedMap& fixed, const NamedMap& moving, const MatchOptions& options) {
  const std::optional<ScaleFound> found = find_scale(fixed.grid, moving.grid, options);
  if (!found) return {};
  return fmt::format(
      "hint: {} fits {} at {:g} times its scale (probability {:.4f}): is its resolution {:g} m and not {:g} "
      "m, or "
      "that of {} {:g} m and not {:g} m?\n",
      escape_controls(moving.name), escape_controls(fixed.name), found->factor,
      rounded_down(found->probability), found->factor * moving.grid.resolution, moving.grid.resolution,
      escape_controls(fixed.name), fixed.grid.resolution / found->factor, fixed.grid.resolution);
}

namespace {

double known_area(const OccupancyGrid& grid) {
  return static_cast<double>(count_cells(grid).known()) * grid.resolution * grid.resolution;
}

}  // namespace

std::string range_hint(const NamedMap& fixed, const NamedMap& moving, const ScaleRange& scales,
                       const std::string& option) {
  const bool is_plan_moving = is_drawing(moving.grid);
  if (is_plan_moving == is_drawing(fixed.grid)) return {};
  const NamedMap &plan = is_plan_moving ? moving : fixed, &map = is_plan_moving ? fixed : moving;
  if (!can_be_plan(plan.grid)) return {};
  const double floor = known_area(map.grid), drawn = known_area(with_enclosed_free(plan.grid));
  if (floor <= 0.0 || drawn <= 0.0) return {};
  const double enlarged = std::sqrt(floor / drawn), equal = is_plan_moving ? enlarged : 1.0 / enlarged;
  if (equal >= scales.least && equal <= scales.most) return {};
  // A map may show a part of the plan alone, and a sheet has a frame.
  constexpr double kSlightly = 1.25, kMuch = 3.0;
  if (equal < kMuch * kMinScale || equal > kMaxScale / kMuch) return {};
  const double least = equal / (is_plan_moving ? kSlightly : kMuch);
  const double most = equal * (is_plan_moving ? kMuch : kSlightly);
  return fmt::format(
      "hint: what {} draws has {:.3g} times the floor of {} as it is: if the map shows most of it, the scale "
      "is "
      "near {:.2g}, and {} {:.2g}:{:.2g} looks there\n",
      escape_controls(plan.name), drawn / floor, escape_controls(map.name), equal, option, least, most);
}

}  // namespace gridmerge::cli
