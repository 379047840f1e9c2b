// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "simulate/building_parts.hpp"
#include "simulate/random.hpp"

namespace gridmerge::internal {

enum class Side { bottom, right, top, left };

/// Floor that is painted as rectangles, each a part of some space. Walls stand wherever two spaces meet, and
/// where a space meets what is not painted.
class PaintedFloor {
 public:
  /// Nothing can be added outside `frame`.
  explicit PaintedFloor(const Room& frame) : frame_(frame) {}

  /// Paints a rectangle. Later ones cover earlier ones.
  void paint(const Room& room, int space) { parts_.push_back({room, space}); }

  int new_space() { return ++spaces_; }

  /// A rectangle outside of `room`, on one of its sides: `at` and `length` along the side, from its left or
  /// lower end, and `depth` away from it. Nothing where it would leave the frame or come too near to floor
  /// that is painted already.
  std::optional<Room> beside(const Room& room, Side side, double at, double length, double depth) const;

  /// An opening in the wall on a side of `room`, `at` as above.
  void open(const Room& room, Side side, double at, double width);

  /// Draws all walls, each run of them as long as it goes.
  void draw_walls(Draughtsman& pen) const;

 private:
  struct Part {
    Room room;
    int space;
  };
  struct Opening {
    bool upright;  // in a wall along y
    double line;   // x of such a wall; y of another
    double from;
    double width;
  };

  int space_at(Point2 p) const;
  void draw_line(Draughtsman& pen, bool upright, const std::vector<double>& lines, std::size_t line,
                 const std::vector<double>& ticks) const;
  void draw_run(Draughtsman& pen, bool upright, double line, double from, double to) const;

  Room frame_;
  std::vector<Part> parts_;
  std::vector<Opening> openings_;
  int spaces_ = 0;
};

/// What breaks a long wall.
struct Features {
  double least_gap, most_gap;  ///< wall between two of them [m]
  double closed_doors;         ///< share that are doors in a shallow recess, kept shut
  double rooms;                ///< share that are side rooms with an open door
  double room_depth;           ///< of the deepest side room [m]
};

/// Adds doors, side rooms and niches along one side of `room`, which is part of `space`. Returns how many.
int add_features(PaintedFloor& floor, Random& random, const Room& room, Side side, int space,
                 const Features& features);

}  // namespace gridmerge::internal
