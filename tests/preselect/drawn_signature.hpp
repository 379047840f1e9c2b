// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "gridmerge/grid/resample.hpp"
#include "preselect/signature.hpp"
#include "preselect/tally.hpp"

namespace gridmerge::test {

/// What a robot sees of a floor of 16 m x 11 m with six unequal rooms, up to so many cells from its left.
inline OccupancyGrid rooms_from(int first_column) {
  OccupancyGrid map = make_grid(340 - first_column, 240, 0.05);
  const auto is_line = [](int at, std::initializer_list<int> lines) {
    return std::any_of(lines.begin(), lines.end(), [&](int line) { return at >= line && at < line + 3; });
  };
  for (int row = 10; row < 231; ++row) {
    for (int column = std::max(10, first_column); column < 331; ++column) {
      const bool is_wall = is_line(column, {10, 76, 190, 328}) || is_line(row, {10, 133, 228});
      map.at(column - first_column, row) = is_wall ? Cell::occupied : Cell::free;
    }
  }
  return map;
}

/// As of a prepared map: cropped to its known cells.
inline internal::Signature signature_of(const OccupancyGrid& map) {
  return internal::make_signature(crop_to_known(map));
}

/// What each sampled wall stands for.
inline double metres_of_one(const internal::Signature& map) {
  return map.wall_length / static_cast<double>(map.walls.size());
}

/// The definitions of Tally, wall by wall: half of what the walls of `on` say where `at` has seen.
inline void walk(const internal::Signature& at, const internal::Signature& on,
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
inline internal::Tally walk_over_both(const internal::Signature& fixed, const internal::Signature& moving,
                                      const internal::GridPose& T_fixed_moving, std::size_t step) {
  internal::Tally sum;
  walk(fixed, moving, T_fixed_moving, step, sum);
  walk(moving, fixed, T_fixed_moving.inverted(), step, sum);
  return sum;
}

}  // namespace gridmerge::test
