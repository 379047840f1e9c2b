// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "simulate/random.hpp"
#include "simulate/rigid_fit.hpp"
#include "simulate/team.hpp"

namespace gridmerge::internal {

/// Where in its own frame a robot drew each place of the building, on average: squares of kCell metres. What
/// two robots' maps have in common, and how they should be laid on each other, follows from it without any
/// matching.
class DrawnPlaces {
 public:
  static constexpr double kCell = 0.25;  // [m]

  /// For places within `margin` metres of a building of `width` x `height`.
  DrawnPlaces(double width, double height, double margin);

  void add(Point2 in_building, Point2 in_map);
  int count() const;
  /// The mean place in the map for every square that was drawn: its centre in the building, and in the map.
  std::vector<PointPair> building_and_map() const;
  /// The same for squares that both drew, in the map of each. For places of one building.
  friend std::vector<PointPair> common_places(const DrawnPlaces& a, const DrawnPlaces& b);

 private:
  struct Sum {
    double building_x = 0.0, building_y = 0.0, x = 0.0, y = 0.0;
    int count = 0;
  };
  bool is_drawn(const Sum& sum) const { return sum.count >= kMin; }
  static constexpr int kMin = 3;  // beams; fewer leave a cell unknown

  double margin_;
  int width_;
  int height_;
  std::vector<Sum> sums_;
};

struct Survey {
  SimulatedMap map;
  DrawnPlaces places;
};

/// Draws the map of one robot that scans at the poses of `path` (T_building_robot, at least one), in the
/// building as it is on its visit.
Survey survey(const SimulateOptions& options, const Building& building, const Visit& visit,
              std::vector<SE2> path, Random random);

}  // namespace gridmerge::internal
