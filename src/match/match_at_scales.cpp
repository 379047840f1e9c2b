// SPDX-License-Identifier: Apache-2.0
#include "match/match_at_scales.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "grid/longer_side.hpp"
#include "gridmerge/grid/execution.hpp"
#include "match/drawn_walls.hpp"
#include "match/prepared_map.hpp"
#include "match/scaled_pair.hpp"
#include "match/scaled_verdict.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kLevelStep = 0.03;  // between levels, of the scale's logarithm
/// How far a pose may climb from the scale at which it was found: half a step and some; and at the end.
constexpr double kReach = 1.02;
constexpr double kFinalReach = 1.04;

constexpr std::size_t kPosesOfLevel = 4;
constexpr std::size_t kJudged = 16;  // distinct poses that get all figures at their own scale

constexpr double kCoarsestCell = 0.1;     // [m], unless the maps themselves are coarser; two of the fixed map
constexpr double kDistinctShare = 0.03;   // of the fixed map's longer side: poses nearer than this are one
constexpr double kMinDistinctCells = 10;  // ...and never less than so many cells
constexpr double kNearDistinct = 2.0;     // poses nearer than so many times that are near each other

/// A pose that a level proposes, between the map frames.
struct Found {
  ScaledPose pose;
  double probability = 0.0;  ///< among the poses of its level, as if there were no other scale
};

/// The range of scales of a pair, and what all of it have in common.
class ScaledSearch {
 public:
  ScaledSearch(const PreparedMap& fixed, const PreparedMap& moving, const ScaleRange& scales)
      : fixed_(fixed),
        moving_(moving),
        scales_(scales),
        levels_(levels_of(scales, fixed.known().resolution / moving.known().resolution)) {
    // One size of cells for all levels, and for any range, as far as can be: what is scored in larger cells
    // scores less.
    const PreparedMap smallest = DrawnWalls::scaled(moving, scales.least);
    cell_ = std::max(working_cell(fixed, smallest), std::min(kCoarsestCell, 2.0 * fixed.known().resolution));
    distinct_ = std::max(kMinDistinctCells * cell_, kDistinctShare * longer_side(fixed.known()));
    const LikelihoodField& walls = DrawnWalls::of(smallest, cell_);
    const PoseMetric in_cells = make_pose_metric(walls);
    const Point2 pivot = walls.T_map_grid * Point2{in_cells.pivot.x * cell_, in_cells.pivot.y * cell_};
    metric_.pivot = {pivot.x / scales.least, pivot.y / scales.least};
    metric_.radius = in_cells.radius * cell_ / scales.least;
  }

  /// What a look at every level proposes.
  std::vector<Found> look(SearchMethod search, const std::function<void(double)>& report) const {
    std::vector<Found> found;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      throw_if_cancelled();
      const ScaledPair pair(fixed_, moving_, levels_[i], cell_);
      for (const Hypothesis& one : pair.look(search, kPosesOfLevel)) {
        const ScaledPose pose = pair.settle({one.T_fixed_moving, one.scale}, kReach);
        found.push_back({pose, one.probability});
      }
      report(static_cast<double>(i + 1) / static_cast<double>(levels_.size()));
    }
    return found;
  }

  /// The best of them, brought to the maximum over their scales, with all figures, weighed against each
  /// other: most probable first.
  std::vector<Hypothesis> judge(std::vector<Found> found, const std::function<void(double)>& report) const {
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return a.probability > b.probability; });
    std::vector<ScaledPose> starts;
    for (const Found& one : found) {
      if (starts.size() == kJudged) break;
      if (is_new(one.pose, starts)) starts.push_back(one.pose);
    }
    std::vector<ScaledPose> poses;
    std::vector<Hypothesis> judged;
    for (const ScaledPose& start : starts) {
      throw_if_cancelled();
      const ScaledPose pose =
          within_range(ScaledPair(fixed_, moving_, start.scale, cell_).settle(start, kFinalReach));
      report(static_cast<double>(judged.size() + 1) / static_cast<double>(starts.size()));
      if (!is_new(pose, poses)) continue;
      poses.push_back(pose);
      const Hypothesis one = ScaledPair(fixed_, moving_, pose.scale, cell_).judge(pose.T);
      if (one.score > 0.0) judged.push_back(one);
    }
    weigh_scaled(judged, levels_.size(), [&](const Hypothesis& a, const Hypothesis& b) {
      return distance(pose_of(a), pose_of(b)) < kNearDistinct * distinct_;
    });
    return judged;
  }

  std::size_t levels() const { return levels_.size(); }

  void count_common(MatchResult& result) const {
    ScaledPair(fixed_, moving_, result.scale, cell_).count_common(result);
  }

 private:
  static ScaledPose pose_of(const Hypothesis& one) { return {one.T_fixed_moving, one.scale}; }

  double distance(const ScaledPose& a, const ScaledPose& b) const {
    return displacement(metric_.pivot, metric_.radius, a, b);
  }

  bool is_new(const ScaledPose& pose, const std::vector<ScaledPose>& others) const {
    return std::none_of(others.begin(), others.end(),
                        [&](const ScaledPose& other) { return distance(pose, other) < distinct_; });
  }

  /// With a scale of the range, about the middle of the moving map's walls.
  ScaledPose within_range(const ScaledPose& pose) const {
    ScaledPose within{pose.T, std::clamp(pose.scale, scales_.least, scales_.most)};
    const Point2 wanted = pose * metric_.pivot, now = within * metric_.pivot;
    within.T.x += wanted.x - now.x;
    within.T.y += wanted.y - now.y;
    return within;
  }

  const PreparedMap& fixed_;
  const PreparedMap& moving_;
  ScaleRange scales_;
  std::vector<double> levels_;
  double cell_;
  double distinct_;    // [m]
  PoseMetric metric_;  // of the moving map's walls, in metres of its frame
};

void check_walls(const PreparedMap& map, const char* which) {
  if (map.counts().occupied > 0) return;
  throw std::invalid_argument(std::string("the ") + which + " map has no walls by which to tell a scale");
}

}  // namespace

std::vector<double> levels_of(const ScaleRange& scales, double unit) {
  const auto nearest = [&](double scale) { return std::lround(std::log(scale / unit) / kLevelStep); };
  const auto first = nearest(scales.least), last = nearest(scales.most);
  if (first == last) return {std::sqrt(scales.least * scales.most)};
  std::vector<double> levels;
  for (auto i = first; i <= last; ++i)
    levels.push_back(
        std::clamp(unit * std::exp(static_cast<double>(i) * kLevelStep), scales.least, scales.most));
  return levels;
}

MatchResult match_at_scales(const PreparedMap& fixed, const PreparedMap& moving,
                            const MatchOptions& options) {
  check_walls(fixed, "fixed");
  check_walls(moving, "moving");
  const auto report = [&](double share) {
    if (options.progress) options.progress(share);
  };
  const ScaledSearch search(fixed, moving, *options.scales);
  const bool thoroughly = options.search == SearchMethod::thorough;
  std::vector<Found> found = search.look(thoroughly ? SearchMethod::thorough : SearchMethod::quick,
                                         [&](double share) { report(0.8 * share); });
  MatchResult result;
  result.hypotheses = search.judge(std::move(found), [&](double share) { report(0.8 + 0.2 * share); });
  result.reason = explain_refusal(figures_of(result.hypotheses), options.accept_probability,
                                  scaled_model(search.levels()));
  if (result.hypotheses.empty()) return result;
  const Hypothesis& chosen = result.hypotheses.front();
  result.T_fixed_moving = chosen.T_fixed_moving;
  result.scale = chosen.scale;
  result.probability = chosen.probability;
  search.count_common(result);
  result.verdict = result.probability >= options.accept_probability ? Verdict::accepted : Verdict::refused;
  if (result.hypotheses.size() > options.max_hypotheses) result.hypotheses.resize(options.max_hypotheses);
  return result;
}

}  // namespace gridmerge::internal
