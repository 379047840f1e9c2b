// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fuzzer/FuzzedDataProvider.h>

#include <span>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"

namespace gridmerge::fuzz {

/// Maps of 1 to 40 cells per side, drawn as the bytes say: each shows a part of one place, at a pose of its
/// own, with strokes of its own over it. So many have walls in common, as maps of two robots have.
std::vector<OccupancyGrid> draw_maps(FuzzedDataProvider& bytes, std::size_t count);

/// Requires what match() and its kin promise of an answer about two maps: numbers that are finite,
/// probabilities in [0, 1], hypotheses by falling probability, a verdict that follows from them, and no pose
/// outside the search space, which is where the circles around the maps' known cells touch.
void require_sound(const MatchResult& result, const OccupancyGrid& fixed, const OccupancyGrid& moving,
                   double accept_probability);

/// Whether two answers are equal to the bit, apart from the time that they took.
bool are_same(const MatchResult& a, const MatchResult& b);

}  // namespace gridmerge::fuzz
