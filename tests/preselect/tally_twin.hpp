// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "preselect/signature.hpp"
#include "preselect/tally.hpp"

namespace gridmerge::test {

/// What each sampled wall stands for.
inline double metres_of_one(const internal::Signature& map) {
  return map.wall_length / static_cast<double>(map.walls.size());
}

/// Adds half of what the walls of `on` say where `at` has seen: the definitions of Tally, wall by wall.
inline void add_half_tally(const internal::Signature& at, const internal::Signature& on,
                           const internal::GridPose& T_at_on, std::size_t step, internal::Tally& sum) {
  using namespace internal;
  const double half = 0.5 * metres_of_one(on) * static_cast<double>(step);
  for (std::size_t i = 0; i < on.walls.size(); i += step) {
    const SampledWall& wall = on.walls[i];
    const Place place = at.place_at(T_at_on * wall.position);
    if (place.distance == kUnseen) continue;
    sum.seen += half;
    sum.chance += half * at.chance_of_meeting;
    if (place.distance >= at.open_from) sum.open += half;
    if (place.distance > at.met_within) continue;
    const std::uint8_t facing = turned(wall.facing, steps_of_turn(T_at_on.theta));
    // Nine of the 32 parts of a turn are the same side.
    const bool is_alike =
        place.facing == kNoDirection || facing == kNoDirection || 2 * steps_between(place.facing, facing) < 9;
    if (is_alike) sum.met += half;
  }
}

/// The twin of tally_both().
inline internal::Tally tally_twin(const internal::Signature& fixed, const internal::Signature& moving,
                                  const internal::GridPose& T_fixed_moving, std::size_t step) {
  internal::Tally sum;
  add_half_tally(fixed, moving, T_fixed_moving, step, sum);
  add_half_tally(moving, fixed, T_fixed_moving.inverted(), step, sum);
  return sum;
}

}  // namespace gridmerge::test
