// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kReachOfLine = 0.45;         // [m]: walls so near say which way one runs
constexpr double kCellsOfLine = 3.0;          // and at least so many cells
constexpr double kMostThickness = 0.25;       // of a line: its variance across, of that along
constexpr double kAlike = 0.8;                // cosine of the angle between normals
constexpr double kLeastReachOfNormals = 0.5;  // [m]
constexpr double kSideOfBucket = 0.5;         // [m]
constexpr double kMostBuckets = 512.0;        // along a side

double dot(const Point2& a, const Point2& b) {
  return a.x * b.x + a.y * b.y;
}

double squared_distance(const Point2& a, const Point2& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

/// The side a wall faces, or one of the two [map frame]. None where that is not known.
std::optional<ElasticWall> facing_wall(const LikelihoodField& map, const WallPoint& wall) {
  if (wall.facing == kNoDirection) return std::nullopt;
  const double angle = angle_of(wall.facing) + map.T_map_grid.theta;
  const Point2 at = map.T_map_grid * Point2{wall.position.x * map.cell, wall.position.y * map.cell};
  return ElasticWall{at, {std::cos(angle), std::sin(angle)}, is_axis(wall.facing)};
}

/// The direction across the line of these points, either way; none if they are no line.
std::optional<Point2> direction_across(const std::vector<Point2>& points) {
  if (points.size() < 3) return std::nullopt;
  const double count = static_cast<double>(points.size());
  Point2 middle;
  for (const Point2& p : points) {
    middle.x += p.x / count;
    middle.y += p.y / count;
  }
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (const Point2& p : points) {
    xx += (p.x - middle.x) * (p.x - middle.x);
    yy += (p.y - middle.y) * (p.y - middle.y);
    xy += (p.x - middle.x) * (p.y - middle.y);
  }
  const double mean = 0.5 * (xx + yy), spread = std::hypot(0.5 * (xx - yy), xy);
  if (mean - spread > kMostThickness * (mean + spread)) return std::nullopt;
  const double across = 0.5 * std::atan2(2.0 * xy, xx - yy) + 0.5 * std::numbers::pi;
  return Point2{std::cos(across), std::sin(across)};
}

}  // namespace

bool faces_alike(const ElasticWall& a, const ElasticWall& b) {
  const double cosine = dot(a.normal, b.normal);
  return (a.has_two_sides || b.has_two_sides ? std::abs(cosine) : cosine) > kAlike;
}

template <typename Visit>
void ElasticWalls::for_each_about(const Point2& at, double reach, Visit visit) const {
  const int left = std::max(0, static_cast<int>(std::floor((at.x - reach - corner_.x) / side_)));
  const int right = std::min(columns_ - 1, static_cast<int>(std::floor((at.x + reach - corner_.x) / side_)));
  const int bottom = std::max(0, static_cast<int>(std::floor((at.y - reach - corner_.y) / side_)));
  const int top = std::min(rows_ - 1, static_cast<int>(std::floor((at.y + reach - corner_.y) / side_)));
  for (int row = bottom; row <= top && left <= right; ++row) {
    for (std::size_t i = begins_[bucket_of(left, row)]; i < begins_[bucket_of(right, row) + 1]; ++i)
      visit(walls_[i]);
  }
}

ElasticWalls::ElasticWalls(const LikelihoodField& map) {
  for (const WallPoint& wall : map.walls) {
    if (const auto facing = facing_wall(map, wall)) walls_.push_back(*facing);
  }
  sort_into_buckets();
  // Facings come in parts of a turn; the line of its neighbours says better which way a wall runs.
  std::vector<std::optional<Point2>> across;
  std::vector<Point2> near;
  const double reach = std::max(kReachOfLine, kCellsOfLine * map.cell);
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    if (i % 256 == 0) throw_if_cancelled();
    near.clear();
    const ElasticWall& wall = walls_[i];
    for_each_about(wall.position, reach, [&](const ElasticWall& other) {
      if (squared_distance(other.position, wall.position) <= reach * reach && faces_alike(other, wall))
        near.push_back(other.position);
    });
    across.push_back(direction_across(near));
  }
  std::vector<ElasticWall> straight;
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    if (!across[i] || std::abs(dot(*across[i], walls_[i].normal)) < kAlike) continue;
    straight.push_back(walls_[i]);
    const double sign = dot(*across[i], walls_[i].normal) < 0.0 ? -1.0 : 1.0;
    straight.back().normal = {sign * across[i]->x, sign * across[i]->y};
  }
  walls_ = std::move(straight);
  sort_into_buckets();
}

void ElasticWalls::sort_into_buckets() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Point2 low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
  for (const ElasticWall& wall : walls_) {
    low = {std::min(low.x, wall.position.x), std::min(low.y, wall.position.y)};
    high = {std::max(high.x, wall.position.x), std::max(high.y, wall.position.y)};
  }
  if (walls_.empty()) low = high = {};
  corner_ = low;
  side_ = std::max(kSideOfBucket, std::max(high.x - low.x, high.y - low.y) / kMostBuckets);
  columns_ = static_cast<int>((high.x - low.x) / side_) + 1;
  rows_ = static_cast<int>((high.y - low.y) / side_) + 1;
  const auto bucket = [&](const ElasticWall& wall) {
    return bucket_of(static_cast<int>((wall.position.x - corner_.x) / side_),
                     static_cast<int>((wall.position.y - corner_.y) / side_));
  };
  std::stable_sort(walls_.begin(), walls_.end(),
                   [&](const ElasticWall& a, const ElasticWall& b) { return bucket(a) < bucket(b); });
  begins_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  for (const ElasticWall& wall : walls_) ++begins_[bucket(wall) + 1];
  for (std::size_t i = 1; i < begins_.size(); ++i) begins_[i] += begins_[i - 1];
}

const ElasticWall* ElasticWalls::nearest(const ElasticWall& wall, double reach) const {
  const double per_normal = std::max(reach, kLeastReachOfNormals);
  const ElasticWall* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for_each_about(wall.position, reach, [&](const ElasticWall& other) {
    const double distance = squared_distance(other.position, wall.position);
    if (distance > reach * reach || distance >= least || !faces_alike(other, wall)) return;
    const double cosine = dot(other.normal, wall.normal);
    const double difference = distance + 2.0 * per_normal * per_normal * (1.0 - std::abs(cosine));
    if (difference >= least) return;
    least = difference;
    best = &other;
  });
  return best;
}

}  // namespace gridmerge::internal
