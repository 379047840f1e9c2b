// SPDX-License-Identifier: Apache-2.0
#include "simulate/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gridmerge::internal {

namespace {

constexpr double kBucket = 1.0;  // [m]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double cross(Point2 p, Point2 q) {
  return p.x * q.y - p.y * q.x;
}

/// Distance of `p` from the edge.
double distance_between(const Edge& edge, Point2 p) {
  const Point2 along{edge.b.x - edge.a.x, edge.b.y - edge.a.y};
  const Point2 offset{p.x - edge.a.x, p.y - edge.a.y};
  const double square = along.x * along.x + along.y * along.y;
  const double share =
      square > 0.0 ? std::clamp((offset.x * along.x + offset.y * along.y) / square, 0.0, 1.0) : 0.0;
  return std::hypot(offset.x - share * along.x, offset.y - share * along.y);
}

/// One coordinate of a ray's way through the buckets.
struct Axis {
  Axis(double from, double direction, double corner)
      : index(static_cast<int>(std::floor((from - corner) / kBucket))),
        step(direction < 0.0 ? -1 : 1),
        each(direction == 0.0 ? kInfinity : kBucket / std::abs(direction)),
        next(direction == 0.0 ? kInfinity
                              : (corner + (index + (step > 0 ? 1 : 0)) * kBucket - from) / direction) {}

  void advance() {
    index += step;
    next += each;
  }

  int index;
  int step;
  double each;  // distance from one bucket's border to the next
  double next;  // distance at which the ray leaves the bucket
};

}  // namespace

double distance_to(const Edge& edge, Point2 from, Point2 direction) {
  const Point2 along{edge.b.x - edge.a.x, edge.b.y - edge.a.y};
  const double denominator = cross(direction, along);
  if (denominator == 0.0) return kInfinity;
  const Point2 offset{edge.a.x - from.x, edge.a.y - from.y};
  const double distance = cross(offset, along) / denominator;
  const double share = cross(offset, direction) / denominator;
  return share >= 0.0 && share <= 1.0 ? distance : kInfinity;
}

RayCaster::RayCaster(std::vector<Edge> edges) : edges_(std::move(edges)) {
  first_.push_back(0);
  if (edges_.empty()) return;
  Point2 low{kInfinity, kInfinity};
  Point2 high{-kInfinity, -kInfinity};
  for (const Edge& edge : edges_) {
    for (const Point2& p : {edge.a, edge.b}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  corner_ = {low.x - 0.5 * kBucket, low.y - 0.5 * kBucket};
  columns_ = static_cast<int>((high.x - corner_.x) / kBucket) + 1;
  rows_ = static_cast<int>((high.y - corner_.y) / kBucket) + 1;

  std::vector<std::vector<std::size_t>> buckets(static_cast<std::size_t>(columns_) * rows_);
  constexpr double kReach = 0.7072 * kBucket;  // from a bucket's centre to its corners, and a little
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    const auto range = [](double a, double b, double corner) {
      return std::pair(static_cast<int>((std::min(a, b) - corner) / kBucket),
                       static_cast<int>((std::max(a, b) - corner) / kBucket));
    };
    const auto [left, right] = range(edge.a.x, edge.b.x, corner_.x);
    const auto [bottom, top] = range(edge.a.y, edge.b.y, corner_.y);
    // One more on every side: an edge on a border belongs to both of its buckets.
    for (int row = std::max(0, bottom - 1); row <= std::min(rows_ - 1, top + 1); ++row) {
      for (int column = std::max(0, left - 1); column <= std::min(columns_ - 1, right + 1); ++column) {
        const Point2 centre{corner_.x + (column + 0.5) * kBucket, corner_.y + (row + 0.5) * kBucket};
        if (distance_between(edge, centre) <= kReach)
          buckets[static_cast<std::size_t>(row) * columns_ + column].push_back(i);
      }
    }
  }
  for (const std::vector<std::size_t>& bucket : buckets) {
    members_.insert(members_.end(), bucket.begin(), bucket.end());
    first_.push_back(members_.size());
  }
}

Hit RayCaster::cast(Point2 from, Point2 direction, double max_range, double beyond) const {
  Hit nearest;
  Axis x(from.x, direction.x, corner_.x);
  Axis y(from.y, direction.y, corner_.y);
  double entered = 0.0;
  while (entered <= std::min(max_range, nearest.range)) {
    if (x.index >= 0 && x.index < columns_ && y.index >= 0 && y.index < rows_) {
      const std::size_t bucket = static_cast<std::size_t>(y.index) * columns_ + x.index;
      for (std::size_t i = first_[bucket]; i < first_[bucket + 1]; ++i) {
        const Edge& edge = edges_[members_[i]];
        const double distance = distance_to(edge, from, direction);
        if (distance > beyond && distance <= max_range && distance < nearest.range)
          nearest = {distance, edge.echo};
      }
    }
    entered = std::min(x.next, y.next);
    if (x.next < y.next) {
      x.advance();
    } else {
      y.advance();
    }
  }
  return nearest;
}

}  // namespace gridmerge::internal
