// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/search/random_walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "search/step_proposals.hpp"
#include "similarity/lattice_frames.hpp"

namespace gridmerge {

using namespace internal;

namespace {

using Step = StepProposals::Step;

/// The known rectangle of a map, about its centre.
struct Rectangle {
  explicit Rectangle(const OccupancyGrid& map) {
    const OccupancyGrid known = crop_to_known(map);
    half_width = 0.5 * known.width * known.resolution;
    half_height = 0.5 * known.height * known.resolution;
    T_map_centre = known.origin * SE2{half_width, half_height, 0.0};
    double sum = 0.0;
    std::size_t count = 0;
    for (int row = 0; row < known.height; ++row) {
      for (int column = 0; column < known.width; ++column) {
        if (known.at(column, row) == Cell::unknown) continue;
        const double x = (column + 0.5) * known.resolution - half_width;
        const double y = (row + 0.5) * known.resolution - half_height;
        sum += x * x + y * y;
        ++count;
      }
    }
    radius = std::max(known.resolution, count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0);
  }

  double reach() const { return std::hypot(half_width, half_height); }

  double half_width;   // [m]
  double half_height;  // [m]
  double radius;       // root mean square distance of the known cells from the centre [m]
  SE2 T_map_centre;
};

/// Poses of the moving map, told by where its centre lies from the fixed map's and how it is turned.
class Poses {
 public:
  Poses(const OccupancyGrid& fixed, const OccupancyGrid& moving)
      : fixed_(fixed), moving_(moving), cell_(fixed.resolution) {}

  /// `dx`, `dy` [m] along the axes of the fixed map's frame.
  SE2 at(double dx, double dy, double theta) const {
    const SE2 centre{fixed_.T_map_centre.x + dx, fixed_.T_map_centre.y + dy, normalize_angle(theta)};
    return centre * inverse(SE2{moving_.T_map_centre.x, moving_.T_map_centre.y, 0.0});
  }

  SE2 moved(const SE2& T_fixed_moving, const Step& step) const {
    const Point2 centre = T_fixed_moving * Point2{moving_.T_map_centre.x, moving_.T_map_centre.y};
    return at(centre.x - fixed_.T_map_centre.x + step.x() * cell_,
              centre.y - fixed_.T_map_centre.y + step.y() * cell_,
              T_fixed_moving.theta + step.z() * cell_ / moving_.radius);
  }

  Step between(const SE2& from, const SE2& to) const {
    const Point2 centre{moving_.T_map_centre.x, moving_.T_map_centre.y};
    const Point2 a = from * centre;
    const Point2 b = to * centre;
    return {(b.x - a.x) / cell_, (b.y - a.y) / cell_,
            normalize_angle(to.theta - from.theta) * moving_.radius / cell_};
  }

  /// Any pose with gap() <= 0, all alike.
  SE2 anywhere(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> share;
    const double distance = (fixed_.reach() + moving_.reach()) * std::sqrt(share(random));
    const double direction = 2.0 * std::numbers::pi * share(random);
    const double theta = 2.0 * std::numbers::pi * share(random);
    return at(distance * std::cos(direction), distance * std::sin(direction), theta);
  }

  /// How far apart the circles around the known rectangles are [m]. Where they do not meet, and this is
  /// positive, no cells can.
  double gap(const SE2& T_fixed_moving) const {
    const Point2 centre = T_fixed_moving * Point2{moving_.T_map_centre.x, moving_.T_map_centre.y};
    return std::hypot(centre.x - fixed_.T_map_centre.x, centre.y - fixed_.T_map_centre.y) - fixed_.reach() -
           moving_.reach();
  }

 private:
  Rectangle fixed_;
  Rectangle moving_;
  double cell_;  // [m]
};

struct Sample {
  SE2 T_fixed_moving;
  ImageSimilarity similarity;
  double delta;
};

/// The random selector of the paper: decides whether the walk goes to a sample.
bool select(const Sample& proposed, const Sample& current, const RandomWalkOptions& options,
            double temperature, std::mt19937_64& random) {
  if (is_better(proposed.similarity, current.similarity, options.c_lock)) return true;
  const bool comparable = proposed.similarity.undefined_terms() == current.similarity.undefined_terms();
  if (temperature <= 0.0 || !comparable) return false;
  const double worse_by = proposed.delta - current.delta;
  return std::uniform_real_distribution<double>()(random) < std::exp(-worse_by / temperature);
}

std::vector<SE2> make_start_poses(const Poses& poses, double cell, const StartPoseOptions& options) {
  std::vector<SE2> starts;
  for (int rotation = 0; rotation < options.rotations; ++rotation) {
    const double theta = 2.0 * std::numbers::pi * rotation / options.rotations;
    for (int row = -options.offsets; row <= options.offsets; ++row) {
      for (int column = -options.offsets; column <= options.offsets; ++column)
        starts.push_back(poses.at(column * options.offset * cell, row * options.offset * cell, theta));
    }
  }
  return starts;
}

}  // namespace

void validate(const StartPoseOptions& options) {
  if (options.rotations < 1) throw std::invalid_argument("the walk needs at least one start rotation");
  if (options.offsets < 0) throw std::invalid_argument("the number of start offsets must not be negative");
  if (!(options.offset >= 0.0 && std::isfinite(options.offset)))
    throw std::invalid_argument("the start offset must not be negative");
  constexpr double kMaxPoses = 1e6;
  if (options.rotations * std::pow(2.0 * options.offsets + 1.0, 2) > kMaxPoses)
    throw std::invalid_argument("the lattice of starts has more than a million poses");
}

void validate(const RandomWalkOptions& options) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (!(options.c_lock >= 0.0 && std::isfinite(options.c_lock)))
    throw std::invalid_argument("c_lock must be a number, and not negative");
  if (options.memory < StepProposals::kMinMemory)
    throw std::invalid_argument("the walk must remember at least four samples");
  if (!positive(options.smallest_step) || !positive(options.largest_step) ||
      !(options.first_step >= options.smallest_step && options.first_step <= options.largest_step))
    throw std::invalid_argument(
        "the walk's steps must be positive, and the first one between the smallest and the largest");
  if (!(options.wide_share >= 0.0 && options.wide_share <= 1.0))
    throw std::invalid_argument("the share of wide proposals must lie in [0, 1]");
  if (!(options.temperature >= 0.0 && std::isfinite(options.temperature)))
    throw std::invalid_argument("the temperature must not be negative");
  if (!(options.cooling > 0.0 && options.cooling <= 1.0))
    throw std::invalid_argument("cooling must lie in (0, 1]");
  if (options.patience < 1 || options.max_proposals < 1)
    throw std::invalid_argument("the walk must be allowed at least one proposal");
}

std::vector<MeasuredPose> measure_poses(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                        std::span<const SE2> poses) {
  const SimilarityMeter meter(fixed, moving);
  std::vector<MeasuredPose> measured(poses.size());
  constexpr std::size_t kPerTask = 9;  // poses for which one copy of the meter is made
  parallel_for((poses.size() + kPerTask - 1) / kPerTask, [&](std::size_t task) {
    SimilarityMeter own(meter);
    for (std::size_t i = task * kPerTask; i < std::min(poses.size(), (task + 1) * kPerTask); ++i)
      measured[i] = {poses[i], own.can_measure(poses[i]) ? own(poses[i]) : ImageSimilarity{}};
  });
  return measured;
}

std::vector<SE2> poses_between(const OccupancyGrid& moving, const SE2& from, const SE2& to, int count) {
  validate(moving);
  check_finite(from);
  check_finite(to);
  if (count < 2) throw std::invalid_argument("a cut has at least two poses");
  const Poses poses(moving, moving);
  const Step whole = poses.between(from, to);
  std::vector<SE2> cut;
  for (int i = 0; i + 1 < count; ++i) cut.push_back(poses.moved(from, whole * i / (count - 1)));
  cut.push_back(to);
  return cut;
}

std::vector<MeasuredPose> measure_start_poses(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                              const StartPoseOptions& options) {
  validate(options);
  validate(fixed);
  validate(moving);
  return measure_poses(fixed, moving, make_start_poses(Poses(fixed, moving), fixed.resolution, options));
}

namespace {

/// A walk under way.
class Walk {
 public:
  Walk(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& start,
       const RandomWalkOptions& options)
      : options_(options),
        meter_(fixed, moving),
        poses_(fixed, moving),
        proposals_(options),
        random_(options.seed),
        temperature_(options.temperature),
        current_(measure(start)),
        best_(current_) {
    record(current_, true, false);
  }

  RandomWalkResult run() {
    while (result_.proposals < options_.max_proposals &&
           result_.proposals - last_improvement_ < options_.patience) {
      throw_if_cancelled();
      step();
    }
    result_.T_fixed_moving = best_.T_fixed_moving;
    result_.similarity = best_.similarity;
    result_.delta = best_.delta;
    return std::move(result_);
  }

 private:
  Sample measure(const SE2& T) {
    const ImageSimilarity similarity = meter_(T);
    return {T, similarity, similarity.delta(options_.c_lock)};
  }

  void step() {
    const bool wide =
        options_.wide_share > 0.0 && std::uniform_real_distribution<double>()(random_) < options_.wide_share;
    const SE2 T =
        wide ? poses_.anywhere(random_) : poses_.moved(current_.T_fixed_moving, proposals_.draw(random_));
    ++result_.proposals;
    temperature_ *= options_.cooling;
    const double gap = poses_.gap(T);
    if ((gap > 0.0 && gap > poses_.gap(current_.T_fixed_moving)) || !meter_.can_measure(T)) {
      if (options_.trace == WalkTrace::all)
        result_.trace.push_back({result_.proposals, T, false, wide, false, 0.0, {}});
      if (!wide) refuse();
      return;
    }
    const Sample proposed = measure(T);
    if (select(proposed, current_, options_, temperature_, random_)) {
      if (wide) {
        proposals_.start_anew();
      } else {
        proposals_.learn(poses_.between(current_.T_fixed_moving, T));
      }
      go_to(proposed, wide);
      return;
    }
    record(proposed, false, wide);
    if (!wide) {
      refuse();
    } else if (!kept_ || is_better(proposed.similarity, kept_->similarity, options_.c_lock)) {
      kept_ = proposed;
    }
  }

  /// A learnt proposal was refused. At the end of a valley the walk goes to the wide sample that was kept.
  void refuse() {
    if (!proposals_.learn_refusal() || !kept_) return;
    const Sample kept = *std::exchange(kept_, std::nullopt);
    if (kept.similarity.undefined_terms() > current_.similarity.undefined_terms()) return;
    proposals_.start_anew();
    go_to(kept, true);
  }

  void go_to(const Sample& sample, bool wide) {
    current_ = sample;
    ++result_.accepted;
    record(sample, true, wide);
    if (!is_better(current_.similarity, best_.similarity, options_.c_lock)) return;
    best_ = current_;
    last_improvement_ = result_.proposals;
  }

  void record(const Sample& sample, bool accepted, bool wide) {
    if (options_.trace == WalkTrace::none || (options_.trace == WalkTrace::accepted && !accepted)) return;
    result_.trace.push_back(
        {result_.proposals, sample.T_fixed_moving, accepted, wide, true, sample.delta, sample.similarity});
  }

  const RandomWalkOptions& options_;
  SimilarityMeter meter_;
  const Poses poses_;
  StepProposals proposals_;
  std::mt19937_64 random_;
  double temperature_;
  RandomWalkResult result_;
  std::size_t last_improvement_ = 0;  // the proposal that made it
  Sample current_;
  Sample best_;
  std::optional<Sample> kept_;  // the best wide one that was refused since the walk last went to such a one
};

}  // namespace

RandomWalkResult random_walk(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& start,
                             const RandomWalkOptions& options) {
  validate(options);
  return Walk(fixed, moving, start, options).run();
}

}  // namespace gridmerge
