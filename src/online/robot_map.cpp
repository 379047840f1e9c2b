// SPDX-License-Identifier: Apache-2.0
#include "online/robot_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "grid/changed_cells.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "similarity/agreement.hpp"

namespace gridmerge::internal {

namespace {

/// A map goes on from another one when it has kept most of what that knew, in the same place. Free space
/// agrees with free space in most poses, so that most has to be nearly all of it. A map that a closed loop
/// bent may fail too: then its pose is searched anew, which does no harm.
constexpr double kMinKept = 0.5;
constexpr double kMinAgreement = 0.9;
/// A closed loop shifts some walls, and leaves many where the robot began. In another frame a wall lies so
/// near to some wall [m] by chance, which two in five do in rooms that look alike.
constexpr double kBesideAWall = 0.2;
constexpr double kMinWallsKept = 0.5;

}  // namespace

MapChange change_between(const OccupancyGrid& before, const OccupancyGrid& after) {
  const auto area_of = [](const OccupancyGrid& grid) {
    return static_cast<double>(count_cells(grid).known()) * grid.resolution * grid.resolution;
  };
  const double known_before = area_of(before), known_after = area_of(after);
  if (known_before == 0.0 || known_after == 0.0) {
    const bool both_blank = known_before == known_after;
    return {both_blank ? 0.0 : 1.0, known_after < known_before};
  }
  // Cells of `before` are looked up, each of which stands for its area.
  const AgreementCounts counts = count_agreement(after, before, {});
  const double cell = before.resolution * before.resolution;
  const double both = static_cast<double>(counts.both_known()) * cell;
  const double equal = static_cast<double>(counts.agreement) * cell;
  const double share = 1.0 - equal / std::max(known_before, known_after);
  return {std::clamp(share, 0.0, 1.0), both < kMinKept * known_before || equal < kMinAgreement * both};
}

bool keeps_walls(const OccupancyGrid& before, const OccupancyGrid& after) {
  if (after.width > kMaxDistanceMapSides - after.height) return false;  // too long for distances
  const DistanceMap to_wall = make_distance_map(after, Cell::occupied);
  const int beside = std::max(1, static_cast<int>(kBesideAWall / after.resolution));
  const SE2 T_after_map = inverse(after.origin);
  std::size_t walls = 0, kept = 0;
  for (int row = 0; row < before.height; ++row) {
    for (int column = 0; column < before.width; ++column) {
      if (before.at(column, row) != Cell::occupied) continue;
      ++walls;
      const Point2 at = T_after_map * before.cell_centre(column, row);
      const double x = std::floor(at.x / after.resolution), y = std::floor(at.y / after.resolution);
      if (x < 0.0 || y < 0.0 || x >= after.width || y >= after.height) continue;
      if (to_wall.at(static_cast<int>(x), static_cast<int>(y)) <= beside) ++kept;
    }
  }
  return static_cast<double>(kept) >= kMinWallsKept * static_cast<double>(walls);
}

std::optional<ChangedCells> count_changed_cells(const OccupancyGrid& before, const OccupancyGrid& after) {
  const std::optional<CellBox> box = changed_cells(before, after);
  if (!box) return std::nullopt;
  ChangedCells changed;
  for (int row = box->bottom; row < box->top; ++row) {
    for (int column = box->left; column < box->right; ++column) {
      const Cell was = before.at(column, row), is = after.at(column, row);
      if (was == is) continue;
      ++changed.all;
      if (was == Cell::occupied || is == Cell::occupied) ++changed.walls;
    }
  }
  return changed;
}

}  // namespace gridmerge::internal
