// SPDX-License-Identifier: Apache-2.0
#include "preselect/signature.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "grid/box.hpp"
#include "grid/quarter_turned.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kCell = 0.2;           // [m]
constexpr double kMaxCells = 1 << 20;   // of a signature
constexpr std::size_t kMaxWalls = 240;  // sampled
constexpr std::size_t kMaxKeypoints = 64;

constexpr double kCornerReach = 1.0;    // walls within it make a corner [m]
constexpr double kMinCornerness = 0.3;  // 0 where all walls are parallel, 1 where two ways are equally common
constexpr int kMinCornerWalls = 5;      // fewer are noise
constexpr double kKeypointSpacing = 0.9;  // [m]
constexpr double kDirectionReach = 2.5;   // walls within it tell a keypoint's direction [m]

/// The rings of a descriptor, and how far from a wall counts as near on each: what is farther off is less
/// exactly where it is expected.
struct Ring {
  double radius;  // [m]
  int places;
  double near;  // [m]
};
constexpr std::array<Ring, 6> kRings{
    {{0.6, 8, 0.3}, {1.3, 12, 0.4}, {2.2, 16, 0.5}, {3.3, 20, 0.65}, {4.7, 20, 0.8}, {6.5, 20, 1.0}}};
constexpr double kLength = 4096.0;  // of a descriptor
constexpr double kMinSeen = 36.0;   // places: with fewer a descriptor is shorter

constexpr double kMetWithin = 0.5;  // [m]
constexpr double kOpenFrom = 1.0;   // [m]
/// Of all ways in which walls face, the share that counts as the same.
constexpr double kFacesAlike = (2.0 * kMostTurned + 1.0) / kDirections;

/// Wall points by cells, to find those nearby.
class Nearby {
 public:
  Nearby(const LikelihoodField& field)
      : field_(field), first_(static_cast<std::size_t>(field.width) * field.height, -1) {
    for (int i = 0; i < std::ssize(field.walls); ++i) {
      const Point2& at = field.walls[i].position;
      first_[field.index(static_cast<int>(at.x), static_cast<int>(at.y))] = i;
    }
  }

  /// Calls `visit(wall, squared distance [cells^2])` for each wall within `reach` cells.
  template <typename Visit>
  void visit(const Point2& about, double reach, Visit visit) const {
    const int whole = static_cast<int>(std::ceil(reach));
    const int x0 = static_cast<int>(about.x), y0 = static_cast<int>(about.y);
    for (int y = std::max(0, y0 - whole); y <= std::min(field_.height - 1, y0 + whole); ++y) {
      for (int x = std::max(0, x0 - whole); x <= std::min(field_.width - 1, x0 + whole); ++x) {
        const int wall = first_[field_.index(x, y)];
        if (wall < 0) continue;
        const Point2& at = field_.walls[wall].position;
        const double squared = (at.x - about.x) * (at.x - about.x) + (at.y - about.y) * (at.y - about.y);
        if (squared <= reach * reach) visit(field_.walls[wall], squared);
      }
    }
  }

 private:
  const LikelihoodField& field_;
  std::vector<int> first_;  // a cell holds one wall at most
};

struct Corner {
  Point2 position;  // [cells]
  double strength;
};

/// Corners, strongest first; none near a stronger one.
std::vector<Corner> find_corners(const LikelihoodField& field, const Nearby& nearby) {
  std::vector<Corner> all;
  for (const WallPoint& wall : field.walls) {
    if (wall.facing == kNoDirection) continue;
    double c = 0.0, s = 0.0;  // of the doubled angles: 0 where two ways at right angles are equally common
    int count = 0;
    nearby.visit(wall.position, kCornerReach / field.cell, [&](const WallPoint& other, double) {
      if (other.facing == kNoDirection) return;
      const double doubled = 2.0 * angle_of(other.facing);
      c += std::cos(doubled);
      s += std::sin(doubled);
      ++count;
    });
    if (count < kMinCornerWalls) continue;
    const double parallel = std::hypot(c, s) / count;
    if (1.0 - parallel < kMinCornerness) continue;
    all.push_back({wall.position, (1.0 - parallel) * std::sqrt(static_cast<double>(count))});
  }
  std::sort(all.begin(), all.end(), [](const Corner& a, const Corner& b) {
    return std::tuple(-a.strength, a.position.x, a.position.y) <
           std::tuple(-b.strength, b.position.x, b.position.y);
  });
  const double spacing = kKeypointSpacing / field.cell;
  std::vector<Corner> kept;
  for (const Corner& corner : all) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Corner& other) {
      return std::hypot(corner.position.x - other.position.x, corner.position.y - other.position.y) < spacing;
    });
    if (is_new) kept.push_back(corner);
    if (kept.size() == kMaxKeypoints) break;
  }
  return kept;
}

/// The direction of the walls about a point, up to quarters of a turn.
double direction_about(const LikelihoodField& field, const Nearby& nearby, const Point2& at) {
  double c = 0.0, s = 0.0;
  nearby.visit(at, kDirectionReach / field.cell, [&](const WallPoint& wall, double) {
    if (wall.facing == kNoDirection) return;
    c += std::cos(4.0 * angle_of(wall.facing));
    s += std::sin(4.0 * angle_of(wall.facing));
  });
  const double theta = std::atan2(s, c) / 4.0;
  return theta < 0.0 ? theta + std::numbers::pi / 2.0 : theta;
}

Descriptor describe(const Signature& map, const Keypoint& keypoint,
                    const std::array<double, kRings.size()>& usual) {
  std::array<double, kDescriptorSize> values{};
  std::size_t i = 0, seen = 0;
  for (std::size_t r = 0; r < kRings.size(); ++r) {
    const Ring& ring = kRings[r];
    for (int place = 0; place < ring.places; ++place, ++i) {
      const double angle = keypoint.theta + 2.0 * std::numbers::pi * place / ring.places;
      const Place at = map.place_at({keypoint.position.x + ring.radius * std::cos(angle),
                                     keypoint.position.y + ring.radius * std::sin(angle)});
      if (at.distance == kUnseen) continue;
      const double far = at.distance * map.cell / ring.near;
      values[i] = std::exp(-far * far) - usual[r];
      ++seen;
    }
  }
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  Descriptor descriptor{};
  if (squares == 0.0) return descriptor;
  const double scale =
      kLength * std::min(1.0, std::sqrt(static_cast<double>(seen) / kMinSeen)) / std::sqrt(squares);
  for (std::size_t k = 0; k < kDescriptorSize; ++k)
    descriptor[k] = static_cast<std::int16_t>(std::lround(scale * values[k]));
  return descriptor;
}

/// The mean nearness of walls for each ring, over all places that were seen.
std::array<double, kRings.size()> usual_nearness(const LikelihoodField& field) {
  std::array<double, kRings.size()> usual{};
  for (std::size_t r = 0; r < kRings.size(); ++r) {
    for (int bin = 0; bin < kDistanceBins; ++bin) {
      const double far = bin * field.cell / kRings[r].near;
      usual[r] += field.background[bin] * std::exp(-far * far);
    }
  }
  return usual;
}

double cell_for(const OccupancyGrid& grid) {
  const double area = static_cast<double>(grid.width) * grid.height * grid.resolution * grid.resolution;
  return std::max({kCell, grid.resolution, std::sqrt(area / kMaxCells)});
}

}  // namespace

Descriptor quarter_turned(const Descriptor& descriptor, int quarters) {
  Descriptor turned{};
  std::size_t first = 0;
  for (const Ring& ring : kRings) {
    const auto places = static_cast<std::size_t>(ring.places);
    const std::size_t shift = places / 4 * static_cast<std::size_t>(((quarters % 4) + 4) % 4);
    const auto ring_begin = descriptor.begin() + static_cast<std::ptrdiff_t>(first);
    std::rotate_copy(ring_begin, ring_begin + static_cast<std::ptrdiff_t>(shift),
                     ring_begin + static_cast<std::ptrdiff_t>(places),
                     turned.begin() + static_cast<std::ptrdiff_t>(first));
    first += places;
  }
  return turned;
}

Signature make_signature(const OccupancyGrid& grid) {
  const LikelihoodField field = make_likelihood_field(grid, cell_for(grid));
  Signature signature;
  signature.cell = field.cell;
  signature.width = field.width;
  signature.height = field.height;
  signature.T_map_grid = field.T_map_grid;
  signature.places = field.places;
  signature.wall_length = field.cell * static_cast<double>(field.walls.size());
  signature.known_area = static_cast<double>(count_cells(grid).known()) * grid.resolution * grid.resolution;
  signature.met_within = static_cast<int>(kMetWithin / field.cell);
  signature.open_from = std::min(static_cast<int>(std::ceil(kOpenFrom / field.cell)), kDistanceBins - 1);
  for (int bin = 0; bin <= signature.met_within; ++bin)
    signature.chance_of_meeting += kFacesAlike * field.background[bin];

  std::vector<const WallPoint*> facing;
  for (const WallPoint& wall : field.walls) {
    if (wall.facing != kNoDirection) facing.push_back(&wall);
  }
  const std::size_t samples = std::min(kMaxWalls, facing.size());
  for (std::size_t i = 0; i < samples; ++i) {
    const WallPoint& wall = *facing[(2 * i + 1) * facing.size() / (2 * samples)];
    signature.walls.push_back({{wall.position.x * field.cell, wall.position.y * field.cell}, wall.facing});
  }

  signature.profiles = make_profiles(field);

  const Nearby nearby(field);
  const std::array<double, kRings.size()> usual = usual_nearness(field);
  for (const Corner& corner : find_corners(field, nearby)) {
    Keypoint keypoint{{corner.position.x * field.cell, corner.position.y * field.cell},
                      direction_about(field, nearby, corner.position)};
    signature.descriptors.push_back(describe(signature, keypoint, usual));
    signature.keypoints.push_back(keypoint);
  }
  return signature;
}

}  // namespace gridmerge::internal
