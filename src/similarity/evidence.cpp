// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace gridmerge {

namespace {

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

// Facings as they are looked up: a point's, turned, less a place's, is a difference of directions if both
// have one, and falls outside of that range of numbers if not.
constexpr int kPlaceNoDirection = 200;
constexpr int kPointNoDirection = 300;
constexpr int kZeroDifference = kPlaceNoDirection;  // added, so that no index is negative

/// By index point + turn + kZeroDifference - place: what is added to the distance bin to name the encounter.
constexpr std::array<std::uint8_t, kPointNoDirection + kDirections + kZeroDifference> kEncounterOffset = [] {
  std::array<std::uint8_t, kPointNoDirection + kDirections + kZeroDifference> offsets{};
  static_assert(encounter(0, Facing::unclear) == 0);
  for (int difference = 1 - kDirections; difference <= 2 * kDirections - 2; ++difference) {
    const int turn = (difference + kDirections) % kDirections;
    const bool same = std::min(turn, kDirections - turn) <= kDirections / 4;
    offsets[kZeroDifference + difference] =
        static_cast<std::uint8_t>(encounter(0, same ? Facing::same : Facing::opposite));
  }
  return offsets;
}();

/// Adds to every model's score what the points met. Models are the inner loop: their scores are independent
/// sums, which compilers vectorise without reordering any of them.
void add_scores(std::span<const int> histogram, float weight, const std::vector<ModelScores>& nats,
                ModelScores& scores) {
  for (int met = 0; met < kEncounters; ++met) {
    if (histogram[met] == 0) continue;
    const float count = weight * static_cast<float>(histogram[met]);
    for (std::size_t i = 0; i < kErrorModels; ++i) scores[i] += count * nats[met][i];
  }
}

double seen(std::span<const int> histogram) {
  return std::accumulate(histogram.begin(), histogram.begin() + kEncounters, 0);
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

WallEvidence::LookUp::LookUp(const WallMap& map)
    : walls(map.walls),
      width(map.width),
      last_x(static_cast<float>(map.width - 1)),
      last_y(static_cast<float>(map.height - 1)),
      nats(tabulate(map.background)) {
  places.reserve(map.places.size());
  for (const Place& place : map.places) {
    const int distance = place.distance == kUnseen ? kEncounters : place.distance;
    const bool faces = place.facing != kNoDirection && place.distance != kUnseen;
    const int facing = faces ? place.facing : kPlaceNoDirection;
    places.push_back(static_cast<std::uint16_t>(distance | facing << 8));
  }
}

WallEvidence::Points::Points(const std::vector<WallPoint>& walls, std::size_t max_points) {
  const std::vector<WallPoint> drawn = draw_evenly(walls, max_points);
  for (const WallPoint& wall : drawn) {
    x.push_back(static_cast<float>(wall.position.x));
    y.push_back(static_cast<float>(wall.position.y));
    facing.push_back(wall.facing == kNoDirection ? kPointNoDirection : wall.facing);
  }
  weight = drawn.empty() ? 0.0F : static_cast<float>(walls.size()) / static_cast<float>(drawn.size());
}

WallEvidence::WallEvidence(const WallMap& fixed, const WallMap& moving, std::size_t max_points)
    : fixed_(std::make_shared<LookUp>(fixed)),
      moving_(std::make_shared<LookUp>(moving)),
      fixed_walls_(fixed.walls, max_points),
      moving_walls_(moving.walls, max_points) {}

WallEvidence WallEvidence::with_points(std::size_t max_points) const {
  WallEvidence other = *this;
  other.fixed_walls_ = Points(fixed_->walls, max_points);
  other.moving_walls_ = Points(moving_->walls, max_points);
  return other;
}

WallEvidence::Histogram WallEvidence::count_encounters(const LookUp& map, const Points& points,
                                                       const SE2& T_map_points) {
  const float c = static_cast<float>(std::cos(T_map_points.theta));
  const float s = static_cast<float>(std::sin(T_map_points.theta));
  constexpr double kFarAway = 1e6;  // beyond any map
  const float tx = static_cast<float>(std::clamp(T_map_points.x, -kFarAway, kFarAway));
  const float ty = static_cast<float>(std::clamp(T_map_points.y, -kFarAway, kFarAway));
  const double turns = T_map_points.theta / (2.0 * std::numbers::pi) + 1.0;
  const int turn = static_cast<int>(std::lround(turns * kDirections)) % kDirections + kZeroDifference;

  // Several, because neighbouring walls often meet the same: adding to one counter twice in a row would wait.
  constexpr std::size_t kHistograms = 4;
  std::array<Histogram, kHistograms> histograms{};
  constexpr std::size_t kBlock = 128;
  std::array<int, kBlock> at;
  for (std::size_t first = 0; first < points.x.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, points.x.size() - first);
    const float* px = points.x.data() + first;
    const float* py = points.y.data() + first;
    for (std::size_t i = 0; i < count; ++i) {  // vectorised
      // What falls outside is moved to the rim, which is unseen.
      const float x = std::min(std::max(c * px[i] - s * py[i] + tx, 0.0F), map.last_x);
      const float y = std::min(std::max(s * px[i] + c * py[i] + ty, 0.0F), map.last_y);
      at[i] = static_cast<int>(y) * map.width + static_cast<int>(x);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const int place = map.places[at[i]];
      const int met = (place & 0xff) + kEncounterOffset[points.facing[first + i] + turn - (place >> 8)];
      ++histograms[i % kHistograms][met];
    }
  }
  for (std::size_t other = 1; other < kHistograms; ++other) {
    for (std::size_t met = 0; met < histograms[0].size(); ++met) histograms[0][met] += histograms[other][met];
  }
  return histograms[0];
}

Evidence WallEvidence::operator()(const SE2& T_fixed_moving_cells, double min_sigma) const {
  const Histogram in_fixed = count_encounters(*fixed_, moving_walls_, T_fixed_moving_cells);
  const Histogram in_moving = count_encounters(*moving_, fixed_walls_, inverse(T_fixed_moving_cells));
  ModelScores scores{};
  add_scores(in_fixed, moving_walls_.weight, fixed_->nats, scores);
  add_scores(in_moving, fixed_walls_.weight, moving_->nats, scores);

  const auto models = error_models();
  std::size_t first = 0;
  while (models[first].sigma < min_sigma && models[first].sigma < models.back().sigma) ++first;
  const auto best_score = std::max_element(scores.begin() + first, scores.end());
  Evidence best;
  best.score = *best_score;
  best.model = models[best_score - scores.begin()];
  best.seen_walls = moving_walls_.weight * seen(in_fixed) + fixed_walls_.weight * seen(in_moving);
  return best;
}

}  // namespace gridmerge
