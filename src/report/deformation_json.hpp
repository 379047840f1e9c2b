// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/deformation.hpp"
#include "report/json_reader.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// What it does to a map, without the lattice: `kind`, and `scale` of one that does not bend. O(shifts).
Json shape_json(const Deformation& deformation);

/// The lattice of a map that is bent or stretched, as docs/merging.md describes it: its kind, of one that is
/// not elastic the scale and the matrix that it stands for, and the lattice itself.
Json deformation_json(const Deformation& deformation);

/// The same, read; lengths within `farthest` [m]. Its kind, scale and matrix, which earlier versions did not
/// write, must be those of the lattice. Throws JsonError.
Deformation read_deformation(const JsonReader& json, double farthest);

}  // namespace gridmerge::internal
