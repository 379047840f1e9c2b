// SPDX-License-Identifier: Apache-2.0
#include "match/walls_met.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "grid/multiversion.hpp"
#include "grid/parallel.hpp"
#include "match/ascend.hpp"
#include "match/refine.hpp"
#include "similarity/evidence.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kPatchSide = 6.0;      // [m]
constexpr double kMinPatchSide = 60.0;  // [cells]
constexpr double kFarthestShift = 1.2;  // [m]
constexpr double kFirstStep = 0.4;      // [m]
constexpr double kLastStep = 0.5;       // [cells]
constexpr double kMinWall = 2.0;        // that a patch must have where both have seen, to move [m]
constexpr int kMeetingDistance = 2;     // [cells]
constexpr std::size_t kClimbingWalls = 60;

/// A wall that lies in what the other map has not seen is worth this much when a patch climbs: about what an
/// unrelated wall is, so that a patch neither flees from what is seen nor is held in it.
constexpr double kUnseenWorth = 0.3;

struct Meetings {
  double seen = 0.0;         // walls where the other map has seen
  double met = 0.0;          // of these, the walls that meet another one
  double seen_things = 0.0;  // the same of walls of things that stand alone
  double things_met = 0.0;

  Meetings& operator+=(const Meetings& other) {
    seen += other.seen;
    met += other.met;
    seen_things += other.seen_things;
    things_met += other.things_met;
    return *this;
  }
};

/// Whether a wall turned by so many steps is contrary to another one, by both facings.
using ContraryFacings = std::array<std::array<std::array<bool, kFacingCodes>, kFacingCodes>, kDirections>;
const ContraryFacings& contrary_facings() {
  static const ContraryFacings table = [] {
    ContraryFacings contrary{};
    for (int steps = 0; steps < kDirections; ++steps) {
      for (int a = 0; a < kFacingCodes; ++a) {
        for (int b = 0; b < kFacingCodes; ++b) {
          const std::uint8_t turned_a = turned(static_cast<std::uint8_t>(a), steps);
          contrary[steps][a][b] =
              facing_class(turned_a, static_cast<std::uint8_t>(b)) >= kFirstContraryFacing;
        }
      }
    }
    return contrary;
  }();
  return table;
}

/// What a wall is worth by its distance from another one [cells].
constexpr auto kWorth = [] {
  std::array<double, kDistanceBins> worth{};
  for (int bin = 0; bin < kDistanceBins; ++bin) worth[bin] = 1.0 / (1.0 + bin * bin / 6.0);
  return worth;
}();

Meetings count_meetings(const LikelihoodField& map, const std::vector<WallPoint>& walls,
                        const SE2& T_map_walls) {
  const auto& is_contrary = contrary_facings()[steps_of_turn(T_map_walls.theta)];
  const ManyPointsTransform T_points(T_map_walls);
  Meetings meetings;
  for (const WallPoint& wall : walls) {
    const Place place = map.place_at(T_points * wall.position);
    if (place.distance == kUnseen) continue;
    meetings.seen += 1.0;
    if (wall.stands_alone) meetings.seen_things += 1.0;
    if (place.distance > kMeetingDistance || is_contrary[wall.facing][place.facing]) continue;
    meetings.met += 1.0;
    if (wall.stands_alone) meetings.things_met += 1.0;
  }
  return meetings;
}

/// Evenly drawn walls of a patch, to be looked up many times.
struct ClimbingWalls {
  explicit ClimbingWalls(const std::vector<WallPoint>& all) {
    for (const WallPoint& wall : draw_evenly(all, kClimbingWalls)) {
      x[count] = wall.position.x;
      y[count] = wall.position.y;
      facing[count++] = wall.facing;
    }
    weight = count == 0 ? 0.0 : static_cast<double>(all.size()) / static_cast<double>(count);
  }

  std::array<double, kClimbingWalls> x, y;          // [cells]
  std::array<std::uint8_t, kClimbingWalls> facing;  // of each
  std::size_t count = 0;
  double weight;  // walls that each of them stands for
};

/// Where each of `count` points falls in the places of a map of that size; 0, which is never seen, if
/// outside. The same bits in every version: no operation is fused or reordered.
GRIDMERGE_MULTIVERSION
void find_places(const double* px, const double* py, std::size_t count, double c, double s, double tx,
                 double ty, int width, int height, int* at) {
  for (std::size_t i = 0; i < count; ++i) {
    const double x = c * px[i] - s * py[i] + tx;
    const double y = s * px[i] + c * py[i] + ty;
    const bool is_inside = (x >= 0.0) & (y >= 0.0) & (x < width) & (y < height);
    const int column = static_cast<int>(is_inside ? x : 0.0), row = static_cast<int>(is_inside ? y : 0.0);
    at[i] = row * width + column;
  }
}

/// What a patch climbs on: 1 for a wall on another one, less with their distance.
double worth_of(const LikelihoodField& map, const ClimbingWalls& walls, const SE2& T_map_walls) {
  const auto& is_contrary = contrary_facings()[steps_of_turn(T_map_walls.theta)];
  std::array<int, kClimbingWalls> at;
  find_places(walls.x.data(), walls.y.data(), walls.count, std::cos(T_map_walls.theta),
              std::sin(T_map_walls.theta), T_map_walls.x, T_map_walls.y, map.width, map.height, at.data());
  double worth = 0.0;
  std::size_t unseen = 0;
  for (std::size_t i = 0; i < walls.count; ++i) {
    const Place place = map.places[static_cast<std::size_t>(at[i])];
    if (place.distance == kUnseen) {
      ++unseen;
    } else if (!is_contrary[walls.facing[i]][place.facing]) {
      worth += kWorth[place.distance];
    }
  }
  return worth + kUnseenWorth * static_cast<double>(unseen);
}

/// The fixed map's walls by the moving map's patches, without those that lie in none: the moving map cannot
/// have seen them.
std::vector<std::vector<WallPoint>> cut(const LikelihoodField& fixed, const WallPatches& moving,
                                        const SE2& T_fixed_moving) {
  std::vector<std::vector<WallPoint>> walls(moving.size());
  const ManyPointsTransform T_moving_fixed(inverse(T_fixed_moving));
  for (const WallPoint& wall : fixed.walls) {
    const Point2 p = T_moving_fixed * wall.position;
    if (moving.cover(p)) walls[moving.index(p)].push_back(wall);
  }
  return walls;
}

/// The walls of both maps in one patch, each in its own map's grid frame.
struct Patch {
  Point2 centre;  // [cells, moving grid frame]
  const std::vector<WallPoint>& fixed;
  const std::vector<WallPoint>& moving;
};

class PatchMatcher {
 public:
  PatchMatcher(const LikelihoodField& fixed, const LikelihoodField& moving, const SE2& T_fixed_moving,
               double side)
      : fixed_(fixed), moving_(moving), start_(T_fixed_moving), side_(side) {}

  Meetings rigidly(const Patch& patch) const { return at(patch, start_); }

  /// `rigid` is what rigidly() says of the patch.
  Meetings locally(const Patch& patch, const Meetings& rigid) const {
    if (patch.moving.empty() || rigid.seen * fixed_.cell < kMinWall) return rigid;
    return at(patch, climb(patch));
  }

 private:
  Meetings at(const Patch& patch, const SE2& T_fixed_moving) const {
    Meetings sum = count_meetings(fixed_, patch.moving, T_fixed_moving);
    sum += count_meetings(moving_, patch.fixed, inverse(T_fixed_moving));
    return sum;
  }

  SE2 climb(const Patch& patch) const {
    constexpr int kMaxMoves = 5;
    const ClimbingWalls fixed_walls(patch.fixed), moving_walls(patch.moving);
    const PoseMetric metric{patch.centre, 0.4 * side_};
    const auto worth_at = [&](const SE2& T_fixed_moving) {
      return moving_walls.weight * worth_of(fixed_, moving_walls, T_fixed_moving) +
             fixed_walls.weight * worth_of(moving_, fixed_walls, inverse(T_fixed_moving));
    };
    double most = worth_at(start_);
    return ascend(metric, start_, {kFirstStep / fixed_.cell, kLastStep, kMaxMoves}, [&](const SE2& pose) {
      if (metric.displacement(pose, start_) > kFarthestShift / fixed_.cell) return false;
      const double worth = worth_at(pose);
      if (worth <= most) return false;
      most = worth;
      return true;
    });
  }

  const LikelihoodField& fixed_;
  const LikelihoodField& moving_;
  SE2 start_;
  double side_;
};

Meetings sum_of(const std::vector<Meetings>& patches) {
  Meetings sum;
  for (const Meetings& patch : patches) sum += patch;
  return sum;
}

double share(double part, double whole) {
  return whole > 0.0 ? part / whole : 0.0;
}

}  // namespace

WallPatches::WallPatches(const LikelihoodField& map)
    : map_(map),
      side_(std::max(kPatchSide / map.cell, kMinPatchSide)),
      columns_(static_cast<std::size_t>(map.width / side_) + 1),
      rows_(static_cast<std::size_t>(map.height / side_) + 1),
      walls_(columns_ * rows_) {
  for (const WallPoint& wall : map.walls) walls_[index(wall.position)].push_back(wall);
}

bool WallPatches::cover(const Point2& point) const {
  return point.x >= 0.0 && point.y >= 0.0 && point.x < static_cast<double>(columns_) * side_ &&
         point.y < static_cast<double>(rows_) * side_;
}

std::size_t WallPatches::index(const Point2& point) const {
  return static_cast<std::size_t>(point.y / side_) * columns_ + static_cast<std::size_t>(point.x / side_);
}

Point2 WallPatches::centre(std::size_t patch) const {
  const std::size_t column = patch % columns_, row = patch / columns_;
  return {(static_cast<double>(column) + 0.5) * side_, (static_cast<double>(row) + 0.5) * side_};
}

WallsMet measure_walls_met(const LikelihoodField& fixed, const WallPatches& moving,
                           const SE2& T_fixed_moving_cells) {
  const std::vector<std::vector<WallPoint>> fixed_walls = cut(fixed, moving, T_fixed_moving_cells);
  const PatchMatcher matcher(fixed, moving.map(), T_fixed_moving_cells, moving.side());
  std::vector<Meetings> rigidly(moving.size()), locally(moving.size());
  parallel_for(moving.size(), [&](std::size_t i) {
    const Patch patch{moving.centre(i), fixed_walls[i], moving.walls(i)};
    rigidly[i] = matcher.rigidly(patch);
    locally[i] = matcher.locally(patch, rigidly[i]);
  });
  const Meetings rigid = sum_of(rigidly), local = sum_of(locally);
  return {share(rigid.met, rigid.seen), share(local.met, local.seen), local.seen_things,
          share(local.things_met, local.seen_things)};
}

}  // namespace gridmerge::internal
