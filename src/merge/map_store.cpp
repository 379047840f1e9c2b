// SPDX-License-Identifier: Apache-2.0
#include "merge/map_store.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "match/prepared_map.hpp"

namespace gridmerge::internal {

MapStore::Input::Input(std::shared_ptr<const OccupancyGrid> map)
    : grid(std::move(map)), prepared(*grid), coverage(prepared.known()) {}

const std::string& MapStore::Input::content() const {
  const std::lock_guard lock(hashing_);
  if (content_.empty()) content_ = content_id(*grid);
  return content_;
}

MapStore::MapId MapStore::add(std::unique_ptr<const Input> input,
                              const std::optional<KnownPose>& known_pose) {
  if (known_pose) validate(*known_pose);
  const MapId id = next_++;
  inputs_.emplace(id, std::move(input));
  if (known_pose) known_poses_[id] = *known_pose;
  return id;
}

void MapStore::replace(MapId id, std::shared_ptr<const OccupancyGrid> map) {
  require(id);
  inputs_.at(id) = std::make_unique<const Input>(std::move(map));
}

void MapStore::set_known_pose(MapId id, const std::optional<KnownPose>& known_pose) {
  require(id);
  if (known_pose) validate(*known_pose);
  known_poses_.erase(id);
  if (known_pose) known_poses_[id] = *known_pose;
}

void MapStore::remove(MapId id) {
  require(id);
  inputs_.erase(id);
  known_poses_.erase(id);
}

void MapStore::require(MapId id) const {
  if (!inputs_.contains(id)) throw std::out_of_range("there is no map " + std::to_string(id));
}

std::optional<KnownPose> MapStore::known_pose(MapId id) const {
  const auto known = known_poses_.find(id);
  return known == known_poses_.end() ? std::nullopt : std::optional(known->second);
}

std::vector<MapStore::MapId> MapStore::ids() const {
  std::vector<MapId> ids;
  for (const auto& [id, input] : inputs_) ids.push_back(id);
  return ids;
}

std::vector<const OccupancyGrid*> MapStore::grids() const {
  std::vector<const OccupancyGrid*> grids;
  for (const auto& [id, input] : inputs_) grids.push_back(input->grid.get());
  return grids;
}

std::vector<std::optional<KnownPose>> MapStore::known_poses() const {
  std::vector<std::optional<KnownPose>> poses;
  for (const auto& [id, input] : inputs_) poses.push_back(known_pose(id));
  return poses;
}

std::vector<std::string> MapStore::contents_of(const std::vector<MapId>& maps) const {
  std::vector<std::string> contents(maps.size());
  parallel_for(maps.size(), [&](std::size_t i) { contents[i] = at(maps[i]).content(); });
  return contents;
}

std::vector<MapStore::MapId> MapStore::in_canonical_order() const {
  // Of equal maps those with a known pose come first, the surest one before all: the others are copies of it.
  const auto key = [&](MapId id) {
    const std::optional<KnownPose> known = known_pose(id);
    const KnownPose pose = known.value_or(KnownPose{});
    const SE2& T = pose.T_world_map;
    return std::tuple(!known, !pose.fixed, pose.sd_position, pose.sd_theta, T.x, T.y, T.theta);
  };
  std::vector<MapId> maps = ids();
  std::stable_sort(maps.begin(), maps.end(), [&](MapId a, MapId b) {
    if (is_smaller(at(a).prepared, at(b).prepared)) return true;
    return !known_poses_.empty() && !is_smaller(at(b).prepared, at(a).prepared) && key(a) < key(b);
  });
  return maps;
}

std::vector<Copy> MapStore::find_copies(const std::vector<MapId>& maps) const {
  const std::vector<std::size_t> index = places_of(maps);
  std::vector<Copy> copies;
  std::vector<std::size_t> originals;  // with the same cells: several where these look the same when turned
  const auto given = [&](std::size_t i) {
    const Input& input = at(maps[i]);
    return GivenMap{*input.grid, input.prepared};
  };
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (!originals.empty() && !is_copy(given(originals.front()).prepared, given(i).prepared))
      originals.clear();
    const auto original = std::find_if(originals.begin(), originals.end(), [&](std::size_t other) {
      return is_given_twice(given(other), given(i));
    });
    if (original == originals.end()) {
      originals.push_back(i);
    } else if (!known_poses_.contains(maps[i])) {
      copies.push_back(
          {index[i], index[*original], between_copies(given(*original).prepared, given(i).prepared)});
    }
  }
  return copies;
}

std::vector<MapStore::MapId> MapStore::those_that_count(std::vector<MapId> maps,
                                                        const std::vector<Copy>& copies) const {
  const std::vector<MapId> order = ids();
  std::erase_if(maps, [&](MapId id) {
    return std::any_of(copies.begin(), copies.end(), [&](const Copy& copy) { return order[copy.map] == id; });
  });
  return maps;
}

std::vector<std::size_t> MapStore::places_of(const std::vector<MapId>& maps) const {
  const std::vector<MapId> order = ids();
  std::vector<std::size_t> places;
  places.reserve(maps.size());
  for (const MapId id : maps)
    places.push_back(
        static_cast<std::size_t>(std::lower_bound(order.begin(), order.end(), id) - order.begin()));
  return places;
}

std::vector<MergeInput> MapStore::inputs_of(const std::vector<MapId>& maps) const {
  const std::vector<std::size_t> index = places_of(maps);
  std::vector<MergeInput> inputs;
  inputs.reserve(maps.size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const Input& input = at(maps[i]);
    inputs.push_back({index[i], input.grid.get(), &input.prepared, known_pose(maps[i])});
  }
  return inputs;
}

}  // namespace gridmerge::internal
