// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulate/floor_plan.hpp"
#include "simulate/random.hpp"
#include "simulate/ray_caster.hpp"

namespace gridmerge::internal {

/// A building as one robot finds it, with what happens to stand about at that time.
struct Visit {
  RayCaster caster;
  FloorPlan plan;  ///< as large as that of the empty building
};

/// Scatters boxes and chairs, `clutter` on every 25 square metres of `plan` (the empty building's), never in
/// a doorway and never so that they shut off a part of the floor or the cell `start`.
Visit make_visit(const std::vector<Edge>& building, const FloorPlan& plan, double robot_radius, int start,
                 double clutter, Random& random);

/// People who walk about: discs that a beam meets.
class Walkers {
 public:
  /// `clutter` on every 150 square metres of floor.
  Walkers(const FloorPlan& plan, double clutter, Random random);

  /// Lets them walk for as long as a robot takes for a scan's way.
  void walk();
  /// Where a beam meets one of them; infinity when it meets none.
  double distance_to(Point2 from, Point2 direction, double range) const;

 private:
  struct Walker {
    Point2 at;
    Point2 step;
  };

  const FloorPlan& plan_;
  Random random_;
  std::vector<Walker> walkers_;
};

}  // namespace gridmerge::internal
