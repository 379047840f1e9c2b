// SPDX-License-Identifier: Apache-2.0
#include "search/exhaustive.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/grid/execution.hpp"
#include "search/correlate.hpp"
#include "search/rotations.hpp"
#include "search/search_frame.hpp"
#include "similarity/evidence.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kScale = 6.0;           // score units a nat
constexpr std::size_t kPilotMargin = 4;  // see foreseen_score()
/// Shifts at which fewer than this share of the samples could lie on the fixed map are not looked at.
constexpr double kMinMet = 0.08;
static_assert(kMaxSearchSamples * kMaxCorrelated < 32767);

/// The evidence of a wall in each coarse cell of the fixed map.
EvidenceImage make_evidence_image(const LikelihoodField& fixed, const SearchFrame& frame,
                                  const ExhaustiveSearchOptions& options) {
  const auto table = evidence_table({options.sigma, options.outliers}, fixed.background);
  std::vector<float> sums(static_cast<std::size_t>(frame.fixed_width) * frame.fixed_height, 0.0F);
  for (int y = 0; y < fixed.height; ++y) {
    throw_if_cancelled();
    const std::size_t line = static_cast<std::size_t>(y / options.coarse_factor) * frame.fixed_width;
    for (int x = 0; x < fixed.width; ++x) {
      const int distance = fixed.places[fixed.index(x, y)].distance;
      if (distance == kUnseen) continue;
      sums[line + x / options.coarse_factor] += table[encounter(distance, kUnclearFacing)];
    }
  }

  EvidenceImage image(frame.fixed_width, frame.fixed_height);
  const double cells = static_cast<double>(options.coarse_factor) * options.coarse_factor;
  for (int y = 0; y < frame.fixed_height; ++y) {
    for (int x = 0; x < frame.fixed_width; ++x) {
      const double mean = sums[static_cast<std::size_t>(y) * frame.fixed_width + x] / cells;
      image.at(x, y) = static_cast<std::int8_t>(
          std::clamp<long>(std::lround(kScale * mean), -kMaxCorrelated, kMaxCorrelated));
    }
  }
  return image;
}

/// Finds the peaks of one rotation after the other, in memory that it keeps.
class PeakFinder {
 public:
  /// `pooled` is `evidence` by pool_pairs().
  PeakFinder(const SearchFrame& frame, const std::vector<WallPoint>& walls, const EvidenceImage& evidence,
             const EvidenceImage& pooled)
      : frame_(frame),
        walls_(walls),
        least_met_(1 + static_cast<std::size_t>(kMinMet * static_cast<double>(walls.size()))),
        evidence_(evidence),
        pooled_(pooled) {}

  /// The best local maxima of all shifts.
  std::vector<Peak> find_all(int rotation) {
    const TurnedWalls turned = turn_walls(walls_, frame_, rotation, least_met_);
    resize(scores_, turned.shifts_x, turned.shifts_y);
    correlate(evidence_, turned.samples, scores_);
    return best_peaks(scores_, turned, rotation);
  }

  /// Those of them that score `least` (above 0) or more. Most shifts need no score of their own, because four
  /// at a time are found to score less.
  std::vector<Peak> find_from(int least, int rotation) {
    const TurnedWalls turned = turn_walls(walls_, frame_, rotation, least_met_);
    resize(bounds_, (turned.shifts_x + 1) / 2, (turned.shifts_y + 1) / 2);
    correlate(pooled_, pool_pairs(turned.samples), bounds_);
    resize(scores_, turned.shifts_x, turned.shifts_y);
    const std::vector<ScoreBlock> looked_at =
        correlate_where(evidence_, turned.samples, bounds_, least, scores_);
    return best_peaks(scores_, looked_at, turned, rotation, least - 1);
  }

 private:
  const SearchFrame& frame_;
  const std::vector<WallPoint>& walls_;
  std::size_t least_met_;
  const EvidenceImage& evidence_;
  const EvidenceImage& pooled_;
  ScoreImage scores_;
  ScoreImage bounds_;
};

}  // namespace

std::vector<PoseCandidate> search_all_poses(const LikelihoodField& fixed, const LikelihoodField& moving,
                                            const ExhaustiveSearchOptions& options) {
  check_search(fixed, moving, options, kMaxSearchSamples);
  const SearchFrame frame = make_search_frame(fixed, moving, options.coarse_factor, options.rotations);
  const EvidenceImage evidence = make_evidence_image(fixed, frame, options);
  const std::vector<WallPoint> walls = draw_evenly(moving.walls, options.samples);

  if (walls.empty()) return {};
  const EvidenceImage pooled = pool_pairs(evidence);
  return search_rotations(frame, options.max_candidates, kPilotMargin,
                          [&] { return PeakFinder(frame, walls, evidence, pooled); });
}

}  // namespace gridmerge::internal
