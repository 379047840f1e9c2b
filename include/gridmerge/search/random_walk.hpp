// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/similarity/image_similarity.hpp"

namespace gridmerge {

/// Poses that walks start from: those that are best under Delta. The maps' centres (of their known
/// rectangles) lie on each other, shifted and turned.
struct StartPoseOptions {
  int rotations = 72;     ///< evenly spaced over the full turn: every 5 degrees
  int offsets = 1;        ///< shifts on each side of the centre, in x and in y: 1 makes 3 x 3
  double offset = 100.0;  ///< between two shifts [cells of the fixed map]
};

/// A pose and what the paper measures there.
struct MeasuredPose {
  SE2 T_fixed_moving;  ///< between map frames [m, rad]
  ImageSimilarity similarity;
};

struct RandomWalkOptions {
  double c_lock = 0.0;          ///< weight of (dis - agr) in Delta; not negative
  std::size_t memory = 10;      ///< M: accepted steps that set the mean and covariance of proposals, >= 4
  double first_step = 10.0;     ///< standard deviation of proposals before anything is accepted [cells]
  double smallest_step = 0.25;  ///< bounds of a proposal's standard deviation in any direction [cells]
  double largest_step = 40.0;
  /// A sample worse by d is accepted with probability exp(-d / temperature). 0 never accepts one: hill
  /// climbing.
  double temperature = 0.0;
  /// The temperature is multiplied with this after every proposal: 1 keeps it, less is simulated annealing.
  double cooling = 1.0;
  std::size_t patience = 2000;         ///< proposals without an improvement of the best after which to stop
  std::size_t max_proposals = 200000;  ///< stop then in any case
  std::uint64_t seed = 1;
  bool record_trace = false;
};

/// A sample that a walk accepted.
struct WalkSample {
  std::size_t step = 0;  ///< proposals made so far; 0 is the start
  SE2 T_fixed_moving;    ///< between map frames [m, rad]
  double delta = 0.0;
  double psi = 0.0;
  std::int64_t agreement = 0;
  std::int64_t disagreement = 0;
};

struct RandomWalkResult {
  SE2 T_fixed_moving;          ///< the best sample, between map frames [m, rad]
  ImageSimilarity similarity;  ///< there
  double delta = 0.0;          ///< there
  std::size_t proposals = 0;
  std::size_t accepted = 0;
  std::vector<WalkSample> trace;  ///< the start and every accepted sample, if asked for
};

/// The start poses in the order rotation, row, column, with their measures, from which Delta follows for any
/// c_lock. One that puts the maps too far apart to be measured has all distances undefined. Measured in
/// parallel in the calling TBB arena; the result does not depend on threads. Throws
/// std::invalid_argument for invalid grids, maps that are too large (see SimilarityMeter), or options that
/// make no sense. O(poses) measurements.
std::vector<MeasuredPose> measure_start_poses(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                              const StartPoseOptions& options = {});

/// The adaptive random walk of Birk & Carpin 2006 (algorithm 1) from one pose. It minimises Delta = psi +
/// c_lock * (dis - agr). Proposals are normal; their mean and covariance are those of the steps between the
/// last `memory` accepted samples, with the covariance's eigenvalues held between smallest_step^2 and
/// largest_step^2. After every 100 refusals in a row their mean becomes 0 and they are halved, and they are
/// back at their size when they would fall below smallest_step. A rotation counts as the way that it moves a
/// cell at the moving map's root mean square radius. A proposal that takes maps that lie apart for certain
/// farther apart, or farther than can be measured, is refused without being measured. A sample with fewer
/// undefined distances is better whatever its Delta (is_better()), and one with more is never accepted.
///
/// The same seed gives the same walk on the same machine. Throws std::invalid_argument for invalid grids,
/// options or start. O(proposals) measurements.
RandomWalkResult random_walk(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& start,
                             const RandomWalkOptions& options = {});

/// Throws std::invalid_argument, saying what is wrong, for options that make no sense.
void validate(const RandomWalkOptions& options);

}  // namespace gridmerge
