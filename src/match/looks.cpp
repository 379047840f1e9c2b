// SPDX-License-Identifier: Apache-2.0
#include "match/looks.hpp"

#include <algorithm>

#include "grid/parallel.hpp"
#include "search/thorough.hpp"

namespace gridmerge::internal {

namespace {

/// Distinct poses of the quick look that get all figures.
constexpr std::size_t kRankedPoses = 6;
/// Distinct poses of the thorough look whose cells are counted, and of them those that get all figures.
constexpr std::size_t kCountedPoses = 40;
constexpr std::size_t kThoroughPoses = 12;

std::vector<Hypothesis> judge_all(const PoseJudge& judge, const std::vector<SE2>& T_cells) {
  std::vector<Hypothesis> judged(T_cells.size());
  parallel_for(T_cells.size(), [&](std::size_t i) { judged[i] = judge.judge(T_cells[i]); });
  std::erase_if(judged, [](const Hypothesis& hypothesis) { return !(hypothesis.score > 0.0); });
  return judged;
}

RefineOptions refinement_of(const ComparedMaps& maps, double coarse_factor, std::size_t max_poses,
                            RankBy rank) {
  RefineOptions refinement;
  refinement.coarse_cell = coarse_factor;
  refinement.distinct = distinct_displacement(maps);
  refinement.max_poses = max_poses;
  refinement.rank = rank;
  return refinement;
}

std::vector<Hypothesis> look_quickly(const ComparedMaps& maps, const PoseJudge& judge,
                                     const std::function<void(double)>& report) {
  const ExhaustiveSearchOptions search = choose_search(maps);
  const std::vector<PoseCandidate> candidates = search_all_poses(maps.fixed_walls, maps.moving_walls, search);
  report(0.5);
  const RefineOptions refinement = refinement_of(maps, search.coarse_factor, kRankedPoses, RankBy::amount);
  std::vector<SE2> T_cells;
  for (const ScoredPose& pose : refine(judge.walls(), maps.moving_walls, candidates, refinement,
                                       [&](double share) { report(0.5 + 0.4 * share); }))
    T_cells.push_back(pose.T_fixed_moving);
  return judge_all(judge, T_cells);
}

std::vector<Hypothesis> look_thoroughly(const ComparedMaps& maps, const PoseJudge& judge,
                                        const std::function<void(double)>& report) {
  const ExhaustiveSearchOptions quick = choose_search(maps);
  ThoroughSearchOptions search;
  search.coarse_factor = quick.coarse_factor;
  search.rotations = quick.rotations;
  search.sigma = quick.sigma;
  const std::vector<PoseCandidate> candidates =
      search_thoroughly(maps.fixed_walls, maps.moving_walls, search);
  report(0.5);
  const RefineOptions refinement = refinement_of(maps, search.coarse_factor, kCountedPoses, RankBy::quality);
  const std::vector<ScoredPose> poses = refine(judge.walls(), maps.moving_walls, candidates, refinement,
                                               [&](double share) { report(0.5 + 0.4 * share); });
  // By the rank as far as it is known without the dear figures.
  struct Promising {
    SE2 T_cells;
    double rank;
  };
  std::vector<Promising> promising(poses.size());
  parallel_for(poses.size(), [&](std::size_t i) {
    const SE2& T_cells = poses[i].T_fixed_moving;
    promising[i] = {T_cells, rank_of(judge.cheap_figures(T_cells, poses[i].evidence))};
  });
  std::stable_sort(promising.begin(), promising.end(),
                   [](const Promising& a, const Promising& b) { return a.rank > b.rank; });
  std::vector<SE2> T_cells;
  for (std::size_t i = 0; i < std::min(promising.size(), kThoroughPoses); ++i)
    T_cells.push_back(promising[i].T_cells);
  return judge_all(judge, T_cells);
}

/// Of those that show one place the one that more speaks for.
std::vector<Hypothesis> keep_distinct(std::vector<Hypothesis> all, const ComparedMaps& maps) {
  const PoseMetric metric = make_pose_metric(maps.moving_walls);
  const double distinct = distinct_displacement(maps);
  const auto in_cells = [&](const Hypothesis& one) {
    return to_cells(one.T_fixed_moving, maps.fixed_walls, maps.moving_walls);
  };
  weigh(all, maps);
  std::vector<Hypothesis> kept;
  for (const Hypothesis& one : all) {
    const SE2 T_one = in_cells(one);
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Hypothesis& other) {
      return metric.displacement(in_cells(other), T_one) < distinct;
    });
    if (is_new) kept.push_back(one);
  }
  return kept;
}

/// Weighs them, and brings the best one to its maximum. If that lays cell on cell, it fits without a
/// remainder: a rival a part of a cell beside such a pose would lose for that part alone, so all are brought
/// to theirs. Some may come to one place by that.
void weigh_and_settle(std::vector<Hypothesis>& hypotheses, const ComparedMaps& maps, const PoseJudge& judge) {
  weigh(hypotheses, maps);
  if (hypotheses.empty()) return;
  const Settled best = judge.settle(hypotheses.front());
  hypotheses.front() = best.hypothesis;
  if (best.is_cell_on_cell) {
    parallel_for(hypotheses.size() - 1,
                 [&](std::size_t i) { hypotheses[i + 1] = judge.settle(hypotheses[i + 1]).hypothesis; });
  }
  hypotheses = keep_distinct(std::move(hypotheses), maps);
  weigh(hypotheses, maps);
}

}  // namespace

std::vector<Hypothesis> find_hypotheses(const ComparedMaps& maps, const LookOptions& options) {
  const auto report = [&](double share) {
    if (options.progress) options.progress(share);
  };
  const bool may_look_twice = options.search == SearchMethod::exhaustive;
  report(0.1);
  const PoseJudge judge(maps);
  std::vector<Hypothesis> hypotheses;
  if (options.search != SearchMethod::thorough) {
    const double share = may_look_twice ? 0.3 : 1.0;
    if (options.quick_look != nullptr) {
      hypotheses = *options.quick_look;
    } else {
      hypotheses = look_quickly(maps, judge, [&](double done) { report(0.1 + share * 0.9 * done); });
      weigh_and_settle(hypotheses, maps, judge);
    }
    const double best = hypotheses.empty() ? 0.0 : hypotheses.front().probability;
    if (!may_look_twice || best >= options.decided_from) return hypotheses;
  }
  const std::vector<Hypothesis> found =
      look_thoroughly(maps, judge, [&](double done) { report(0.37 + 0.63 * done); });
  hypotheses.insert(hypotheses.end(), found.begin(), found.end());
  hypotheses = keep_distinct(std::move(hypotheses), maps);
  weigh_and_settle(hypotheses, maps, judge);
  return hypotheses;
}

}  // namespace gridmerge::internal
