// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "internal_export.hpp"
#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// How two maps of one place differ: a wall point of one lies off the other's wall by a normal error, or,
/// with probability `outliers`, anywhere (a moved chair, a bend, a wall that one of them never saw).
struct ErrorModel {
  double sigma = 1.0;     ///< standard deviation of the error [cells]
  double outliers = 0.1;  ///< share in (0, 1)
};

/// The models that a comparison chooses among, tight (laser maps from good SLAM) to wide (bent, hand-held
/// maps); sigma does not fall along the list.
inline constexpr std::size_t kErrorModels = 42;
std::span<const ErrorModel, kErrorModels> error_models();

/// A score [nats] for each of error_models(), and zeros up to whole vector registers.
inline constexpr std::size_t kPaddedModels = 48;
static_assert(kErrorModels <= kPaddedModels);
using ModelScores = std::array<float, kPaddedModels>;

/// How the free sides of two walls that meet lie to each other, in classes of the angle between them: 0 where
/// one of them is not known, then from the same direction (1) to the opposite one (kFacings - 1).
inline constexpr int kFacings = 7;
inline constexpr int kUnclearFacing = 0;

/// From this class on two walls stand across each other, or were seen from either side.
inline constexpr int kFirstContraryFacing = 5;

/// The class of two walls' facings in one frame.
int facing_class(std::uint8_t a, std::uint8_t b);

/// What a wall point can meet: a distance bin and a class of facing, or nothing that was seen.
inline constexpr int kEncounters = kFacings * kDistanceBins;
inline constexpr int encounter(int distance_bin, int facing) {
  return facing * kDistanceBins + distance_bin;
}

/// Log-likelihood ratio [nats] of every encounter, "same place" against "unrelated":
///   log((1 - outliers) * P(distance | sigma) / P(distance | background) * F + outliers),
/// where F is the ratio for the facing: two walls that are one face the same way nearly always, unrelated
/// ones often stand at right angles or back to back, and an unclear facing tells nothing. A wall that meets
/// an unseen place counts 0.
std::array<float, kEncounters> evidence_table(const ErrorModel& model,
                                              const std::array<double, kDistanceBins>& background);

/// The score of a pose, and the error model under which it is best.
struct Evidence {
  double score = 0.0;  ///< log-likelihood ratio "same place" against "unrelated" [nats]
  ErrorModel model;
  double seen_walls = 0.0;  ///< wall points of either map that lie where the other one has seen
};

/// Scores poses of one pair of maps. Every wall point of each map is looked up in the other's distance map;
/// the pose is judged by the error model that explains the distances best (maximum likelihood), so one scale
/// serves clean maps and bent ones.
class WallEvidence {
 public:
  /// Both maps must have cells of the same size, and outlive this. Uses at most `max_points` wall points of
  /// each map, evenly drawn, each standing for its share of the walls. O(cells of both).
  WallEvidence(const LikelihoodField& fixed, const LikelihoodField& moving, std::size_t max_points);

  /// The same with another number of points. O(points).
  WallEvidence with_points(std::size_t max_points) const;

  /// Evidence for a pose between the grid frames, in cells. Only models of sigma >= min_sigma [cells] are
  /// tried. O(points + models * bins).
  /// With a scale near 1 the moving map is that much larger: a wall point p of it lies at scale * R * p + t
  /// in the fixed map. Distances in the moving map stay in its own cells, so they are wrong by the scale.
  Evidence operator()(const SE2& T_fixed_moving_cells, double min_sigma = 0.0, double scale = 1.0) const;

 private:
  /// How often each encounter happened, and behind them how often the other map had not seen the place.
  using Histogram = std::array<int, kEncounters + 1>;

  /// A map made for looking walls up in: places as numbers that need no case distinctions.
  struct LookUp {
    explicit LookUp(const LikelihoodField& map);

    const std::vector<WallPoint>& walls;
    unsigned row_of_tiles;              // how many tiles of places lie in a row
    float last_x;                       // of the last column
    float last_y;                       // of the last row
    std::vector<std::uint16_t> places;  // distance bin or kEncounters, and in the high byte the facing
    std::vector<ModelScores> nats;      // by encounter
  };

  /// Drawn walls, one array a coordinate.
  struct Points {
    Points() = default;
    Points(const std::vector<WallPoint>& walls, std::size_t max_points);

    std::vector<float> x;
    std::vector<float> y;
    std::vector<std::uint8_t> facing;
    float weight = 0.0F;  // walls that each of them stands for
  };

  static Histogram count_encounters(const LookUp& map, const Points& points, const SE2& T_map_points,
                                    double scale);

  std::shared_ptr<const LookUp> fixed_;  // shared by all that differ in their points only
  std::shared_ptr<const LookUp> moving_;
  Points fixed_walls_;
  Points moving_walls_;
};

/// Log-likelihood ratio [nats] of the area that both maps know, from how much of it agrees. Maps of one place
/// disagree in few of these cells, maps laid over each other by chance in more, even where walls happen to
/// meet. Neighbouring cells tell nearly the same, so an area counts for less than the sum of its cells. Areas
/// in cells of the likelihood fields.
double area_evidence(double agreement, double disagreement);

/// At most `count` of the points, evenly spaced along the list.
GRIDMERGE_INTERNAL_EXPORT std::vector<WallPoint> draw_evenly(const std::vector<WallPoint>& points,
                                                             std::size_t count);

}  // namespace gridmerge::internal
