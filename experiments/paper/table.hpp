// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "maps.hpp"

namespace gridmerge::paper {

/// The first draws, of maps of `side` x `side` cells.
std::vector<Draw> make_draws(int side, int draws);

/// All rows of the paper's table I, each over these draws of the maps: walks beside the engine. In Markdown.
std::string table_one(std::span<const Draw> draws);

/// Delta and omega at the truth of the hard pair (m3, m4) and at the best pose that walks with c_lock 7.5
/// find, one row a draw.
std::string hard_pair_measures(std::span<const Draw> draws);

/// What the pairs of these draws share at the truth, by class of cell.
std::string shared_cells(std::span<const Draw> draws);

/// m1 and m2 of draws of larger maps.
std::string larger_maps(std::span<const Draw> draws);

}  // namespace gridmerge::paper
