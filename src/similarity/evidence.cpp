// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace gridmerge {

namespace {

using Histogram = std::array<int, kDistanceBins + 1>;

std::vector<ErrorModel> make_error_models() {
  std::vector<ErrorModel> models;
  for (const double sigma : {0.7, 1.0, 1.5, 2.2, 3.3, 5.0, 7.5}) {
    for (const double outliers : {0.02, 0.05, 0.1, 0.2, 0.35, 0.5}) models.push_back({sigma, outliers});
  }
  return models;
}

/// How many of the points meet a wall of `map` at each distance.
Histogram count_distances(const WallMap& map, const std::vector<Point2>& points, const SE2& T_map_points) {
  Histogram histogram{};
  const double c = std::cos(T_map_points.theta);
  const double s = std::sin(T_map_points.theta);
  for (const Point2& p : points) {
    const double x = c * p.x - s * p.y + T_map_points.x;
    const double y = s * p.x + c * p.y + T_map_points.y;
    // Outside the grid counts as unseen. The comparison is made on doubles: a huge value must not reach the
    // cast.
    if (!(x >= 0.0 && y >= 0.0 && x < map.width && y < map.height)) continue;
    ++histogram[map.distance[static_cast<std::size_t>(y) * map.width + static_cast<std::size_t>(x)]];
  }
  return histogram;
}

double weigh(const Histogram& histogram, const std::array<float, kDistanceBins + 1>& table) {
  double sum = 0.0;
  for (int bin = 0; bin < kDistanceBins; ++bin) sum += histogram[bin] * static_cast<double>(table[bin]);
  return sum;
}

double seen(const Histogram& histogram) {
  int sum = 0;
  for (int bin = 0; bin < kDistanceBins; ++bin) sum += histogram[bin];
  return sum;
}

double points_per_drawn(const std::vector<Point2>& all, const std::vector<Point2>& drawn) {
  return drawn.empty() ? 0.0 : static_cast<double>(all.size()) / static_cast<double>(drawn.size());
}

}  // namespace

std::span<const ErrorModel> error_models() {
  static const std::vector<ErrorModel> models = make_error_models();
  return models;
}

std::array<float, kDistanceBins + 1> evidence_table(const ErrorModel& model,
                                                    const std::array<double, kDistanceBins>& background) {
  std::array<float, kDistanceBins + 1> table{};
  double below = 0.0;  // P(distance < upper edge of the previous bin), for the magnitude of a normal error
  for (int bin = 0; bin < kDistanceBins; ++bin) {
    const bool last = bin == kDistanceBins - 1;
    const double up_to = last ? 1.0 : std::erf((bin + 0.5) / (model.sigma * std::numbers::sqrt2));
    const double same_place = up_to - below;
    below = up_to;
    table[bin] =
        static_cast<float>(std::log((1.0 - model.outliers) * same_place / background[bin] + model.outliers));
  }
  return table;
}

std::vector<Point2> draw_evenly(const std::vector<Point2>& points, std::size_t count) {
  if (points.size() <= count) return points;
  std::vector<Point2> drawn;
  drawn.reserve(count);
  for (std::size_t i = 0; i < count; ++i) drawn.push_back(points[i * points.size() / count]);
  return drawn;
}

WallEvidence::WallEvidence(const WallMap& fixed, const WallMap& moving, std::size_t max_points)
    : fixed_(fixed),
      moving_(moving),
      fixed_walls_(draw_evenly(fixed.walls, max_points)),
      moving_walls_(draw_evenly(moving.walls, max_points)),
      fixed_weight_(points_per_drawn(fixed.walls, fixed_walls_)),
      moving_weight_(points_per_drawn(moving.walls, moving_walls_)) {
  for (const ErrorModel& model : error_models()) {
    tables_.push_back({evidence_table(model, fixed.background), evidence_table(model, moving.background)});
  }
}

Evidence WallEvidence::operator()(const SE2& T_fixed_moving_cells, double min_sigma) const {
  const Histogram in_fixed = count_distances(fixed_, moving_walls_, T_fixed_moving_cells);
  const Histogram in_moving = count_distances(moving_, fixed_walls_, inverse(T_fixed_moving_cells));
  const std::span<const ErrorModel> models = error_models();

  Evidence best;
  best.score = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < models.size(); ++i) {
    // The widest sigma is always tried, whatever min_sigma says.
    if (models[i].sigma < min_sigma && models[i].sigma < models.back().sigma) continue;
    const double score = moving_weight_ * weigh(in_fixed, tables_[i].fixed) +
                         fixed_weight_ * weigh(in_moving, tables_[i].moving);
    if (score > best.score) {
      best.score = score;
      best.model = models[i];
    }
  }
  best.seen_walls = moving_weight_ * seen(in_fixed) + fixed_weight_ * seen(in_moving);
  return best;
}

}  // namespace gridmerge
