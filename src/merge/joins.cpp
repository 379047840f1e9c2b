// SPDX-License-Identifier: Apache-2.0
#include "merge/joins.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "merge/log_odds.hpp"

namespace gridmerge::internal {

void validate_merged_resolution(double resolution) {
  if (resolution != 0.0 && !is_resolution(resolution))
    throw std::invalid_argument(
        "the output resolution must be between 1e-6 and 1000 metres per cell, or 0 for the finest map's");
}

void validate_merge(const std::vector<OccupancyGrid>& maps, double resolution) {
  validate_merged_resolution(resolution);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    try {
      validate(maps[i]);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("map " + std::to_string(i) + ": " + error.what());
    }
  }
}

namespace {

/// What all cells of the maps cover, known or not, in the output frame [m].
Box box_of_grids(const std::vector<PlacedMap>& maps) {
  Box box;
  for (const PlacedMap& one : maps) {
    const ManyPointsTransform T_output_grid(one.T_output_map * one.map->origin);
    const double width = one.map->width * one.map->resolution;
    const double height = one.map->height * one.map->resolution;
    for (const double x : {0.0, width}) {
      for (const double y : {0.0, height}) box.add(T_output_grid * Point2{x, y});
    }
  }
  return box;
}

bool fits(const Box& box, double resolution, double most_cells) {
  // A cell more on either side than the box is long, whatever the lattice continues.
  return box.empty() ||
         ((box.max_x - box.min_x) / resolution + 2.0) * ((box.max_y - box.min_y) / resolution + 2.0) <=
             most_cells;
}

/// Whether the maps cover at most so many cells, as far as their grids tell. O(maps).
bool surely_fit(double resolution, double most_cells, const std::vector<PlacedMap>& maps,
                const std::vector<Deformation>& deformations) {
  return !is_any_bent(deformations) && fits(box_of_grids(maps), resolution, most_cells);
}

/// `resolution`, or coarser by the power of two with which the maps cover at most so many cells.
double coarsened_to_fit(double resolution, double most_cells, const std::vector<PlacedMap>& maps,
                        const std::vector<Deformation>& deformations) {
  if (surely_fit(resolution, most_cells, maps, deformations)) return resolution;
  const Box box = covered_box(maps, deformations);
  while (!fits(box, resolution, most_cells)) resolution *= 2.0;
  return std::min(kMaxResolution, resolution);
}

}  // namespace

double finest_resolution(const std::vector<PlacedMap>& maps) {
  return std::min_element(
             maps.begin(), maps.end(),
             [](const PlacedMap& a, const PlacedMap& b) { return a.map->resolution < b.map->resolution; })
      ->map->resolution;
}

double fitting_resolution(double resolution, const std::vector<PlacedMap>& maps,
                          const std::vector<Deformation>& deformations) {
  // What is compared takes time by its cells, so there are few, or a share of them is known: of 16 maps that
  // touch at their corners in a row across the box, each known to a quarter, one cell of 64 is.
  constexpr double kFewCells = 1 << 22, kCellsPerKnownCell = 64.0;
  if (surely_fit(resolution, kFewCells, maps, deformations)) return resolution;
  double known = 0.0;
  for (const PlacedMap& one : maps) known += static_cast<double>(count_cells(*one.map).known());
  const double most_cells = std::min<double>(kMaxGridCells, std::max(kFewCells, kCellsPerKnownCell * known));
  return coarsened_to_fit(resolution, most_cells, maps, deformations);
}

double merged_resolution(double asked_for, const std::vector<PlacedMap>& maps,
                         const std::vector<Deformation>& deformations) {
  // Coarser still, maps would be a few cells: poses so far apart are a mistake, and fuse() refuses them.
  constexpr double kMostCoarser = 16.0;
  if (asked_for > 0.0) return asked_for;
  const double finest = finest_resolution(maps);
  return std::min(kMostCoarser * finest, coarsened_to_fit(finest, kMaxGridCells, maps, deformations));
}

PlacedMembers placed_members(const std::vector<Member>& members, const std::vector<std::size_t>& places,
                             const std::vector<const OccupancyGrid*>& grids) {
  PlacedMembers placed;
  for (const std::size_t place : places) {
    const Member& member = members[place];
    placed.maps.push_back({grids[member.map], member.T_component_map});
    placed.deformations.push_back(member.deformation);
  }
  return placed;
}

FusedMap fuse_members(const std::vector<Member>& members, const std::vector<std::size_t>& places,
                      const std::vector<const OccupancyGrid*>& grids, double resolution) {
  const auto [maps, deformations] = placed_members(members, places, grids);
  return fuse(maps, merged_resolution(resolution, maps, deformations), deformations);
}

bool is_any_bent(const MergeResult& result) {
  return std::any_of(result.components.begin(), result.components.end(), [](const Component& component) {
    return std::any_of(component.members.begin(), component.members.end(),
                       [](const Member& member) { return !member.deformation.is_identity(); });
  });
}

Join make_join(std::size_t fixed, std::size_t moving, MatchResult match) {
  Join join;
  join.fixed = fixed;
  join.moving = moving;
  join.match = std::move(match);
  join.outcome = join.match.verdict == Verdict::accepted ? JoinOutcome::accepted : JoinOutcome::refused;
  static_cast<PairPose&>(join) = join.match;
  return join;
}

Join make_join(std::size_t fixed, std::size_t moving, MatchResult match, const Company& company) {
  Join join = make_join(fixed, moving, std::move(match));
  const bool is_believed = join.outcome == JoinOutcome::accepted;
  if (company.used == nullptr) {
    join.over_budget = company.is_over_budget;
    join.outcome =
        is_believed && company.is_placed && !join.over_budget ? JoinOutcome::rejected : JoinOutcome::refused;
    return join;
  }
  const SE2& T = company.used->T_fixed_moving;
  join.T_fixed_moving = T;
  if (company.used->is_known) {
    join.outcome = JoinOutcome::known;
    join.probability = 0.0;  // the maps themselves say nothing of it
    return join;
  }
  join.outcome = is_believed && T == join.match.T_fixed_moving ? JoinOutcome::accepted : JoinOutcome::rescued;
  join.probability = 0.0;  // if it is a group that says it, rather than these two maps
  for (const Hypothesis& hypothesis : join.match.hypotheses) {
    if (hypothesis.T_fixed_moving == T) join.probability = hypothesis.probability;
  }
  return join;
}

Join inverted(Join join) {
  std::swap(join.fixed, join.moving);
  join.match = inverse(std::move(join.match));
  join.T_fixed_moving = inverse(join.T_fixed_moving);
  return join;
}

std::vector<OpenWay> make_open_ways(const std::vector<std::size_t>& index, const JoinProblem& problem,
                                    const ConsistentSet& consistent_set) {
  const auto first_input = [&](const NodeGroup& group) {
    return *std::min_element(group.begin(), group.end(), [&](const PlacedNode& x, const PlacedNode& y) {
      return index[x.map] < index[y.map];
    });
  };
  std::vector<OpenWay> ways;
  for (const OpenJoin& open : find_open_joins(problem, consistent_set, kMinOpenProbability)) {
    PlacedNode fixed = first_input(consistent_set.groups[open.a]);
    PlacedNode moving = first_input(consistent_set.groups[open.b]);
    SE2 T = inverse(fixed.T_group_map) * open.T_a_b * moving.T_group_map;
    if (index[moving.map] < index[fixed.map]) {
      std::swap(fixed, moving);
      T = inverse(T);
    }
    ways.push_back({index[fixed.map], index[moving.map], T, open.probability});
  }
  return ways;
}

const Join* likeliest_join(std::size_t map, const std::vector<Join>& joins) {
  const Join* likeliest = nullptr;
  for (const Join& join : joins) {
    if (join.fixed != map && join.moving != map) continue;
    if (likeliest == nullptr || join.match.probability > likeliest->match.probability) likeliest = &join;
  }
  return likeliest;
}

LeftOut left_out(std::size_t map, const std::vector<Join>& joins) {
  const bool is_over_budget = std::any_of(joins.begin(), joins.end(), [&](const Join& join) {
    return join.over_budget && (join.fixed == map || join.moving == map);
  });
  if (is_over_budget) return {map, Reason::over_budget};
  const Join* const likeliest = likeliest_join(map, joins);
  return {map, likeliest == nullptr ? Reason::nothing_to_compare : likeliest->reason()};
}

}  // namespace gridmerge::internal
