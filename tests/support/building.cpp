// SPDX-License-Identifier: Apache-2.0
#include "building.hpp"

#include <cmath>
#include <iomanip>
#include <limits>
#include <random>
#include <sstream>

#include "gridmerge/grid/resample.hpp"

namespace gridmerge::test {

namespace {

constexpr double kResolution = 0.1;
constexpr int kColumns = 180;
constexpr int kRows = 130;
constexpr int kWall = 2;      // cells
constexpr int kDoor = 9;      // cells
constexpr int kMinRoom = 22;  // cells

struct Room {
  int left, bottom, right, top;  // right and top exclusive
  int width() const { return right - left; }
  int height() const { return top - bottom; }
};

class Draughtsman {
 public:
  explicit Draughtsman(unsigned seed)
      : random_(seed), grid_(make_grid(kColumns, kRows, kResolution, {}, Cell::occupied)) {}

  OccupancyGrid draw() {
    const Room inside{kWall, kWall, kColumns - kWall, kRows - kWall};
    fill(inside, Cell::free);
    divide(inside);
    return grid_;
  }

 private:
  // Not a standard distribution: those differ between standard libraries, the engine does not.
  int pick(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }

  void fill(const Room& room, Cell cell) {
    for (int row = room.bottom; row < room.top; ++row) {
      for (int column = room.left; column < room.right; ++column) grid_.at(column, row) = cell;
    }
  }

  void divide(const Room& room) {
    const bool across = room.width() >= room.height();
    if ((across ? room.width() : room.height()) < 2 * kMinRoom + kWall) return furnish(room);
    Room first = room, wall = room, second = room, door = room;
    if (across) {
      first.right = wall.left = pick(room.left + kMinRoom, room.right - kMinRoom - kWall);
      second.left = wall.right = wall.left + kWall;
      door = wall;
      door.bottom = pick(room.bottom + 2, room.top - kDoor - 2);
      door.top = door.bottom + kDoor;
    } else {
      first.top = wall.bottom = pick(room.bottom + kMinRoom, room.top - kMinRoom - kWall);
      second.bottom = wall.top = wall.bottom + kWall;
      door = wall;
      door.left = pick(room.left + 2, room.right - kDoor - 2);
      door.right = door.left + kDoor;
    }
    divide(first);
    divide(second);
    fill(wall, Cell::occupied);
    fill(door, Cell::free);
  }

  void furnish(const Room& room) {
    for (int pieces = pick(1, 3); pieces > 0; --pieces) {
      const int width = pick(3, 9), height = pick(3, 7);
      const int left = pick(room.left + 1, room.right - width - 1);
      const int bottom = pick(room.bottom + 1, room.top - height - 1);
      fill({left, bottom, left + width, bottom + height}, Cell::occupied);
    }
  }

  std::mt19937 random_;
  OccupancyGrid grid_;
};

}  // namespace

OccupancyGrid draw_building(unsigned seed) {
  return Draughtsman(seed).draw();
}

OccupancyGrid map_part(const OccupancyGrid& building, const Window& window, const SE2& T_map_building) {
  OccupancyGrid part = building;
  for (int row = 0; row < part.height; ++row) {
    for (int column = 0; column < part.width; ++column) {
      const Point2 p = part.cell_centre(column, row);
      const bool seen = p.x > window.left && p.x < window.right && p.y > window.bottom && p.y < window.top;
      if (!seen) part.at(column, row) = Cell::unknown;
    }
  }
  return crop_to_known(transform_grid(part, T_map_building, part.resolution));
}

OccupancyGrid on_white_paper(const OccupancyGrid& map) {
  constexpr int kMargin = 10;
  OccupancyGrid paper =
      make_grid(map.width + 2 * kMargin, map.height + 2 * kMargin, map.resolution, {}, Cell::free);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == Cell::occupied) paper.at(column + kMargin, row + kMargin) = Cell::occupied;
    }
  }
  return paper;
}

std::string write_map(const TemporaryDirectory& directory, const std::string& name,
                      const OccupancyGrid& map) {
  std::string pgm = "P5\n" + std::to_string(map.width) + " " + std::to_string(map.height) + "\n255\n";
  for (int row = map.height - 1; row >= 0; --row) {
    for (int column = 0; column < map.width; ++column) {
      const Cell cell = map.at(column, row);
      pgm += static_cast<char>(cell == Cell::occupied ? 0 : cell == Cell::free ? 254 : 205);
    }
  }
  const std::string image = std::filesystem::path(name).filename().string() + ".pgm";
  directory.write(name + ".pgm", pgm);
  std::ostringstream yaml;
  yaml << std::setprecision(std::numeric_limits<double>::max_digits10) << "image: " << image
       << "\nresolution: " << map.resolution << "\norigin: [" << map.origin.x << ", " << map.origin.y << ", "
       << map.origin.theta << "]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
  return directory.write(name + ".yaml", yaml.str());
}

}  // namespace gridmerge::test
