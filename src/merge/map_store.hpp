// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge.hpp"
#include "merge/component.hpp"
#include "merge/copies.hpp"
#include "merge/coverage.hpp"

namespace gridmerge::internal {

/// The maps of a merge and what is known of their poses. Maps go by a number that is not given again.
class MapStore {
 public:
  using MapId = std::size_t;

  /// A map with all that does not depend on the others.
  struct Input {
    /// Throws std::invalid_argument for an invalid map.
    explicit Input(std::shared_ptr<const OccupancyGrid> map);

    /// content_id() of the grid, which is hashed once, when it is asked for first.
    const std::string& content() const;

    std::shared_ptr<const OccupancyGrid> grid;
    PreparedMap prepared;
    Coverage coverage;

   private:
    mutable std::mutex hashing_;
    mutable std::string content_;
  };

  /// Throws std::invalid_argument for an invalid pose, and is then as before.
  MapId add(std::unique_ptr<const Input> input, const std::optional<KnownPose>& known_pose);

  /// Throw std::out_of_range for an unknown id, and for an invalid map or pose as above.
  void replace(MapId id, std::shared_ptr<const OccupancyGrid> map);
  void set_known_pose(MapId id, const std::optional<KnownPose>& known_pose);
  void remove(MapId id);
  void require(MapId id) const;

  const Input& at(MapId id) const { return *inputs_.at(id); }
  std::optional<KnownPose> known_pose(MapId id) const;

  /// In the order in which they were added.
  std::vector<MapId> ids() const;
  std::vector<const OccupancyGrid*> grids() const;            ///< likewise
  std::vector<std::optional<KnownPose>> known_poses() const;  ///< likewise

  /// The contents of these maps. Runs in the calling TBB arena.
  std::vector<std::string> contents_of(const std::vector<MapId>& maps) const;

  /// An order that depends on the maps alone, so that sums are made in the same order whatever order they
  /// came in.
  std::vector<MapId> in_canonical_order() const;

  /// The first of several equal maps is the one that counts. What is known of a pose tells maps apart.
  /// `maps` are all, in canonical order: there equal ones follow each other.
  std::vector<Copy> find_copies(const std::vector<MapId>& maps) const;

  /// The maps that are no copies.
  std::vector<MapId> those_that_count(std::vector<MapId> maps, const std::vector<Copy>& copies) const;

  /// Where each of these maps stands among all in the order in which they were added.
  std::vector<std::size_t> places_of(const std::vector<MapId>& maps) const;

  std::vector<MergeInput> inputs_of(const std::vector<MapId>& maps) const;

 private:
  MapId next_ = 0;
  std::map<MapId, std::unique_ptr<const Input>> inputs_;
  std::map<MapId, KnownPose> known_poses_;
};

}  // namespace gridmerge::internal
