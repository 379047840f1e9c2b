// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/grid/deformation.hpp"
#include "merge/elastic.hpp"

namespace gridmerge::internal {

/// No map is enlarged by more than this factor along any direction, nor made smaller by more than its
/// inverse.
constexpr double kMostStretch = 1.1;

/// Gives each map of a component a scale of its own (`similarity`), or scales along two axes and shear
/// (`affine`), so that walls that are one come to lie on each other.
///
/// As bend(), with sheets that cannot bend: each has a lattice of 4 x 4 shifts that is an affine function on
/// the whole map and half a map around it. Maps that ties connect form a part. A part stays as it is unless
/// walls that were held out of the fit come nearer to each other than the best poses alone bring them
/// (find_parts_that_gain()), and if any of its maps would be stretched by more than kMostStretch.
///
/// Of a scale that all maps of a part share, their walls say nothing: with no held map in it the mean over
/// its maps of the logarithm of the stretch (a symmetric matrix, in the group's frame) is zero, and so is the
/// mean of the logarithms of their scales. Held maps stay as they are, and the others of their part follow
/// them.
///
/// `sd` as of bend(). Throws std::invalid_argument for another transform. O(maps^2) to choose pairs, then
/// O(maps). The same bits for any number of threads.
std::vector<BentMember> stretch(const std::vector<RigidMember>& maps, double sd, MapTransform transform);

}  // namespace gridmerge::internal
