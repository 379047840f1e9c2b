// SPDX-License-Identifier: Apache-2.0
#include "similarity/evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "grid/multiversion.hpp"
#include "grid/unaligned.hpp"

namespace gridmerge::internal {

namespace {

/// "Same place" against "unrelated", by class of facing.
constexpr std::array<double, kFacings> kFacingRatio{1.0, 4.8, 2.2, 0.9, 0.36, 0.08, 0.16};

/// The largest angle of each class but the first, in parts of a turn.
constexpr std::array<int, kFacings - 1> kFacingUpTo{1, 2, 3, 5, 12, kDirections / 2};

constexpr int class_of(int between) {
  int facing = 1;
  while (between > kFacingUpTo[facing - 1]) ++facing;
  return facing;
}

/// A wall with floor on both sides tells its axis only: it meets one that faces either way across it, and can
/// be no better match than two facings that differ a little.
constexpr int class_of_facings(std::uint8_t a, std::uint8_t b) {
  if (a == kNoDirection || b == kNoDirection) return kUnclearFacing;
  const bool axes = is_axis(a) || is_axis(b);
  const int between = steps_between(a, b);
  const int least = axes ? 2 : 1;
  return class_of(between) < least ? least : class_of(between);
}

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
  std::vector<ModelScores> nats(kEncounters, ModelScores{});
  const auto models = error_models();
  for (std::size_t i = 0; i < kErrorModels; ++i) {
    const auto table = evidence_table(models[i], background);
    for (int met = 0; met < kEncounters; ++met) nats[met][i] = table[met];
  }
  return nats;
}

/// What is added to the distance bin to name the encounter, by both facings.
constexpr auto kEncounterOffset = [] {
  std::array<std::array<std::uint8_t, kFacingCodes>, kFacingCodes> offsets{};
  static_assert(encounter(0, kUnclearFacing) == 0 && kEncounters <= 255);
  for (int a = 0; a < kFacingCodes; ++a) {
    for (int b = 0; b < kFacingCodes; ++b) {
      offsets[a][b] = static_cast<std::uint8_t>(
          encounter(0, class_of_facings(static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b))));
    }
  }
  return offsets;
}();

/// Rows of kEncounterOffset for walls that are turned by so many parts of a turn, by their facing before.
constexpr auto kTurnedOffsets = [] {
  std::array<std::array<const std::uint8_t*, kFacingCodes>, kDirections> rows{};
  for (int steps = 0; steps < kDirections; ++steps) {
    for (int facing = 0; facing < kFacingCodes; ++facing)
      rows[steps][facing] = kEncounterOffset[turned(static_cast<std::uint8_t>(facing), steps)].data();
  }
  return rows;
}();

constexpr std::size_t kBlock = 128;

/// Places are kept in tiles of as many columns and rows, one cache line each: a point that is moved a little,
/// in any direction, mostly stays in its tile.
constexpr unsigned kTileColumns = 8;
constexpr unsigned kTileRows = 4;

constexpr unsigned tiles_along(int cells, unsigned tile) {
  return (static_cast<unsigned>(cells) + tile - 1) / tile;
}

/// Of a place, in rows of `row_of_tiles` tiles. Unsigned, so that divisions are shifts.
inline __attribute__((always_inline)) unsigned index_in_tiles(unsigned x, unsigned y, unsigned row_of_tiles) {
  const unsigned tile = y / kTileRows * row_of_tiles + x / kTileColumns;
  return (tile * kTileRows + y % kTileRows) * kTileColumns + x % kTileColumns;
}

/// Where `count` turned points fall; what falls outside is moved to the rim, which is unseen. The same bits
/// in every version: no operation is fused or reordered.
GRIDMERGE_MULTIVERSION
void place_points(const float* px, const float* py, std::size_t count, float c, float s, float tx, float ty,
                  float last_x, float last_y, unsigned row_of_tiles, int* at) {
  for (std::size_t i = 0; i < count; ++i) {
    const float x = std::min(std::max(c * px[i] - s * py[i] + tx, 0.0F), last_x);
    const float y = std::min(std::max(s * px[i] + c * py[i] + ty, 0.0F), last_y);
    at[i] = static_cast<int>(index_in_tiles(static_cast<unsigned>(static_cast<int>(x)),
                                            static_cast<unsigned>(static_cast<int>(y)), row_of_tiles));
  }
}

// Scores of eight models: one AVX2 register, or two of SSE2.
using Lanes = float __attribute__((vector_size(32)));
constexpr std::size_t kLanes = sizeof(Lanes) / sizeof(float);
constexpr std::size_t kModelLanes = kPaddedModels / kLanes;
static_assert(kPaddedModels % kLanes == 0);

/// The sums stay in registers while the encounters are added.
template <std::size_t FirstLanes>
inline __attribute__((always_inline)) void add_to_lanes(const int* encounters, std::size_t count,
                                                        const int* histogram, float weight,
                                                        const ModelScores* nats, ModelScores& sums) {
  Lanes lanes[kModelLanes - FirstLanes];
#pragma GCC unroll 8
  for (std::size_t i = FirstLanes; i < kModelLanes; ++i)
    load(sums.data() + i * kLanes, lanes[i - FirstLanes]);
  for (std::size_t n = 0; n < count; ++n) {
    const int met = encounters[n];
    const float times = weight * static_cast<float>(histogram[met]);
#pragma GCC unroll 8
    for (std::size_t i = FirstLanes; i < kModelLanes; ++i) {
      Lanes one;
      load(nats[met].data() + i * kLanes, one);
      lanes[i - FirstLanes] += times * one;
    }
  }
#pragma GCC unroll 8
  for (std::size_t i = FirstLanes; i < kModelLanes; ++i)
    store(lanes[i - FirstLanes], sums.data() + i * kLanes);
}

/// Adds `count` times what each model says of an encounter to the models' scores, at least from the `first`
/// model on.
GRIDMERGE_MULTIVERSION
void add_encounters(const int* histogram, float weight, const ModelScores* nats, std::size_t first,
                    ModelScores& sums) {
  std::array<int, kEncounters> encounters;  // that happened; no branches, since which did cannot be foreseen
  std::size_t count = 0;
  for (int met = 0; met < kEncounters; ++met) {
    encounters[count] = met;
    count += histogram[met] != 0 ? 1 : 0;
  }
  if (first < kLanes) {
    add_to_lanes<0>(encounters.data(), count, histogram, weight, nats, sums);
  } else {
    add_to_lanes<1>(encounters.data(), count, histogram, weight, nats, sums);
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

int facing_class(std::uint8_t a, std::uint8_t b) {
  return kEncounterOffset[a][b] / kDistanceBins;
}

std::array<float, kEncounters> evidence_table(const ErrorModel& model,
                                              const std::array<double, kDistanceBins>& background) {
  std::array<double, kDistanceBins> ratio{};
  double below = 0.0;  // P(distance < upper edge of the previous bin), for the magnitude of a normal error
  for (int bin = 0; bin < kDistanceBins; ++bin) {
    const bool last = bin == kDistanceBins - 1;
    const double up_to = last ? 1.0 : std::erf((bin + 0.5) / (model.sigma * std::numbers::sqrt2));
    ratio[bin] = (up_to - below) / background[bin];
    below = up_to;
  }
  std::array<float, kEncounters> table{};
  for (int bin = 0; bin < kDistanceBins; ++bin) {
    for (int facing = 0; facing < kFacings; ++facing) {
      table[encounter(bin, facing)] = static_cast<float>(
          std::log((1.0 - model.outliers) * ratio[bin] * kFacingRatio[facing] + model.outliers));
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

WallEvidence::LookUp::LookUp(const LikelihoodField& map)
    : walls(map.walls),
      row_of_tiles(tiles_along(map.width, kTileColumns)),
      last_x(static_cast<float>(map.width - 1)),
      last_y(static_cast<float>(map.height - 1)),
      nats(tabulate(map.background)) {
  const unsigned rows_of_tiles = tiles_along(map.height, kTileRows);
  places.resize(static_cast<std::size_t>(row_of_tiles) * rows_of_tiles * kTileColumns * kTileRows);
  for (int y = 0; y < map.height; ++y) {
    const Place* const row = map.places.data() + map.index(0, y);
    for (int x = 0; x < map.width; ++x) {
      const Place& place = row[x];
      const int distance = place.distance == kUnseen ? kEncounters : place.distance;
      const int facing = place.distance == kUnseen ? kNoDirection : place.facing;
      places[index_in_tiles(static_cast<unsigned>(x), static_cast<unsigned>(y), row_of_tiles)] =
          static_cast<std::uint16_t>(distance | facing << 8);
    }
  }
}

WallEvidence::Points::Points(const std::vector<WallPoint>& walls, std::size_t max_points) {
  const std::vector<WallPoint> drawn = draw_evenly(walls, max_points);
  for (const WallPoint& wall : drawn) {
    x.push_back(static_cast<float>(wall.position.x));
    y.push_back(static_cast<float>(wall.position.y));
    facing.push_back(wall.facing);
  }
  weight = drawn.empty() ? 0.0F : static_cast<float>(walls.size()) / static_cast<float>(drawn.size());
}

WallEvidence::WallEvidence(const LikelihoodField& fixed, const LikelihoodField& moving,
                           std::size_t max_points)
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
                                                       const SE2& T_map_points, double scale) {
  const float c = static_cast<float>(scale * std::cos(T_map_points.theta));
  const float s = static_cast<float>(scale * std::sin(T_map_points.theta));
  constexpr double kFarAway = 1e6;  // beyond any map
  const float tx = static_cast<float>(std::clamp(T_map_points.x, -kFarAway, kFarAway));
  const float ty = static_cast<float>(std::clamp(T_map_points.y, -kFarAway, kFarAway));
  const auto& offsets = kTurnedOffsets[steps_of_turn(T_map_points.theta)];

  // Several counters, because neighbouring walls often meet the same: adding to one twice in a row would
  // wait. Short ones, because to clear and to sum them takes as long as to count a hundred walls.
  constexpr std::size_t kCounters = 4;
  constexpr std::size_t kMaxCounted = 65535 / kBlock * kBlock;
  using Counts = std::array<std::uint16_t, kEncounters + 1>;
  Histogram histogram{};
  std::array<int, kBlock> at;
  for (std::size_t begin = 0; begin < points.x.size(); begin += kMaxCounted) {
    const std::size_t end = std::min(points.x.size(), begin + kMaxCounted);
    std::array<Counts, kCounters> counts{};
    for (std::size_t first = begin; first < end; first += kBlock) {
      const std::size_t count = std::min(kBlock, end - first);
      place_points(points.x.data() + first, points.y.data() + first, count, c, s, tx, ty, map.last_x,
                   map.last_y, map.row_of_tiles, at.data());
      const std::uint8_t* const facing = points.facing.data() + first;
      const auto meet = [&](std::size_t i, Counts& own) {
        const int place = map.places[at[i]];
        ++own[(place & 0xff) + offsets[facing[i]][place >> 8]];
      };
      std::size_t i = 0;
      for (; i + kCounters <= count; i += kCounters) {
        for (std::size_t own = 0; own < kCounters; ++own) meet(i + own, counts[own]);
      }
      for (; i < count; ++i) meet(i, counts[0]);
    }
    for (std::size_t met = 0; met < histogram.size(); ++met) {
      int sum = 0;
      for (const Counts& own : counts) sum += own[met];
      histogram[met] += sum;
    }
  }
  return histogram;
}

Evidence WallEvidence::operator()(const SE2& T_fixed_moving_cells, double min_sigma, double scale) const {
  const Histogram in_fixed = count_encounters(*fixed_, moving_walls_, T_fixed_moving_cells, scale);
  SE2 T_moving_fixed = inverse(T_fixed_moving_cells);
  T_moving_fixed.x /= scale;
  T_moving_fixed.y /= scale;
  const Histogram in_moving = count_encounters(*moving_, fixed_walls_, T_moving_fixed, 1.0 / scale);
  const auto models = error_models();
  std::size_t first = 0;
  while (models[first].sigma < min_sigma && models[first].sigma < models.back().sigma) ++first;
  ModelScores scores{};
  add_encounters(in_fixed.data(), moving_walls_.weight, fixed_->nats.data(), first, scores);
  add_encounters(in_moving.data(), fixed_walls_.weight, moving_->nats.data(), first, scores);
  const auto best_score = std::max_element(scores.begin() + first, scores.begin() + kErrorModels);
  Evidence best;
  best.score = *best_score;
  best.model = models[best_score - scores.begin()];
  best.seen_walls = moving_walls_.weight * seen(in_fixed) + fixed_walls_.weight * seen(in_moving);
  return best;
}

}  // namespace gridmerge::internal
