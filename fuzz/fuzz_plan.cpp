// SPDX-License-Identifier: Apache-2.0
// A picture that somebody takes for a plan: as a map, as a drawing whose walls enclose rooms, and, if it is
// small, with a part of it hung on it.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fuzz_target.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/plan.hpp"
#include "io/image.hpp"
#include "io/interpret.hpp"
#include "io/parse_error.hpp"
#include "match/drawing.hpp"

using namespace gridmerge;
using namespace gridmerge::internal;

namespace {

constexpr std::size_t kMaxPlanPixels = std::size_t{1} << 16;
constexpr int kMaxHungSide = 20;  // it takes some ten matches

/// Every wall is still one, in the same place, and what was no drawing is as it was.
void require_walls(const OccupancyGrid& plan, const OccupancyGrid& enclosed) {
  validate(enclosed);
  if (!is_drawing(plan)) {
    fuzz::require(enclosed.cells == plan.cells && enclosed.width == plan.width);
    return;
  }
  fuzz::require(enclosed.width <= plan.width && enclosed.height <= plan.height);
  const Point2 corner = inverse(plan.origin) * Point2{enclosed.origin.x, enclosed.origin.y};
  const auto left = static_cast<int>(std::lround(corner.x / plan.resolution));
  const auto bottom = static_cast<int>(std::lround(corner.y / plan.resolution));
  for (int row = 0; row < plan.height; ++row) {
    for (int column = 0; column < plan.width; ++column) {
      if (plan.at(column, row) != Cell::occupied) continue;
      const int x = column - left, y = row - bottom;
      fuzz::require(x >= 0 && y >= 0 && x < enclosed.width && y < enclosed.height);
      fuzz::require(enclosed.at(x, y) == Cell::occupied);
    }
  }
}

/// The plan's left half, in a frame of its own.
OccupancyGrid part_of(const OccupancyGrid& plan) {
  OccupancyGrid part =
      make_grid(std::max(1, plan.width / 2), plan.height, plan.resolution, {3.0, -2.0, 0.5}, Cell::unknown);
  for (int row = 0; row < part.height; ++row) {
    for (int column = 0; column < part.width; ++column) part.at(column, row) = plan.at(column, row);
  }
  return part;
}

void hang(const std::vector<OccupancyGrid>& maps, const OccupancyGrid& plan) {
  MergeOptions options;
  options.match.search = SearchMethod::quick;
  MergeResult result = place_on_plan(maps, plan, merge(maps, options), options, {{0.9, 1.1}, "plan", {}});
  fuzz::require(result.plan.has_value());
  fuzz::require(std::isfinite(result.plan->scale) && result.plan->scale > 0.0);
  for (const PlanPart& part : result.plan->parts) {
    fuzz::require(part.probability >= 0.0 && part.probability <= 1.0 && !part.maps.empty());
    fuzz::require(is_finite(part.T_plan_first));
  }
  for (const Component& component : result.components) validate(component.fused.grid);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  OccupancyGrid plan;
  try {
    const MapImage image = decode_image(fuzz::as_bytes(data, size), kMaxPlanPixels);
    MapYaml yaml;
    yaml.resolution = 0.05;
    plan = interpret(yaml, image).grid;
  } catch (const ParseError&) {
    return 0;
  }
  require_walls(plan, with_enclosed_free(plan));
  const std::vector<OccupancyGrid> maps{part_of(plan)};
  try {
    validate_plan(maps, plan);
  } catch (const std::invalid_argument&) {
    return 0;
  }
  if (std::max(plan.width, plan.height) <= kMaxHungSide) hang(maps, plan);
  return 0;
}
