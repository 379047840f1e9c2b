// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "gridmerge/grid/deformation.hpp"
#include "merge/elastic_sheet.hpp"

namespace gridmerge::internal {

/// The shifts of a sheet that a transform allows, as a linear space: orthonormal columns, each of x and y of
/// the first shift, of the next, ... (2 x shifts by 3 to 6). None for an elastic one, which allows all.
///
/// A rigid transform's shifts are those of an infinitesimal turn, so that a turn by t enlarges the sheet by
/// t^2 / 2. O(shifts).
std::optional<Eigen::MatrixXd> span_of(const ElasticSheet& sheet, MapTransform transform);

}  // namespace gridmerge::internal
