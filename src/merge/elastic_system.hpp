// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "merge/elastic_pairs.hpp"

namespace gridmerge::internal {

/// The shifts of all sheets for which the weighted squares of the gaps between tied walls, as a change of the
/// shifts closes them, and the sheets' energies are least together; those of held maps stay, and those of
/// others change as their freedom has it. `energies[i]` is that of map i, positive definite. By conjugate
/// gradients, with what each map's ties and energy say alone for a preconditioner: exact enough for a step of
/// several, since neighbouring shifts are solved for at once. The same bits for any number of threads. O(ties
/// + shifts^3 of a map).
std::vector<std::vector<Point2>> solve_shifts(const std::vector<ElasticMember>& members,
                                              const std::vector<TiedPair>& pairs,
                                              const std::vector<Eigen::SparseMatrix<double>>& energies);

}  // namespace gridmerge::internal
