// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace gridmerge::paper {

/// All rows of the paper's table I, each over `draws` draws of the maps: walks beside the engine. In
/// Markdown.
std::string table_one(int draws);

/// Delta and omega at the truth of the hard pair (m3, m4) and at the best pose that walks with c_lock 7.5
/// find, one row a draw.
std::string hard_pair_measures(int draws);

/// What the pairs of the first draws share at the truth, by class of cell.
std::string shared_cells(int draws);

/// m1 and m2 of `draws` draws at 1000 x 1000 cells.
std::string larger_maps(int draws);

}  // namespace gridmerge::paper
