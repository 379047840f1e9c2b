// SPDX-License-Identifier: Apache-2.0
#include "search/thorough.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "search/correlate.hpp"
#include "search/rotations.hpp"
#include "search/search_frame.hpp"
#include "similarity/evidence.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kScale = 6.0;           // units of evidence a nat
constexpr std::size_t kPilotMargin = 6;  // see foreseen_score()
constexpr std::size_t kSeenStep = 4;     // every 4th sample tells how much is seen
static_assert(kMaxThoroughSamples * kMaxCorrelated < 32767);

/// One image of evidence for the walls that face one way: sectors of two directions, of two axes, and one for
/// what faces no known way.
constexpr int kDirectionSectors = kDirections / 2;
constexpr int kAxisSectors = kAxes / 2;
constexpr int kSectors = kDirectionSectors + kAxisSectors + 1;
constexpr int sector_of(std::uint8_t facing) {
  return facing / 2;
}
static_assert(sector_of(kNoDirection) == kSectors - 1);

using BySector = std::array<float, kSectors>;

/// The evidence of a wall of each sector in each coarse cell of the fixed map: means over its cells and over
/// the facings of the sector.
EvidenceImage make_evidence(const LikelihoodField& fixed, const SearchFrame& frame,
                            const ThoroughSearchOptions& options) {
  const auto table = evidence_table({options.sigma, options.outliers}, fixed.background);
  std::vector<BySector> nats(static_cast<std::size_t>(kFacingCodes) * kDistanceBins, BySector{});
  std::array<int, kSectors> codes{};
  for (int facing = 0; facing < kFacingCodes; ++facing) ++codes[sector_of(static_cast<std::uint8_t>(facing))];
  for (int of_place = 0; of_place < kFacingCodes; ++of_place) {
    for (int distance = 0; distance < kDistanceBins; ++distance) {
      BySector& row = nats[static_cast<std::size_t>(of_place) * kDistanceBins + distance];
      for (int facing = 0; facing < kFacingCodes; ++facing) {
        const int sector = sector_of(static_cast<std::uint8_t>(facing));
        row[sector] += table[encounter(distance, facing_class(static_cast<std::uint8_t>(facing),
                                                              static_cast<std::uint8_t>(of_place)))] /
                       static_cast<float>(codes[sector]);
      }
    }
  }
  EvidenceImage image(frame.fixed_width, frame.fixed_height, kSectors);
  const float per_cell =
      static_cast<float>(kScale / (static_cast<double>(options.coarse_factor) * options.coarse_factor));
  std::vector<BySector> sums(frame.fixed_width);
  for (int row = 0; row < frame.fixed_height; ++row) {
    throw_if_cancelled();
    std::fill(sums.begin(), sums.end(), BySector{});
    for (int y = row * options.coarse_factor; y < std::min(fixed.height, (row + 1) * options.coarse_factor);
         ++y) {
      for (int x = 0; x < fixed.width; ++x) {
        const Place& place = fixed.places[fixed.index(x, y)];
        if (place.distance == kUnseen) continue;
        const BySector& met = nats[static_cast<std::size_t>(place.facing) * kDistanceBins + place.distance];
        BySector& sum = sums[x / options.coarse_factor];
        for (int i = 0; i < kSectors; ++i) sum[i] += met[i];
      }
    }
    for (int x = 0; x < frame.fixed_width; ++x) {
      for (int i = 0; i < kSectors; ++i) {
        image.at(x, row, i) = static_cast<std::int8_t>(
            std::clamp<long>(std::lround(per_cell * sums[x][i]), -kMaxCorrelated, kMaxCorrelated));
      }
    }
  }
  return image;
}

/// How much of each coarse cell the fixed map has seen, kMaxCorrelated for all of it, as means of 2 x 2 cells
/// in the planes of pool_pairs().
EvidenceImage make_seen_pairs(const LikelihoodField& fixed, const SearchFrame& frame, int factor) {
  std::vector<int> counts(static_cast<std::size_t>(frame.fixed_width) * frame.fixed_height, 0);
  for (int y = 0; y < fixed.height; ++y) {
    const Place* const row = fixed.places.data() + fixed.index(0, y);
    int* const sums = counts.data() + static_cast<std::size_t>(y / factor) * frame.fixed_width;
    for (int x = 0; x < fixed.width; ++x) sums[x / factor] += row[x].distance != kUnseen;
  }
  const auto seen = [&](int x, int y) {
    const bool is_inside = x >= 0 && y >= 0 && x < frame.fixed_width && y < frame.fixed_height;
    return is_inside ? counts[static_cast<std::size_t>(y) * frame.fixed_width + x] : 0;
  };
  EvidenceImage image((frame.fixed_width >> 1) + 2, (frame.fixed_height >> 1) + 2, 4);
  const int all = 4 * factor * factor;
  for (int y = -1; y < frame.fixed_height; ++y) {
    for (int x = -1; x < frame.fixed_width; ++x) {
      const int sum = seen(x, y) + seen(x + 1, y) + seen(x, y + 1) + seen(x + 1, y + 1);
      image.at((x >> 1) + 1, (y >> 1) + 1, 2 * (y & 1) + (x & 1)) =
          static_cast<std::int8_t>((kMaxCorrelated * sum + all / 2) / all);
    }
  }
  return image;
}

/// What unrelated poses score [nats] with n samples seen: -kMean n on average, with a standard deviation of
/// kSpread spread_of(n).
constexpr double kMean = 0.37;
constexpr double kSpread = 0.48;
constexpr double kUnits = 256.0;     // of a score, a standard deviation
constexpr double kMaxScore = 120.0;  // standard deviations: keeps 16 bits from overflowing

/// Turns sums of evidence into scores, by what is seen: in units of the image of seen places.
class Normal {
 public:
  explicit Normal(std::size_t samples) {
    const std::size_t looked_up = (samples + kSeenStep - 1) / kSeenStep;
    const double weight = static_cast<double>(samples) / static_cast<double>(looked_up);
    const std::size_t most = looked_up * kMaxCorrelated;
    for (std::size_t seen = 0; seen <= most; ++seen) {
      const double n = weight * static_cast<double>(seen) / kMaxCorrelated;
      const bool is_enough = n >= kMinSeenSamples;
      const double per_unit = is_enough ? kUnits / (kScale * kSpread * spread_of(n)) : 0.0;
      mean_.push_back(static_cast<float>(-kScale * kMean * n));
      per_unit_.push_back(static_cast<float>(per_unit));
    }
  }

  std::int16_t score(int sum, int seen) const {
    const float score = (static_cast<float>(sum) - mean_[seen]) * per_unit_[seen];
    return static_cast<std::int16_t>(std::clamp(score, 0.0F, static_cast<float>(kMaxScore * kUnits)));
  }

  /// From how much seen on there is a score at all.
  int least_seen() const {
    return static_cast<int>(
        std::find_if(per_unit_.begin(), per_unit_.end(), [](float one) { return one > 0.0F; }) -
        per_unit_.begin());
  }

  /// Which sum scores `least` or more for certain, and hardly a smaller one, by what is seen.
  std::vector<std::int16_t> least_sums(int least) const {
    std::vector<std::int16_t> sums;
    for (std::size_t seen = 0; seen < mean_.size(); ++seen) {
      const double sum = per_unit_[seen] > 0.0F
                             ? std::floor(static_cast<double>(least) / per_unit_[seen] + mean_[seen] - 0.5)
                             : 32767.0;
      sums.push_back(static_cast<std::int16_t>(std::clamp(sum, -32000.0, 32767.0)));
    }
    return sums;
  }

 private:
  std::vector<float> mean_;
  std::vector<float> per_unit_;
};

/// What is searched, in the frame of the search.
struct Searched {
  SearchFrame frame;
  std::vector<WallPoint> walls;  // of the moving map
  EvidenceImage evidence;        // of the fixed map
  EvidenceImage pooled;          // pool_pairs() of it
  EvidenceImage seen;            // make_seen_pairs()
  Normal normal;
};

/// Finds the peaks of one rotation after the other, in memory that it keeps.
class PeakFinder {
 public:
  explicit PeakFinder(const Searched& searched) : searched_(searched) {}

  std::vector<Peak> find_all(int rotation) {
    turn(rotation);
    resize(scores_, turned_.shifts_x, turned_.shifts_y);
    return best_of(
        correlate_where(searched_.evidence, turned_.samples, seen_, searched_.normal.least_seen(), scores_),
        rotation, 0);
  }

  /// Those that score `least` (above 0) or more.
  std::vector<Peak> find_from(int least, int rotation) {
    if (least_sums_.empty()) least_sums_ = searched_.normal.least_sums(least);
    turn(rotation);
    pool_scores(seen_, most_seen_);
    resize(bounds_, (turned_.shifts_x + 1) / 2, (turned_.shifts_y + 1) / 2);
    const std::vector<ScoreBlock> bounded = correlate_where(
        searched_.pooled, pool_pairs(turned_.samples), most_seen_, searched_.normal.least_seen(), bounds_);
    // How far the bounds lie above what is asked for, which depends on what is seen.
    for_each_looked_at(bounded, bounds_, [&](std::int16_t& bound, int x, int y) {
      const int above = bound - least_sums_[static_cast<std::size_t>(seen_at(x, y))];
      bound = static_cast<std::int16_t>(std::clamp(above, int{kNotLookedAt}, kMaxSum));
    });
    resize(scores_, turned_.shifts_x, turned_.shifts_y);
    return best_of(correlate_where(searched_.evidence, turned_.samples, bounds_, 0, scores_), rotation,
                   least - 1);
  }

 private:
  static constexpr int kMaxSum = 32767;

  /// Turns the walls, and sees how many of them meet what the fixed map has seen.
  void turn(int rotation) {
    const std::vector<WallPoint>& walls = searched_.walls;
    const std::size_t least = std::min(walls.size(), static_cast<std::size_t>(kMinSeenSamples));
    turned_ = turn_walls(walls, searched_.frame, rotation, least);
    std::vector<Sample> some;
    for (std::size_t i = 0; i < walls.size(); i += kSeenStep) some.push_back(turned_.samples[i]);
    resize(seen_, (turned_.shifts_x + 1) / 2, (turned_.shifts_y + 1) / 2);
    correlate(searched_.seen, pool_pairs(some), seen_);
    const int steps = steps_of_turn(searched_.frame.angle(rotation));
    for (std::size_t i = 0; i < walls.size(); ++i)
      turned_.samples[i].plane = sector_of(turned(walls[i].facing, steps));
  }

  std::int16_t seen_at(int half_x, int half_y) const {
    return seen_.values[static_cast<std::size_t>(half_y) * seen_.width + half_x];
  }

  template <typename Change>
  static void for_each_looked_at(const std::vector<ScoreBlock>& blocks, ScoreImage& image, Change change) {
    for (const ScoreBlock& block : blocks) {
      for (int y = block.y; y < std::min(block.y + ScoreBlock::kRows, image.height); ++y) {
        std::int16_t* const row = image.values.data() + static_cast<std::size_t>(y) * image.width;
        for (int x = block.x; x < block.x + ScoreBlock::kColumns; ++x) change(row[x], x, y);
      }
    }
  }

  /// Sums become scores where they were looked at; what was not scores less than anything.
  std::vector<Peak> best_of(const std::vector<ScoreBlock>& looked_at, int rotation, int floor) {
    for_each_looked_at(looked_at, scores_, [&](std::int16_t& score, int x, int y) {
      score = searched_.normal.score(score, seen_at(x / 2, y / 2));
    });
    return best_peaks(scores_, looked_at, turned_, rotation, floor);
  }

  const Searched& searched_;
  TurnedWalls turned_;
  ScoreImage scores_;
  ScoreImage bounds_;
  ScoreImage seen_;
  ScoreImage most_seen_;                  // of 2 x 2 of them
  std::vector<std::int16_t> least_sums_;  // Normal::least_sums() of what find_from() is asked for
};

}  // namespace

std::vector<PoseCandidate> search_thoroughly(const LikelihoodField& fixed, const LikelihoodField& moving,
                                             const ThoroughSearchOptions& options) {
  check_search(fixed, moving, options, kMaxThoroughSamples);
  std::vector<WallPoint> walls = draw_evenly(moving.walls, options.samples);
  if (walls.empty() || fixed.walls.empty()) return {};
  const SearchFrame frame = make_search_frame(fixed, moving, options.coarse_factor, options.rotations);
  const Normal normal(walls.size());
  EvidenceImage evidence = make_evidence(fixed, frame, options);
  EvidenceImage pooled = pool_pairs(evidence);
  const Searched searched{frame,
                          std::move(walls),
                          std::move(evidence),
                          std::move(pooled),
                          make_seen_pairs(fixed, frame, options.coarse_factor),
                          normal};
  return search_rotations(frame, options.max_candidates, kPilotMargin, [&] { return PeakFinder(searched); });
}

}  // namespace gridmerge::internal
