// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/random_walk_match.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <mutex>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "match/pair_pose.hpp"
#include "similarity/lattice_frames.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr double kDistinct = 10.0;  // cells at the corners of the moving map

double c_lock_of(const RandomWalkMatchOptions& options, int walk) {
  return options.c_locks[static_cast<std::size_t>(walk) % options.c_locks.size()];
}

/// Seeds that have nothing to do with one another, nor with those of the next larger `seed`; that of the
/// first walk is `seed` itself.
std::uint64_t derive_seed(std::uint64_t seed, std::size_t walk) {
  std::seed_seq sequence{seed & 0xffffffffU, seed >> 32, static_cast<std::uint64_t>(walk)};
  std::array<std::uint32_t, 2> words{};
  sequence.generate(words.begin(), words.end());
  return walk == 0 ? seed : (std::uint64_t{words[1]} << 32) | words[0];
}

/// The `rank`-th best start pose under c_lock; from the best one again when there are not as many.
SE2 choose_start(const std::vector<MeasuredPose>& starts, double c_lock, std::size_t rank) {
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return is_better(starts[a].similarity, starts[b].similarity, c_lock);
  });
  return starts[order[rank % order.size()]].T_fixed_moving;
}

std::vector<RandomWalkResult> run_walks(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                        const RandomWalkMatchOptions& options) {
  std::vector<MeasuredPose> starts;
  if (options.start_pose) {
    starts = measure_poses(fixed, moving, {&*options.start_pose, 1});
  } else {
    starts = measure_start_poses(fixed, moving, options.start);
  }
  std::vector<RandomWalkResult> walks(static_cast<std::size_t>(options.restarts));
  std::mutex reporting;
  int done = 0;
  parallel_for(walks.size(), [&](std::size_t i) {
    RandomWalkOptions walk = options.walk;
    walk.c_lock = c_lock_of(options, static_cast<int>(i));
    walk.seed = derive_seed(walk.seed, i);
    walks[i] =
        random_walk(fixed, moving, choose_start(starts, walk.c_lock, i / options.c_locks.size()), walk);
    const std::lock_guard lock(reporting);
    ++done;
    if (options.progress) options.progress(static_cast<double>(done) / options.restarts);
  });
  return walks;
}

/// The largest distance between where two poses put a corner of the moving map [m].
double displacement(const OccupancyGrid& moving, const SE2& a, const SE2& b) {
  double largest = 0.0;
  for (const double x : {0.0, moving.width * moving.resolution}) {
    for (const double y : {0.0, moving.height * moving.resolution}) {
      const Point2 corner = moving.origin * Point2{x, y};
      const Point2 at_a = a * corner;
      const Point2 at_b = b * corner;
      largest = std::max(largest, std::hypot(at_a.x - at_b.x, at_a.y - at_b.y));
    }
  }
  return largest;
}

std::vector<Hypothesis> list_distinct(const std::vector<const RandomWalkResult*>& walks,
                                      const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                      std::size_t most) {
  std::vector<Hypothesis> hypotheses;
  for (const RandomWalkResult* walk : walks) {
    if (hypotheses.size() == most) break;
    const bool known = std::any_of(hypotheses.begin(), hypotheses.end(), [&](const Hypothesis& hypothesis) {
      return displacement(moving, hypothesis.T_fixed_moving, walk->T_fixed_moving) <
             kDistinct * fixed.resolution;
    });
    const double index = walk->similarity.acceptance_index();
    if (!known) hypotheses.push_back({walk->T_fixed_moving, index, index});
  }
  return hypotheses;
}

}  // namespace

MatchResult match_by_random_walk(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                 const RandomWalkMatchOptions& options) {
  validate(fixed);
  validate(moving);
  validate(options);
  const auto start = std::chrono::steady_clock::now();
  MatchResult result;
  if (count_cells(fixed).known() == 0 || count_cells(moving).known() == 0) return result;
  if (options.start_pose && !lie_on_each_other(fixed, moving, *options.start_pose))
    throw std::invalid_argument("the start puts the maps apart: no cell of the one lies on the other");

  std::vector<RandomWalkResult> walks;
  with_threads(options.threads, [&] { walks = run_walks(fixed, moving, options); });
  std::vector<const RandomWalkResult*> ranked;
  ranked.reserve(walks.size());
  for (const RandomWalkResult& walk : walks) ranked.push_back(&walk);
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto* a, const auto* b) {
    const auto key = [](const ImageSimilarity& similarity) {
      return std::pair(similarity.undefined_terms(), -similarity.acceptance_index());
    };
    return key(a->similarity) < key(b->similarity);
  });

  const RandomWalkResult& best = *ranked.front();
  result.hypotheses = list_distinct(ranked, fixed, moving, options.max_hypotheses);
  result.T_fixed_moving = best.T_fixed_moving;
  // The counts are in cells of the fixed map.
  set_common({best.similarity.agreement, best.similarity.disagreement}, moving, fixed, result);
  result.probability = result.acceptance_index;
  // Without free or without occupied cells in both maps every pose at which they touch has a perfect index.
  const bool comparable = result.agreement + result.disagreement >= options.least_common_cells &&
                          best.similarity.undefined_terms() == 0;
  const bool accepted = comparable && result.acceptance_index >= options.accept_acceptance_index;
  result.verdict = accepted ? Verdict::accepted : Verdict::refused;
  result.reason = accepted ? Reason::none : !comparable ? Reason::too_little_overlap : Reason::contradiction;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.on_walk) {
    for (int i = 0; i < options.restarts; ++i)
      options.on_walk(i, c_lock_of(options, i), walks[static_cast<std::size_t>(i)]);
  }
  return result;
}

void validate(const RandomWalkMatchOptions& options) {
  RandomWalkOptions walk = options.walk;
  if (options.restarts < 1) throw std::invalid_argument("restarts must be at least 1");
  if (options.threads < 0) throw std::invalid_argument("threads must not be negative");
  if (options.start_pose) {
    if (!is_finite(*options.start_pose)) throw std::invalid_argument("the start pose must be finite");
  } else {
    validate(options.start);
  }
  if (options.c_locks.empty()) throw std::invalid_argument("at least one c_lock is needed");
  for (const double c_lock : options.c_locks) {
    walk.c_lock = c_lock;
    validate(walk);
  }
  if (options.least_common_cells < 0) throw std::invalid_argument("least_common_cells must not be negative");
  if (!(options.accept_acceptance_index >= 0.0 && options.accept_acceptance_index <= 1.0))
    throw std::invalid_argument("accept_acceptance_index must lie in [0, 1]");
}

}  // namespace gridmerge
