// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace gridmerge {

namespace {

using Histogram = std::array<int, kDistanceBins + 1>;

constexpr std::array kSigmas{0.7, 1.0, 1.5, 2.2, 3.3, 5.0, 7.5};  // [cells]
constexpr std::array kOutliers{0.02, 0.05, 0.1, 0.2, 0.35, 0.5};
static_assert(kErrorModels == kSigmas.size() * kOutliers.size());

std::array<ErrorModel, kErrorModels> make_error_models() {
  std::array<ErrorModel, kErrorModels> models;
  std::size_t i = 0;
  for (const double sigma : kSigmas) {
    for (const double outliers : kOutliers) models[i++] = {sigma, outliers};
  }
  return models;
}

/// evidence_table() of every model, by distance bin.
std::vector<ModelScores> tabulate(const std::array<double, kDistanceBins>& background) {
  std::vector<ModelScores> nats(kDistanceBins);
  const auto models = error_models();
  for (std::size_t i = 0; i < kErrorModels; ++i) {
    const auto table = evidence_table(models[i], background);
    for (int bin = 0; bin < kDistanceBins; ++bin) nats[bin][i] = table[bin];
  }
  return nats;
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

/// Adds to every model's score what the points met. Models are the inner loop: their scores are independent
/// sums, which compilers vectorise without reordering any of them.
void add_scores(const Histogram& histogram, float weight, const std::vector<ModelScores>& nats,
                ModelScores& scores) {
  for (int bin = 0; bin < kDistanceBins; ++bin) {
    if (histogram[bin] == 0) continue;
    const float count = weight * static_cast<float>(histogram[bin]);
    for (std::size_t i = 0; i < kErrorModels; ++i) scores[i] += count * nats[bin][i];
  }
}

double seen(const Histogram& histogram) {
  int sum = 0;
  for (int bin = 0; bin < kDistanceBins; ++bin) sum += histogram[bin];
  return sum;
}

float points_per_drawn(const std::vector<Point2>& all, const std::vector<Point2>& drawn) {
  return drawn.empty() ? 0.0F : static_cast<float>(all.size()) / static_cast<float>(drawn.size());
}

}  // namespace

std::span<const ErrorModel, kErrorModels> error_models() {
  static const std::array<ErrorModel, kErrorModels> models = make_error_models();
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
      moving_weight_(points_per_drawn(moving.walls, moving_walls_)),
      nats_in_fixed_(tabulate(fixed.background)),
      nats_in_moving_(tabulate(moving.background)) {}

Evidence WallEvidence::operator()(const SE2& T_fixed_moving_cells, double min_sigma) const {
  const Histogram in_fixed = count_distances(fixed_, moving_walls_, T_fixed_moving_cells);
  const Histogram in_moving = count_distances(moving_, fixed_walls_, inverse(T_fixed_moving_cells));
  ModelScores scores{};
  add_scores(in_fixed, moving_weight_, nats_in_fixed_, scores);
  add_scores(in_moving, fixed_weight_, nats_in_moving_, scores);

  const auto models = error_models();
  std::size_t first = 0;
  while (models[first].sigma < min_sigma && models[first].sigma < models.back().sigma) ++first;
  const auto best_score = std::max_element(scores.begin() + first, scores.end());
  Evidence best;
  best.score = *best_score;
  best.model = models[best_score - scores.begin()];
  best.seen_walls = moving_weight_ * seen(in_fixed) + fixed_weight_ * seen(in_moving);
  return best;
}

}  // namespace gridmerge
