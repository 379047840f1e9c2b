// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::paper {

/// Small, seeded, and the same on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  /// In [0, 1).
  double roll();
  double roll(double low, double high) { return low + (high - low) * roll(); }

 private:
  std::uint64_t state_;
};

/// A rectangle of floor [m].
struct Floor {
  double left, bottom, right, top;
};

/// A floor plan of 100 m x 100 m as the paper describes its own: an entrance hall, from which corridors lead
/// to rooms. Whatever is no floor is wall.
class Building {
 public:
  explicit Building(std::uint64_t seed);

  bool is_floor(const Point2& p) const;

 private:
  void add_rooms(Dice& dice, bool along_x, double corridor_low, double corridor_high, double from, double to);

  std::vector<Floor> floors_;
  std::vector<Floor> obstacles_;
};

struct RobotMap {
  OccupancyGrid map;
  SE2 T_building_map;  ///< the truth
};

/// What a robot sees of `building` from every half metre of `path`, with a range finder of 360 rays and
/// `range` metres, drawn on `side` x `side` cells of `resolution` metres in a frame of its own: about the
/// middle of the path, turned at will.
RobotMap explore(const Building& building, const std::vector<Point2>& path, double range, int side,
                 double resolution, std::uint64_t seed);

}  // namespace gridmerge::paper
