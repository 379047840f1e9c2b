// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/match/match.hpp"
#include "merge/elastic_pairs.hpp"

namespace gridmerge::internal {

/// A map of a component, where the rigid step has put it.
struct RigidMember {
  const PreparedMap* map = nullptr;
  SE2 T_group_map;
  bool held = false;  ///< its pose is fixed: it is neither moved nor bent
};

/// The same map after it was bent.
struct BentMember {
  SE2 T_group_map;
  Deformation deformation;
};

/// Bends the maps of a component so that walls that are one come to lie on each other.
///
/// Each map is a sheet (ElasticSheet). Walls of two maps that lie near each other and face alike are tied,
/// and all sheets are relaxed together; this is repeated while the reach of ties shrinks (as iterated closest
/// points, after Amberg, Romdhani and Vetter 2007). `sd` says how far off the rigid poses leave walls [m]:
/// the reaches are multiples of it, and the larger it is, the softer are the maps, so that maps that fit
/// already stay straight. The spacing of the lattices follows from the size of the maps.
///
/// What all maps have in common is not bent: shifts are compared at one place, so that no tie gains by it,
/// and the energy keeps it least. With no held map the mean strain over all maps' known cells is zero. Each
/// map's rigid part goes to its pose. A map that is tied to none keeps its pose and has no lattice.
///
/// Depends on the maps' order only as sums do. O(maps^2) to choose pairs, then O(maps).
std::vector<BentMember> bend(const std::vector<RigidMember>& maps, double sd);

}  // namespace gridmerge::internal
