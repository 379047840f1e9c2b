// SPDX-License-Identifier: Apache-2.0
#include "prior.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace gridmerge {

namespace {

/// What it is worth to lie where it is known to: as much as the most that two maps say by themselves.
constexpr double kKnownNats = 6.0;
constexpr double kFixedNats = 50.0;
constexpr double kExact = 1e-3;      // [m]
constexpr double kDeviations = 3.0;  // a true pose lies within so many of what is known

}  // namespace

void validate_known_pose(const KnownPose& known) {
  const SE2& T = known.T_world_map;
  if (!std::isfinite(T.x) || !std::isfinite(T.y) || !std::isfinite(T.theta))
    throw std::invalid_argument("a known pose must be finite");
  if (known.fixed) return;
  if (!(std::isfinite(known.sd_position) && known.sd_position > 0.0 && std::isfinite(known.sd_theta) &&
        known.sd_theta > 0.0))
    throw std::invalid_argument(
        "the standard deviations of a known pose must be positive, unless it is fixed");
}

double sd_of(const KnownPose& known, const MapExtent& extent) {
  return known.fixed ? 0.0 : std::hypot(known.sd_position, known.sd_theta * extent.radius);
}

void apply_known_poses(const KnownPose& fixed, const KnownPose& moving, const MapExtent& fixed_extent,
                       const MapExtent& moving_extent, PairCandidates& pair) {
  const SE2 T_fixed_moving = inverse(fixed.T_world_map) * moving.T_world_map;
  if (fixed.fixed && moving.fixed) {
    pair.candidates = {{T_fixed_moving, kFixedNats, kExact}};
    return;
  }
  const double sd = std::hypot(sd_of(fixed, fixed_extent), sd_of(moving, moving_extent));
  const double near = agreement_tolerance(fixed_extent, moving_extent) + kDeviations * sd;
  bool is_found = false;
  for (CandidateJoin& candidate : pair.candidates) {
    const bool is_near =
        difference(fixed_extent, moving_extent, candidate.T_fixed_moving, T_fixed_moving) <= near;
    candidate.log_odds += is_near ? kKnownNats : -kKnownNats;
    is_found = is_found || is_near;
  }
  if (!is_found) pair.candidates.push_back({T_fixed_moving, kKnownNats, std::max(sd, kExact)});
}

}  // namespace gridmerge
