// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "gridmerge/grid/parallel.hpp"
#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/match/refine.hpp"
#include "gridmerge/match/verdict.hpp"
#include "gridmerge/match/walls_met.hpp"
#include "gridmerge/search/exhaustive.hpp"
#include "gridmerge/similarity/agreement.hpp"
#include "gridmerge/similarity/wall_lines.hpp"
#include "gridmerge/similarity/wall_map.hpp"

namespace gridmerge {

namespace {

/// Larger maps are compared in larger cells, but no larger than rooms and doors allow...
constexpr double kCellsAlongSide = 800.0;
constexpr double kCoarsestCell = 0.1;  // [m], unless the maps themselves are coarser
/// ...up to where time and memory have to be bounded.
constexpr double kMaxCellsAlongSide = 4000.0;
/// Small maps are searched in finer steps, large ones in coarser: the search takes about the same time for
/// all.
constexpr double kCoarseCellsAlongSide = 150.0;
constexpr double kCoarseSigma = 0.8;  // tolerance of the search [coarse cells]
/// Steps of rotation move the walls by so much on average, within bounds.
constexpr double kTurnStep = 2.0;  // coarse cells
constexpr int kLeastRotations = 180;
constexpr int kMostRotations = 720;
/// Poses nearer than this share of the larger map's side, and never less than kMinDistinct, are one
/// hypothesis.
constexpr double kDistinctShare = 0.03;
constexpr double kMinDistinct = 10.0;  // cells
/// About so many cells decide how much of the common area agrees.
constexpr double kRankedCells = 60000.0;
/// Distinct poses that are ranked. More than most callers ask for: the true one may come up from behind.
constexpr std::size_t kRankedPoses = 12;

double longer_side(const OccupancyGrid& grid) {
  return std::max(grid.width, grid.height) * grid.resolution;
}

/// A hypothesis between map frames, from one between grid frames in cells.
SE2 to_map_frames(const SE2& T_cells, const WallMap& fixed, const WallMap& moving) {
  const SE2 T_metres{T_cells.x * fixed.cell, T_cells.y * fixed.cell, T_cells.theta};
  return fixed.T_map_grid * T_metres * inverse(moving.T_map_grid);
}

/// The inverse of to_map_frames().
SE2 to_cells(const SE2& T_fixed_moving, const WallMap& fixed, const WallMap& moving) {
  const SE2 T_metres = inverse(fixed.T_map_grid) * T_fixed_moving * moving.T_map_grid;
  return {T_metres.x / fixed.cell, T_metres.y / fixed.cell, T_metres.theta};
}

void report(const MatchOptions& options, double share) {
  if (options.progress) options.progress(share);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct RankedPose {
  Hypothesis hypothesis;
  Evidence walls;
};

/// Adds to each pose the evidence of the area that both maps know, and puts the best first. Poses that on the
/// whole speak against themselves are dropped.
std::vector<RankedPose> rank(const std::vector<ScoredPose>& poses, const OccupancyGrid& fixed,
                             const OccupancyGrid& moving, const WallMap& fixed_walls,
                             const WallMap& moving_walls) {
  const double known = static_cast<double>(moving.cells.size());
  const int stride = std::max(1, static_cast<int>(std::sqrt(known / kRankedCells)));
  const double cells_per_cell = std::pow(moving.resolution / moving_walls.cell, 2);
  std::vector<RankedPose> ranked;
  for (const ScoredPose& pose : poses) {
    const SE2 T_fixed_moving = to_map_frames(pose.T_fixed_moving, fixed_walls, moving_walls);
    const AgreementCounts common = count_agreement(fixed, moving, T_fixed_moving, stride);
    const double score =
        pose.evidence.score + area_evidence(cells_per_cell * static_cast<double>(common.agreement),
                                            cells_per_cell * static_cast<double>(common.disagreement));
    if (score > 0.0) ranked.push_back({{T_fixed_moving, score, 0.0}, pose.evidence});
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedPose& a, const RankedPose& b) {
    return a.hypothesis.score > b.hypothesis.score;
  });
  return ranked;
}

struct FoundHypotheses {
  std::vector<Hypothesis> ranked;  // best first
  VerdictFeatures features;        // of the best one; what needs no more than the walls
};

VerdictFeatures describe_walls(const std::vector<RankedPose>& ranked, const WallMap& fixed_walls,
                               const WallMap& moving_walls) {
  const RankedPose& best = ranked.front();
  const SE2 T_cells = to_cells(best.hypothesis.T_fixed_moving, fixed_walls, moving_walls);
  const WallSupport support = measure_wall_support(fixed_walls, moving_walls, T_cells);
  std::vector<double> scores;
  scores.reserve(ranked.size());
  for (const RankedPose& pose : ranked) scores.push_back(pose.hypothesis.score);
  VerdictFeatures features;
  features.lead = find_lead(scores);
  features.wall_lines = support.lines;
  features.score = best.hypothesis.score;
  features.nats_per_wall = best.walls.seen_walls > 0.0 ? best.walls.score / best.walls.seen_walls : 0.0;
  features.spread = support.spread * fixed_walls.cell;
  features.sigma = best.walls.model.sigma * fixed_walls.cell;
  features.outliers = best.walls.model.outliers;
  const WallsMet met = measure_walls_met(fixed_walls, moving_walls, T_cells);
  features.walls_met = met.rigidly;
  features.walls_met_locally = met.locally;
  return features;
}

/// `moving` is the map that is_smaller() picked.
FoundHypotheses find_hypotheses(const PreparedMap& fixed, const PreparedMap& moving,
                                const MatchOptions& options) {
  const double cell = working_cell(fixed, moving);
  const WallMap& fixed_walls = fixed.walls(cell);
  const WallMap& moving_walls = moving.walls(cell);
  report(options, 0.1);

  const double side = std::max(longer_side(fixed.known()), longer_side(moving.known())) / cell;
  ExhaustiveSearchOptions search;
  search.coarse_factor = std::clamp(static_cast<int>(std::ceil(side / kCoarseCellsAlongSide)), 2, 4);
  search.sigma = kCoarseSigma * search.coarse_factor;
  const double radius = make_pose_metric(moving_walls).radius / search.coarse_factor;
  search.rotations = std::clamp(static_cast<int>(std::ceil(2.0 * std::numbers::pi * radius / kTurnStep)),
                                kLeastRotations, kMostRotations);
  const std::vector<PoseCandidate> candidates = search_all_poses(fixed_walls, moving_walls, search);
  report(options, 0.5);

  RefineOptions refinement;
  refinement.coarse_cell = search.coarse_factor;
  refinement.distinct = std::max(kMinDistinct, kDistinctShare * side);
  refinement.max_poses = std::max(kRankedPoses, options.max_hypotheses);
  const std::vector<ScoredPose> poses = refine(fixed_walls, moving_walls, candidates, refinement,
                                               [&](double share) { report(options, 0.5 + 0.45 * share); });
  const std::vector<RankedPose> ranked =
      rank(poses, fixed.known(), moving.known(), fixed_walls, moving_walls);
  FoundHypotheses found;
  if (ranked.empty()) return found;
  found.features = describe_walls(ranked, fixed_walls, moving_walls);
  found.ranked.reserve(ranked.size());
  for (const RankedPose& pose : ranked) found.ranked.push_back(pose.hypothesis);
  return found;
}

/// The model says how probable it is that the best hypothesis is true, given its lead over the next. Measured
/// against the hypothesis after the first m, the same says that the truth is among these m; what the m-th
/// adds to that is its own. None is called likelier than the best.
void assign_probabilities(std::vector<Hypothesis>& hypotheses, const VerdictFeatures& features) {
  hypotheses[0].probability = probability_of(features);
  double among_those_before = hypotheses[0].probability;
  for (std::size_t i = 1; i < hypotheses.size(); ++i) {
    const bool last = i + 1 == hypotheses.size();
    // What comes after the last of the poses that are ranked is not known; after fewer there is nothing.
    const bool unknown = last && hypotheses.size() >= kRankedPoses;
    const double next = last ? 0.0 : hypotheses[i + 1].score;
    const double among_these =
        unknown ? among_those_before : probability_among(features, hypotheses[0].score, next);
    hypotheses[i].probability = std::min(hypotheses[0].probability, among_these - among_those_before);
    among_those_before = among_these;
  }
}

MatchResult match_in_arena(const PreparedMap& fixed, const PreparedMap& moving, const MatchOptions& options) {
  // The smaller map's walls have the best chance to be met in the other one; and so the answer does not
  // depend on which map the caller called fixed.
  const bool swapped = is_smaller(fixed, moving);
  const PreparedMap& larger = swapped ? moving : fixed;
  const PreparedMap& smaller = swapped ? fixed : moving;

  MatchResult result;
  FoundHypotheses found = find_hypotheses(larger, smaller, options);
  result.hypotheses = std::move(found.ranked);
  if (result.hypotheses.empty()) return result;
  const AgreementCounts counts =
      count_agreement(larger.known(), smaller.known(), result.hypotheses.front().T_fixed_moving);
  result.acceptance_index = counts.acceptance_index();
  result.agreement = counts.agreement;
  result.disagreement = counts.disagreement;
  result.overlap = measure_overlap(larger.known(), smaller.known(), counts);
  result.features = found.features;
  result.features.acceptance_index = result.acceptance_index;
  result.features.overlap = result.overlap;
  result.features.common_area =
      static_cast<double>(counts.both_known()) * smaller.known().resolution * smaller.known().resolution;
  assign_probabilities(result.hypotheses, result.features);

  if (swapped) {
    for (Hypothesis& hypothesis : result.hypotheses)
      hypothesis.T_fixed_moving = inverse(hypothesis.T_fixed_moving);
  }
  const Hypothesis& best = result.hypotheses.front();
  result.T_fixed_moving = best.T_fixed_moving;
  result.probability = best.probability;
  result.verdict = best.probability >= options.accept_probability ? Verdict::accepted : Verdict::refused;
  result.reason = explain_refusal(result.features, options.accept_probability);
  if (result.hypotheses.size() > options.max_hypotheses) result.hypotheses.resize(options.max_hypotheses);
  return result;
}

}  // namespace

MatchResult match(const OccupancyGrid& fixed, const OccupancyGrid& moving, const MatchOptions& options) {
  validate(options);
  const auto start = std::chrono::steady_clock::now();
  MatchResult result;
  const PreparedMap prepared_fixed(fixed), prepared_moving(moving);
  with_threads(options.threads, [&] { result = match(prepared_fixed, prepared_moving, options); });
  result.seconds = seconds_since(start);
  report(options, 1.0);
  return result;
}

MatchResult match(const PreparedMap& fixed, const PreparedMap& moving, const MatchOptions& options) {
  validate(options);
  const auto start = std::chrono::steady_clock::now();
  MatchResult result = match_in_arena(fixed, moving, options);
  result.seconds = seconds_since(start);
  return result;
}

double working_cell(const PreparedMap& fixed, const PreparedMap& moving) {
  const double resolution = std::max(fixed.known().resolution, moving.known().resolution);
  const double side = std::max(longer_side(fixed.known()), longer_side(moving.known())) / resolution;
  const double wanted = std::ceil(side / kCellsAlongSide);
  const double least = std::ceil(side / kMaxCellsAlongSide);
  const double most = std::floor(kCoarsestCell / resolution + 1e-9);
  return resolution * std::max({1.0, least, std::min(wanted, most)});
}

void validate(const MatchOptions& options) {
  if (options.threads < 0) throw std::invalid_argument("threads must not be negative");
  if (!(options.accept_probability >= 0.0 && options.accept_probability <= 1.0)) {
    throw std::invalid_argument("accept_probability must lie in [0, 1]");
  }
}

}  // namespace gridmerge
