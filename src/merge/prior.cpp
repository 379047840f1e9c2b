// SPDX-License-Identifier: Apache-2.0
#include "merge/prior.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "grid/logistic.hpp"
#include "merge/join_weights.hpp"

namespace gridmerge::internal {

namespace {

/// What it is worth to lie where it is known to, if that is known as well as a match tells a pose: as much as
/// the most that two maps say by themselves.
constexpr double kKnownNats = 6.0;

/// The odds of each candidate after those at known places have become likelier by `nats`, and the others less
/// likely by `elsewhere`: with "none of these", which it leaves as it was, their probabilities are one whole.
/// So the most probable candidate at a known place is never doubted more than before.
void weigh_again(std::vector<CandidateJoin>& candidates, const std::vector<bool>& is_near, double nats,
                 double elsewhere) {
  constexpr double kMinDoubt = 1e-9;
  std::vector<double> weights;
  double none = 1.0, sum = 0.0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double probability = logistic(candidates[i].log_odds);
    none -= probability;
    weights.push_back(probability * std::exp(is_near[i] ? nats : -elsewhere));
    sum += weights.back();
  }
  sum += std::max(none, 0.0);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    // Not as a difference of nearly equal numbers.
    double others = std::max(none, 0.0);
    for (std::size_t j = 0; j < candidates.size(); ++j) others += j == i ? 0.0 : weights[j];
    candidates[i].log_odds =
        std::log(std::max(weights[i], kMinDoubt * sum) / std::max(others, kMinDoubt * sum));
  }
}

}  // namespace

double sd_between(const KnownPose& fixed, const KnownPose& moving, const MapExtent& fixed_extent,
                  const MapExtent& moving_extent) {
  const Point2 there = moving.T_world_map * moving_extent.centre;
  const Point2 here = fixed.T_world_map * fixed_extent.centre;
  const double apart = std::hypot(there.x - here.x, there.y - here.y);
  const double radius = std::min(fixed_extent.radius, moving_extent.radius);
  double squares = 0.0;
  for (const KnownPose* known : {&fixed, &moving}) {
    if (known->fixed) continue;
    // An error of one map's direction turns the other one about it.
    squares += std::pow(known->sd_position, 2) +
               std::pow(known->sd_theta, 2) * (radius * radius + 0.25 * apart * apart);
  }
  return std::sqrt(squares);
}

void apply_known_poses(const KnownPose& fixed, const KnownPose& moving, const ProblemMap& fixed_map,
                       const ProblemMap& moving_map, PairCandidates& pair) {
  const MapExtent &fixed_extent = fixed_map.extent, &moving_extent = moving_map.extent;
  const SE2 T_fixed_moving = inverse(fixed.T_world_map) * moving.T_world_map;
  const double sd = sd_between(fixed, moving, fixed_extent, moving_extent);
  const double tolerance = agreement_tolerance(fixed_extent, moving_extent);
  const double near = tolerance + kDeviationsOfKnown * sd;
  std::vector<bool> is_near;
  for (const CandidateJoin& candidate : pair.candidates)
    is_near.push_back(difference(fixed_extent, moving_extent, candidate.T_fixed_moving, T_fixed_moving) <=
                      near);
  // In x, y and theta each, what is known singles out so much less than a match does.
  double nats = std::clamp(kKnownNats - 3.0 * std::log(sd / tolerance), 0.0, kKnownNats);
  // Where maps have much in common they propose the true pose: what they do not propose is doubted.
  const bool is_proposed = std::find(is_near.begin(), is_near.end(), true) != is_near.end();
  if (!is_proposed && fixed_map.coverage != nullptr && moving_map.coverage != nullptr)
    nats = std::max(0.0, nats - nats_of_a_miss(fixed_map.coverage->share_in_common(
                                    *moving_map.coverage, ManyPointsTransform(T_fixed_moving))));
  // As long as it is vague, "none of these" is true of many poses that are near the known one. If it is not,
  // it is a candidate itself: the others are its rivals, as likely against nothing as before.
  const bool is_vague = sd > tolerance;
  weigh_again(pair.candidates, is_near, nats, is_vague ? nats : 0.0);
  if (is_vague) return;
  // What the maps themselves propose there is the same way to lie, not a rival of it.
  CandidateJoin* there = nullptr;
  for (CandidateJoin& candidate : pair.candidates) {
    const bool is_there =
        difference(fixed_extent, moving_extent, candidate.T_fixed_moving, T_fixed_moving) <= tolerance;
    if (is_there && (there == nullptr || candidate.log_odds > there->log_odds)) there = &candidate;
  }
  if (there == nullptr)
    pair.candidates.push_back({T_fixed_moving, nats, sd, true});
  else
    there->log_odds = std::max(there->log_odds, nats);
}

}  // namespace gridmerge::internal
