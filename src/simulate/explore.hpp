// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "simulate/floor_plan.hpp"
#include "simulate/ray_caster.hpp"

namespace gridmerge::internal {

/// What has been seen of a floor: a raster of kPlanCells plan cells.
class SeenFloor {
 public:
  static constexpr int kPlanCells = 4;  // plan cells along a side of one

  explicit SeenFloor(const FloorPlan& plan);

  /// Marks what can be seen from a pose, up to `range` metres (up to `cleared` where nothing is met) and half
  /// of `field_of_view` to either side.
  void look(const RayCaster& caster, const SE2& from, double range, double cleared, double field_of_view);
  bool has_seen(int plan_cell) const { return seen_[index(plan_cell)] != 0; }
  int count() const;
  /// Cells that both have seen. For floors of one plan, or of plans of one size.
  friend int count_common(const SeenFloor& a, const SeenFloor& b);

 private:
  std::size_t index(int plan_cell) const;

  const FloorPlan* plan_;
  int width_;
  std::vector<std::uint8_t> seen_;
};

/// Where a robot may go, and how it goes about it.
struct Errand {
  int start = -1;            ///< cell of the plan
  double reach = 0.0;        ///< it goes to places at most so far from the start, as a robot goes [m]
  double longest_way = 0.0;  ///< [m]
  RangeFinder sensor;
  double scan_every = 0.3;  ///< [m]
  /// Which way it sets off [rad]: it goes to places ahead of its start only; anywhere, if not given.
  std::optional<double> heading = std::nullopt;
};

struct Exploration {
  std::vector<SE2> poses;  ///< T_building_robot, heading along the way, every `scan_every`
  SeenFloor seen;          ///< by the eyes
  SeenFloor drawn;         ///< by the range finder
};

/// Goes to the nearest place in reach that has not been seen, again and again, until there is none or the way
/// is long enough. The eyes see less far than the range finder, so that it comes near to things.
Exploration explore(const FloorPlan& plan, const RayCaster& caster, const Errand& errand);

}  // namespace gridmerge::internal
