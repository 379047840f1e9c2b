// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge::internal {

/// An opening in a wall. `at` is its distance from the wall's first end [m]; `leaf` says to which side the
/// door stands open: 1 left of the wall's direction, -1 right, 0 for an opening with no door.
struct Door {
  double at = 0.0;
  double width = 0.9;
  int leaf = 0;
};

/// Draws with walls, boxes and furniture. Directions are vectors, not angles: with +, -, *, / and sqrt alone,
/// which IEEE 754 rounds exactly, every machine draws the same to the last bit.
class Draughtsman {
 public:
  std::vector<Edge> edges;  ///< what has been drawn

  void polygon(const std::vector<Point2>& corners, double echo = 1.0);

  /// A box around `centre`, its length along `direction` (any length but zero).
  void box(Point2 centre, double length, double width, Point2 direction = {1.0, 0.0}, double echo = 1.0);

  /// A wall 0.16 m thick. Doors come in the order of `at`, and do not overlap.
  void wall(Point2 from, Point2 to, const std::vector<Door>& doors = {}, double echo = 1.0);

  /// A wall of which every other metre and a half is window.
  void window_front(Point2 from, Point2 to);

  /// An octagon.
  void pillar(Point2 centre, double radius);

  /// Four legs: all that a laser near the floor sees of a table.
  void table(Point2 centre, double length, double width);

  void chair(Point2 centre);

  /// A table with a drawer unit under one end (`side` 1 right, -1 left) and a chair in front (`front` 1
  /// above, -1 below).
  void desk(Point2 centre, int side, int front);
};

}  // namespace gridmerge::internal
