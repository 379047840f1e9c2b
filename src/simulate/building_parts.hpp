// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/simulate/simulate.hpp"
#include "simulate/draughtsman.hpp"
#include "simulate/random.hpp"

namespace gridmerge::internal {

/// A rectangle of floor [m].
struct Room {
  double left, bottom, right, top;

  double width() const { return right - left; }
  double height() const { return top - bottom; }
};

/// What the parts of a building are drawn with: chance for walls, chance for furniture, so that two wings can
/// have the same walls and other furniture.
struct Hands {
  Draughtsman& pen;
  Random& walls;
  Random& furniture;
};

/// Adds `edges`, drawn in a frame of their own, at T_building_frame.
void place(Draughtsman& pen, const std::vector<Edge>& edges, const SE2& T_building_frame);

/// Four sides of a rectangle, each of them a window front or a wall.
void draw_shell(Draughtsman& pen, Random& random, const Room& room);

/// Cabinets along the walls of a room, desks and tables farther in.
void furnish(Draughtsman& pen, Random& random, const Room& room);

/// A row of rooms along a corridor, of one width or twice that, in a frame with the corridor's wall along x
/// from 0 to `length` and the rooms above it up to `depth`. Draws the corridor's wall, doors and partitions,
/// not the ends and the back.
void draw_row_of_rooms(const Hands& hands, double length, double depth);

/// One drawing function a kind, for buildings of `width` x `height` metres.
void draw_office(Draughtsman& pen, Random& random, double width, double height);
void draw_hall(Draughtsman& pen, Random& random, double width, double height);
void draw_warehouse(Draughtsman& pen, Random& random, double width, double height);
void draw_apartment(Draughtsman& pen, Random& random, double width, double height);
void draw_symmetric(Draughtsman& pen, Random& random, double width, double height);
void draw_loop(Draughtsman& pen, Random& random, double width, double height);
void draw_curved(Draughtsman& pen, Random& random, double width, double height);
void draw_outdoor(Draughtsman& pen, Random& random, double width, double height);
void draw_corridor(Draughtsman& pen, Random& random, double width, double height);
void draw_arena(Draughtsman& pen, Random& random, double width, double height);
void draw_maze(Draughtsman& pen, Random& random, double width, double height);
void draw_bare(Draughtsman& pen, Random& random, double width, double height);

}  // namespace gridmerge::internal
