// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "merge/elastic_fit.hpp"

namespace gridmerge::internal {

/// Which maps gain by being bent.
///
/// By cross-validation: the floor is parted into squares, as a chessboard is. The maps are fitted by the
/// walls on the squares of one colour, and judged by how near walls lie to each other on the squares of the
/// other; then the other way round. No map gains unless the walls that were held out, of all pairs together,
/// fit better: surely, by two standard errors over the squares, and by more than what a gap of half a cell is
/// worth. Then each map gains whose own walls that were held out fit better.
/// `options.fold` is not used. Costs two fits to half of the walls.
std::vector<bool> find_gains(const ElasticFit& options, const std::vector<ElasticMember>& members);

/// Which parts gain by the freedom of their maps; `part_of[i]` is that of map i, and no pair joins two parts.
///
/// By the same cross-validation with squares of twice `spacing` metres, part by part: the fit of each half is
/// compared with that of maps that are turned and shifted alone, to the same walls. A gap of a quarter of a
/// cell is worth something here: so few freedoms gain little by chance. By part; false where
/// it has no pair. Costs four fits to half of the walls.
std::vector<bool> find_parts_that_gain(const ElasticFit& options, double spacing,
                                       const std::vector<ElasticMember>& members,
                                       const std::vector<std::size_t>& part_of);

}  // namespace gridmerge::internal
