// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge::paper {

/// A floor plan as the paper describes its own: an entrance hall, from which three corridors lead to rooms;
/// about 1,800 m^2. The hall and the corridors are always the same, so that ways fit every draw; rooms, doors
/// and the boxes that stand in the hall follow the seed.
Building make_entrance(std::uint64_t seed);

/// The hall [m]. Corridors leave it in the west, in the east and in the north.
inline constexpr double kHallLeft = 36.0, kHallRight = 60.0, kHallBottom = 30.0, kHallTop = 46.0;

}  // namespace gridmerge::paper
