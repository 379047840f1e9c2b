// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
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
  SE2 T_fixed_moving;          ///< between map frames [m, rad]
  ImageSimilarity similarity;  ///< at the pose
};

/// Which samples a walk's trace holds.
enum class WalkTrace {
  none,      ///< nothing
  accepted,  ///< the start, and those that the walk went to
  all,       ///< every proposal; a wide one that the walk went to later stands there once more
};

/// How a walk goes.
struct RandomWalkOptions {
  double c_lock = 0.0;          ///< weight of (dis - agr) in Delta; not negative
  std::size_t memory = 10;      ///< M: accepted steps that set the mean and covariance of proposals, >= 4
  double first_step = 10.0;     ///< standard deviation of proposals before anything is accepted [cells]
  double smallest_step = 0.25;  ///< bounds of a proposal's standard deviation in any direction [cells]
  double largest_step = 40.0;   ///< the upper one of these bounds [cells]
  /// Share of proposals that are drawn from all poses at which the maps may touch, in [0, 1]: what lets the
  /// walk leave the place where it is (see random_walk()). From wrong starts, shares from 0.02 to 0.5 came to
  /// the truth after some thousand proposals; a small one leaves most of them to the walk. Without any, the
  /// walk stayed in the wrong place from most.
  double wide_share = 0.05;
  /// A sample worse by d is accepted with probability exp(-d / temperature). 0 never accepts one: hill
  /// climbing.
  double temperature = 0.0;
  /// The temperature is multiplied with this after every proposal: 1 keeps it, less is simulated annealing.
  double cooling = 1.0;
  /// Proposals without an improvement of the best sample after which to stop, whatever the temperature: that
  /// the walk still goes to worse samples and back is none.
  std::size_t patience = 2000;
  std::size_t max_proposals = 200000;  ///< stop then in any case
  std::uint64_t seed = 1;              ///< of the proposals
  WalkTrace trace = WalkTrace::none;   ///< what RandomWalkResult::trace holds
};

/// A sample of a walk.
struct WalkSample {
  std::size_t step = 0;  ///< proposals made so far; 0 is the start
  SE2 T_fixed_moving;    ///< between map frames [m, rad]
  bool accepted = true;  ///< the walk went there
  bool wide = false;     ///< it was drawn from all poses
  /// Whether it was measured before it was refused: what lies apart need not be. Without, `delta` and
  /// `similarity` say nothing.
  bool measured = true;
  double delta = 0.0;          ///< psi + c_lock * (dis - agr)
  ImageSimilarity similarity;  ///< what Delta is made of
};

/// What a walk found.
struct RandomWalkResult {
  SE2 T_fixed_moving;             ///< the best sample, between map frames [m, rad]
  ImageSimilarity similarity;     ///< there
  double delta = 0.0;             ///< there
  std::size_t proposals = 0;      ///< samples that were tried
  std::size_t accepted = 0;       ///< moves of the walk
  std::vector<WalkSample> trace;  ///< what WalkTrace asks for, by step
};

/// Measures poses of one pair, in parallel in the calling TBB arena; the result does not depend on threads. A
/// pose that puts the maps too far apart to be measured has all distances undefined. Throws
/// std::invalid_argument for invalid grids and maps that are too large (see SimilarityMeter). O(poses)
/// measurements.
GRIDMERGE_EXPORT std::vector<MeasuredPose> measure_poses(const OccupancyGrid& fixed,
                                                         const OccupancyGrid& moving,
                                                         std::span<const SE2> poses);

/// Evenly spaced poses from one to another, both included: the landscape along a cut when they are measured.
/// The centre of the moving map's known rectangle goes straight, and the map turns the shorter way. Throws
/// std::invalid_argument for an invalid grid, for poses that are not finite, and for a count below 2.
GRIDMERGE_EXPORT std::vector<SE2> poses_between(const OccupancyGrid& moving, const SE2& from, const SE2& to,
                                                int count);

/// The start poses in the order rotation, row, column, with their measures, from which Delta follows for any
/// c_lock: measure_poses() of them. Throws std::invalid_argument also for options that make no sense, and for
/// more than 10^6 poses.
GRIDMERGE_EXPORT std::vector<MeasuredPose> measure_start_poses(const OccupancyGrid& fixed,
                                                               const OccupancyGrid& moving,
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
/// The paper's theorem 1 says that the walk comes to the best pose with probability 1 if proposals reach
/// every pose with a positive probability. Those that are learnt do not: they shrink to where the walk is,
/// and their tails are 0 to a computer. So a share w of the proposals is wide: drawn evenly from the set S of
/// all poses at which the circles around the known rectangles meet. Any set A of poses in S is then missed by
/// n proposals with a probability of at most (1 - w |A| / |S|)^n, which goes to 0, whatever else the walk
/// does; the result is the best sample of all, so what was hit is kept.
///
/// A wide sample that is better than the current one is accepted as any other. The best one of the rest is
/// kept for when the walk is at the end of a valley, which is when its steps have shrunk to the smallest in
/// vain: the selector then takes the walk there, though it is worse, and the walk learns its steps anew. A
/// valley so costs some hundred proposals, and the next begins at the best of some dozen wide samples.
/// Without wide proposals the steps start again at their size.
///
/// The same seed gives the same walk on the same machine. Throws std::invalid_argument for invalid grids,
/// options or start. O(proposals) measurements.
GRIDMERGE_EXPORT RandomWalkResult random_walk(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                              const SE2& start, const RandomWalkOptions& options = {});

/// Throws std::invalid_argument, saying what is wrong, for options that make no sense.
GRIDMERGE_EXPORT void validate(const RandomWalkOptions& options);
/// Throws std::invalid_argument, saying what is wrong, for options that make no sense.
GRIDMERGE_EXPORT void validate(const StartPoseOptions& options);

}  // namespace gridmerge
