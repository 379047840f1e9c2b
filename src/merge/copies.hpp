// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// A map that holds the same cells as another input: given twice, it counts once.
struct Copy {
  std::size_t map = 0;       ///< index of the input
  std::size_t original = 0;  ///< index of the one that counts
  SE2 T_original_map;        ///< from the copy's frame to the original's
};

/// Whether two maps hold the same cells, walls among them. O(cells) if they do, mostly O(1) if not.
GRIDMERGE_INTERNAL_EXPORT bool is_copy(const PreparedMap& a, const PreparedMap& b);

/// A map as it was given, and prepared.
struct GivenMap {
  const OccupancyGrid& grid;
  const PreparedMap& prepared;
};

/// Whether two maps are one that was given twice: copies of which the cells say how they lie to each other.
/// Those of one picture do. Those of a picture and of the same one turned by quarters do unless the picture
/// looks the same from two sides: it lies on its turned copy in several ways then, none better than another.
/// O(cells) for copies, mostly O(1) for others.
GRIDMERGE_INTERNAL_EXPORT bool is_given_twice(const GivenMap& a, const GivenMap& b);

/// From b's frame to a's, where the two hold the same cells.
SE2 between_copies(const PreparedMap& a, const PreparedMap& b);

/// A map where it lies in the output.
struct PlacedInput {
  const PreparedMap* map = nullptr;
  SE2 T_output_map;
};

/// The places of the maps that count where merge() fuses: of copies that lie on each other, to a thousandth
/// of a cell, the first. O(maps^2) where they differ.
GRIDMERGE_INTERNAL_EXPORT std::vector<std::size_t> without_copies(const std::vector<PlacedInput>& maps);

/// Makes the ways that lead out of the component begin at its first map, and leaves out those within it.
void tell_ways_anew(const Component& component, std::vector<OpenWay>& ways);

/// Gives every copy its place beside its original: in the original's component, or in one of the two, and in
/// a join with every other map that the original has one with. The first map of a component holds its frame
/// then as before. `grids` and `known_poses` are those of all
/// inputs; `resolution` is that of fused maps, 0 for the finest.
void add_copies(const std::vector<Copy>& copies, const std::vector<const OccupancyGrid*>& grids,
                const std::vector<std::optional<KnownPose>>& known_poses, double resolution,
                MergeResult& result);

}  // namespace gridmerge::internal
