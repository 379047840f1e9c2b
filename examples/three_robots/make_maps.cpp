// SPDX-License-Identifier: Apache-2.0
// Draws the example: three robots' maps of one office floor, a map of another building, and the truth about
// them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "building.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/map_file.hpp"
#include "mapping.hpp"

namespace {

using gridmerge::Cell;
using gridmerge::OccupancyGrid;
using gridmerge::Point2;
using gridmerge::example::Building;
using gridmerge::example::Pose;
using gridmerge::example::Trip;

constexpr double kTolerance = 0.5;  // [m]

struct RobotMap {
  std::string file;
  Pose frame;  ///< of the map, in the building
  OccupancyGrid grid;
};

/// The laboratory in the north-west, the offices and the archive south of the corridor, the meeting room.
Trip western_trip() {
  return {{0.3, 1.0},
          {{2.6, 21.0}, {6.2, 21.6}, {5.2, 19.2},  {5.4, 14.6}, {2.4, 13.9},  {2.4, 18.0}, {2.6, 14.0},
           {5.6, 14.3}, {7.1, 14.2}, {7.1, 12.4},  {4.8, 11.6}, {4.9, 9.8},   {3.0, 8.0},  {4.9, 9.8},
           {4.9, 11.6}, {1.2, 11.6}, {7.4, 11.6},  {7.5, 9.8},  {9.2, 8.6},   {9.2, 4.0},  {8.6, 3.9},
           {2.2, 4.0},  {2.2, 2.0},  {2.2, 4.0},   {8.6, 3.9},  {9.2, 4.0},   {9.2, 8.6},  {7.5, 9.8},
           {7.4, 11.6}, {9.7, 12.1}, {9.7, 14.4},  {9.7, 12.1}, {11.8, 11.4}, {11.7, 8.6}, {12.4, 2.4},
           {16.2, 3.0}, {17.2, 8.6}, {17.6, 11.7}, {20.2, 11.8}},
          11};
}

/// The middle: an office, the meeting room, the seminar room, the lobby, the corner office.
Trip central_trip() {
  return {{-1.0, 0.45},
          {{21.6, 8.2},  {19.8, 9.0},  {19.8, 11.6}, {17.6, 11.5}, {17.6, 8.8},  {16.8, 6.6},  {12.2, 6.7},
           {11.7, 9.6},  {11.7, 11.6}, {8.4, 11.6},  {15.7, 11.9}, {15.7, 14.6}, {15.7, 11.9}, {18.8, 12.0},
           {20.2, 14.4}, {17.9, 18.1}, {17.8, 19.3}, {15.6, 19.3}, {10.4, 19.2}, {10.0, 23.4}, {10.4, 19.2},
           {15.6, 19.3}, {18.0, 19.2}, {18.7, 20.0}, {18.7, 21.6}, {23.8, 21.6}, {26.4, 22.6}, {23.8, 21.6},
           {18.7, 21.6}, {18.7, 20.0}, {20.0, 17.4}, {20.2, 14.0}, {20.2, 11.7}, {27.5, 11.6}, {27.5, 14.6},
           {25.2, 14.9}, {27.5, 14.6}, {27.5, 11.6}, {29.6, 11.8}},
          22};
}

/// The kitchen, the offices in the east, the open-plan office, the glazed office and the lobby.
Trip eastern_trip() {
  return {{-0.55, -0.8},
          {{32.7, 8.6},  {32.6, 5.6},  {35.8, 5.4},  {35.6, 8.9},  {37.8, 9.0},  {37.9, 5.6},  {37.8, 9.0},
           {35.4, 8.9},  {32.7, 9.4},  {32.7, 11.6}, {38.6, 11.6}, {37.0, 11.7}, {37.2, 14.6}, {35.6, 16.4},
           {37.2, 14.6}, {37.0, 11.7}, {30.0, 11.6}, {29.9, 14.2}, {31.2, 16.2}, {29.9, 14.2}, {29.8, 11.7},
           {25.3, 11.6}, {25.2, 8.8},  {27.6, 7.8},  {29.8, 4.8},  {29.6, 1.4},  {26.8, 1.0},  {26.8, 4.2},
           {24.0, 4.8},  {24.0, 8.6},  {25.2, 9.4},  {25.2, 11.6}, {27.4, 11.8}, {27.5, 14.0}, {26.9, 19.2},
           {23.6, 19.4}, {26.9, 19.2}, {27.5, 14.0}, {27.4, 11.8}, {20.4, 11.7}, {19.9, 14.8}, {18.4, 18.6}},
          33};
}

Trip workshop_trip() {
  return {{0.9, -0.5},
          {{2.6, 7.2},   {2.6, 4.2},   {3.2, 2.6},   {2.6, 4.2},   {2.6, 7.0},   {8.3, 7.2},  {8.4, 4.0},
           {10.2, 1.2},  {8.4, 4.0},   {8.3, 7.2},   {7.0, 10.8},  {2.0, 11.4},  {2.2, 15.6}, {7.4, 15.6},
           {10.4, 13.4}, {13.6, 10.6}, {17.2, 14.2}, {18.4, 13.0}, {21.0, 10.8}, {24.8, 8.4}, {24.7, 4.4},
           {22.6, 3.6},  {20.4, 4.6},  {17.6, 4.6},  {13.4, 2.6},  {12.8, 6.8},  {16.6, 9.4}},
          44};
}

RobotMap explore(const std::string& file, const Building& building, const Trip& trip) {
  return {file, gridmerge::example::start_pose(trip), gridmerge::example::map_building(building, trip)};
}

/// A point of `moving`'s frame in `fixed`'s. Exactly rounded operations only, as in the mapping.
Point2 in_other_frame(const Pose& fixed, const Pose& moving, Point2 p) {
  const Point2 in_building{moving.position.x + p.x * moving.heading.x - p.y * moving.heading.y,
                           moving.position.y + p.x * moving.heading.y + p.y * moving.heading.x};
  const double x = in_building.x - fixed.position.x;
  const double y = in_building.y - fixed.position.y;
  return {x * fixed.heading.x + y * fixed.heading.y, y * fixed.heading.x - x * fixed.heading.y};
}

struct Shared {
  std::size_t known = 0;     ///< cells of the moving map that lie on known cells of the fixed one
  std::size_t wall = 0;      ///< those of them that are occupied
  std::size_t matching = 0;  ///< those of the latter with an occupied cell of the fixed map on or beside them
};

Shared shared_cells(const RobotMap& fixed, const RobotMap& moving) {
  Shared shared;
  const auto says = [&](int column, int row, Cell cell) {
    return fixed.grid.contains(column, row) && fixed.grid.at(column, row) == cell;
  };
  for (int row = 0; row < moving.grid.height; ++row) {
    for (int column = 0; column < moving.grid.width; ++column) {
      const Cell cell = moving.grid.at(column, row);
      if (cell == Cell::unknown) continue;
      const Point2 p = in_other_frame(fixed.frame, moving.frame, moving.grid.cell_centre(column, row));
      const int c = static_cast<int>(std::floor((p.x - fixed.grid.origin.x) / fixed.grid.resolution));
      const int r = static_cast<int>(std::floor((p.y - fixed.grid.origin.y) / fixed.grid.resolution));
      if (!says(c, r, Cell::free) && !says(c, r, Cell::occupied)) continue;
      ++shared.known;
      if (cell != Cell::occupied) continue;
      ++shared.wall;
      bool beside = false;
      for (int dr = -1; dr <= 1; ++dr) {
        for (int dc = -1; dc <= 1; ++dc) beside = beside || says(c + dc, r + dr, Cell::occupied);
      }
      if (beside) ++shared.matching;
    }
  }
  return shared;
}

char tier_of(const Shared& shared) {
  const double match =
      shared.wall == 0 ? 0.0 : static_cast<double>(shared.matching) / static_cast<double>(shared.wall);
  if (shared.wall >= 400 && match >= 0.8) return 'A';
  return shared.wall >= 150 && match >= 0.6 ? 'B' : 'C';
}

/// "x y theta" of T_fixed_moving, tab separated.
std::string transform_columns(const Pose& fixed, const Pose& moving) {
  const Point2 at = in_other_frame(fixed, moving, {0.0, 0.0});
  const Point2 ahead = in_other_frame(fixed, moving, {1.0, 0.0});
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%.6f\t%.6f\t%.6f", at.x, at.y,
                std::atan2(ahead.y - at.y, ahead.x - at.x));
  return text.data();
}

std::string pair_line(const RobotMap& fixed, const RobotMap& moving) {
  const Shared shared = shared_cells(fixed, moving);
  const std::size_t smaller = std::min(count_cells(fixed.grid).known(), count_cells(moving.grid).known());
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "\t%.6f\t%c\t%.6f\n", kTolerance, tier_of(shared),
                static_cast<double>(shared.known) / static_cast<double>(smaller));
  return fixed.file + '\t' + moving.file + '\t' + transform_columns(fixed.frame, moving.frame) + text.data();
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

void write_example(const std::filesystem::path& directory) {
  const Building office = gridmerge::example::office_floor();
  const std::vector<RobotMap> robots{explore("robot_1.yaml", office, western_trip()),
                                     explore("robot_2.yaml", office, central_trip()),
                                     explore("robot_3.yaml", office, eastern_trip())};
  const RobotMap elsewhere = explore("elsewhere.yaml", gridmerge::example::workshop(), workshop_trip());

  std::string pairs = "fixed\tmoving\tx\ty\ttheta\ttolerance\ttier\toverlap\n";
  std::string negatives = "fixed\tmoving\n";
  std::string sets = "set\tmap\tx\ty\ttheta\ttolerance\n";
  std::array<char, 32> tolerance{};
  std::snprintf(tolerance.data(), tolerance.size(), "\t%.6f\n", kTolerance);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = i + 1; j < robots.size(); ++j) pairs += pair_line(robots[i], robots[j]);
    negatives += robots[i].file + '\t' + elsewhere.file + '\n';
    sets += "office\t" + robots[i].file + '\t' + transform_columns(robots[0].frame, robots[i].frame) +
            tolerance.data();
    save_map(robots[i].grid, directory / robots[i].file);
  }
  save_map(elsewhere.grid, directory / elsewhere.file);
  write_text(directory / "pairs.tsv", pairs);
  write_text(directory / "negatives.tsv", negatives);
  write_text(directory / "sets.tsv", sets);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_maps DIRECTORY\n");
    return 2;
  }
  try {
    std::filesystem::create_directories(argv[1]);
    write_example(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_maps: %s\n", error.what());
    return 1;
  }
  return 0;
}
