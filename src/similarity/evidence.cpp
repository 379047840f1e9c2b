// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace gridmerge {

namespace {

/// How often each encounter happened, and behind them how often the other map had not seen the place.
using Histogram = std::array<int, kEncounters + 1>;

/// Walls that are one place but seem to face opposite ways: thin walls seen from both rooms, clutter.
constexpr double kOppositeShare = 0.1;
constexpr std::array<double, kFacings> kFacingRatio{1.0, (1.0 - kOppositeShare) / 0.5, kOppositeShare / 0.5};

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
  std::vector<ModelScores> nats(kEncounters);
  const auto models = error_models();
  for (std::size_t i = 0; i < kErrorModels; ++i) {
    const auto table = evidence_table(models[i], background);
    for (int met = 0; met < kEncounters; ++met) nats[met][i] = table[met];
  }
  return nats;
}

/// For every difference of two directions, in [0, 2 kDirections): do the walls face one way?
constexpr std::array<Facing, 2 * kDirections> kCompareDirections = [] {
  std::array<Facing, 2 * kDirections> compare{};
  for (int difference = 0; difference < 2 * kDirections; ++difference) {
    const int turn = difference % kDirections;
    const bool same = std::min(turn, kDirections - turn) <= kDirections / 4;
    compare[difference] = same ? Facing::same : Facing::opposite;
  }
  return compare;
}();

/// What the points meet in `map`.
Histogram count_encounters(const WallMap& map, const std::vector<WallPoint>& points,
                           const SE2& T_map_points) {
  Histogram histogram{};
  const double c = std::cos(T_map_points.theta);
  const double s = std::sin(T_map_points.theta);
  const double turns = T_map_points.theta / (2.0 * std::numbers::pi) + 1.0;
  const int turn = static_cast<int>(std::lround(turns * kDirections)) % kDirections;
  for (const WallPoint& point : points) {
    const Point2& p = point.position;
    const double x = c * p.x - s * p.y + T_map_points.x;
    const double y = s * p.x + c * p.y + T_map_points.y;
    // Outside the grid counts as unseen. The comparison is made on doubles: a huge value must not reach the
    // cast.
    if (!(x >= 0.0 && y >= 0.0 && x < map.width && y < map.height)) continue;
    const Place place = map.places[static_cast<std::size_t>(y) * map.width + static_cast<std::size_t>(x)];
    if (place.distance == kUnseen) {
      ++histogram[kEncounters];
      continue;
    }
    Facing facing = Facing::unclear;
    if (place.facing != kNoDirection && point.facing != kNoDirection) {
      facing = kCompareDirections[(point.facing + turn) % kDirections + kDirections - place.facing];
    }
    ++histogram[encounter(place.distance, facing)];
  }
  return histogram;
}

/// Adds to every model's score what the points met. Models are the inner loop: their scores are independent
/// sums, which compilers vectorise without reordering any of them.
void add_scores(const Histogram& histogram, float weight, const std::vector<ModelScores>& nats,
                ModelScores& scores) {
  for (int met = 0; met < kEncounters; ++met) {
    if (histogram[met] == 0) continue;
    const float count = weight * static_cast<float>(histogram[met]);
    for (std::size_t i = 0; i < kErrorModels; ++i) scores[i] += count * nats[met][i];
  }
}

double seen(const Histogram& histogram) {
  int sum = 0;
  for (int met = 0; met < kEncounters; ++met) sum += histogram[met];
  return sum;
}

float points_per_drawn(const std::vector<WallPoint>& all, const std::vector<WallPoint>& drawn) {
  return drawn.empty() ? 0.0F : static_cast<float>(all.size()) / static_cast<float>(drawn.size());
}

}  // namespace

std::span<const ErrorModel, kErrorModels> error_models() {
  static const std::array<ErrorModel, kErrorModels> models = make_error_models();
  return models;
}

std::array<float, kEncounters> evidence_table(const ErrorModel& model,
                                              const std::array<double, kDistanceBins>& background) {
  std::array<float, kEncounters> table{};
  double below = 0.0;  // P(distance < upper edge of the previous bin), for the magnitude of a normal error
  for (int bin = 0; bin < kDistanceBins; ++bin) {
    const bool last = bin == kDistanceBins - 1;
    const double up_to = last ? 1.0 : std::erf((bin + 0.5) / (model.sigma * std::numbers::sqrt2));
    const double ratio = (up_to - below) / background[bin];
    below = up_to;
    for (const Facing facing : {Facing::unclear, Facing::same, Facing::opposite}) {
      table[encounter(bin, facing)] = static_cast<float>(
          std::log((1.0 - model.outliers) * ratio * kFacingRatio[static_cast<int>(facing)] + model.outliers));
    }
  }
  return table;
}

double area_evidence(double agreement, double disagreement) {
  constexpr double kSamePlace = 0.04;  // share of disagreement to be expected
  constexpr double kUnrelated = 0.12;
  constexpr double kWeight = 0.2;  // independent observations in a cell
  return kWeight * (agreement * std::log((1.0 - kSamePlace) / (1.0 - kUnrelated)) +
                    disagreement * std::log(kSamePlace / kUnrelated));
}

std::vector<WallPoint> draw_evenly(const std::vector<WallPoint>& points, std::size_t count) {
  if (points.size() <= count) return points;
  std::vector<WallPoint> drawn;
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
  const Histogram in_fixed = count_encounters(fixed_, moving_walls_, T_fixed_moving_cells);
  const Histogram in_moving = count_encounters(moving_, fixed_walls_, inverse(T_fixed_moving_cells));
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
