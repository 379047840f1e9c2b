// SPDX-License-Identifier: Apache-2.0
// What the ways to merge have in common.
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"
#include "merge/consistent_set.hpp"

namespace gridmerge::internal {

/// Throws std::invalid_argument unless merged maps may have this resolution [m/cell], or it is 0: the finest
/// map's.
GRIDMERGE_INTERNAL_EXPORT void validate_merged_resolution(double resolution);

/// Throws std::invalid_argument for an invalid map, naming it by its index, or an invalid resolution of the
/// merged maps.
void validate_merge(const std::vector<OccupancyGrid>& maps, double resolution);

/// The resolution of the finest of these maps, of which there must be one.
GRIDMERGE_INTERNAL_EXPORT double finest_resolution(const std::vector<PlacedMap>& maps);

/// The resolution in which these maps are fused to be compared with another one: `resolution`, or so much
/// coarser, by a power of two, that the result has at most kMaxGridCells, and, above 2^22 cells, at most 64
/// per known cell of the maps: a very fine map and a coarse one would else be compared for minutes. It is
/// kMaxResolution at most: of maps too far apart for it fuse() says so.
/// `deformations` as of fuse(). O(maps) where they fit by far, else O(cells).
double fitting_resolution(double resolution, const std::vector<PlacedMap>& maps,
                          const std::vector<Deformation>& deformations = {});

/// The resolution of a merged map of these: the one that is asked for, or, if that is 0, the finest of theirs
/// or so much coarser that the merged map fits, up to 16 times and to kMaxResolution. O(maps), O(cells) where
/// it may not fit or a map is bent.
GRIDMERGE_INTERNAL_EXPORT double merged_resolution(double asked_for, const std::vector<PlacedMap>& maps,
                                                   const std::vector<Deformation>& deformations = {});

/// Maps where they lie, and how each is bent, as fuse() takes them.
struct PlacedMembers {
  std::vector<PlacedMap> maps;
  std::vector<Deformation> deformations;
};

/// The members at these places. `grids[i]` is input map i.
GRIDMERGE_INTERNAL_EXPORT PlacedMembers placed_members(const std::vector<Member>& members,
                                                       const std::vector<std::size_t>& places,
                                                       const std::vector<const OccupancyGrid*>& grids);

/// The members at these places, fused where they lie and bent as they say. `grids[i]` is input map i.
GRIDMERGE_INTERNAL_EXPORT FusedMap fuse_members(const std::vector<Member>& members,
                                                const std::vector<std::size_t>& places,
                                                const std::vector<const OccupancyGrid*>& grids,
                                                double resolution);

/// Whether a member of any component is bent or stretched. O(members).
GRIDMERGE_INTERNAL_EXPORT bool is_any_bent(const MergeResult& result);

/// A join that means what its own verdict says.
Join make_join(std::size_t fixed, std::size_t moving, MatchResult match);

/// What other maps have to do with a pair.
struct Company {
  const CandidateJoin* used = nullptr;  ///< the candidate that the consistent set agrees with, if any
  bool is_placed = false;               ///< at least one of the two maps lies together with others
  bool is_over_budget = false;          ///< a larger budget of false joins would have used a candidate
};

/// The same when other maps had a say.
Join make_join(std::size_t fixed, std::size_t moving, MatchResult match, const Company& company);

/// The same with the other map as the fixed one.
Join inverted(Join join);

/// The open joins of a consistent set, between the first input map of each group. `index` is that of each map
/// of the problem among the inputs. Runs in the calling TBB arena; time as find_open_joins().
std::vector<OpenWay> make_open_ways(const std::vector<std::size_t>& index, const JoinProblem& problem,
                                    const ConsistentSet& consistent_set);

/// The comparison of a map that is most probable by what the two maps say by themselves; null if there is
/// none.
GRIDMERGE_INTERNAL_EXPORT const Join* likeliest_join(std::size_t map, const std::vector<Join>& joins);

/// A map that joined nothing: because the budget of false joins has no room for a join of it, or for the
/// reason of its likeliest one.
LeftOut left_out(std::size_t map, const std::vector<Join>& joins);

}  // namespace gridmerge::internal
