// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/grid/deformation.hpp"
#include "merge/elastic.hpp"
#include "merge/elastic_pairs.hpp"

namespace gridmerge::internal {

/// The cell in which the walls of all maps are drawn [m].
double common_cell(const std::vector<RigidMember>& maps);

/// Between neighbouring points of lattices that bend maps [m]: follows from the largest map.
double choose_spacing(const std::vector<RigidMember>& maps);

/// Known cells, evenly drawn [m, map frame]. O(cells).
std::vector<Point2> sample_known(const OccupancyGrid& map);

/// The pose that is nearest to where the sheet lies, by its map's known cells (Procrustes).
SE2 rigid_part(const ElasticSheet& sheet, const std::vector<Point2>& known);

/// What undoes the mean strain of all sheets, each as strong as it has known cells; `known[i]` are sampled
/// ones of map i, and T_group_map[i] is where it lay before it was bent.
Affine without_mean_strain(const std::vector<ElasticMember>& members,
                           const std::vector<std::vector<Point2>>& known,
                           const std::vector<SE2>& T_group_map);

}  // namespace gridmerge::internal
