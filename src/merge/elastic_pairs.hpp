// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "merge/elastic_sheet.hpp"
#include "merge/elastic_walls.hpp"

namespace gridmerge::internal {

/// A map that is being bent, with its walls.
struct ElasticMember {
  ElasticSheet sheet;
  ElasticWalls walls;
  bool held = false;                             ///< it stays as it is
  MapTransform freedom = MapTransform::elastic;  ///< what the sheet may become
};

/// A square of the floor, by column and row, in the group frame.
using FloorSquare = std::pair<int, int>;

/// Walls on the squares of one colour of a chessboard, as the maps lie before they are bent.
struct WallFold {
  double side = 0.0;  ///< of a square [m]; 0: all walls, whatever the colour
  int colour = 0;     ///< 0 or 1

  bool has_all() const { return side == 0.0; }
  bool has(const FloorSquare& square) const {
    return has_all() || ((square.first + square.second) & 1) == colour;
  }
};

/// Two walls that are thought to be one, of two maps.
struct WallTie {
  SplineWeights at_first;   ///< of the first map, at the place half-way between the two walls
  SplineWeights at_second;  ///< of the second map, at the same place
  Point2 gap;               ///< from the second map's wall to the first one's [m, group frame]
  Point2 normal;            ///< of both, of length 1 [group frame]
  double across = 0.0;      ///< weight of the gap across the wall [1/m^2]
  double along = 0.0;       ///< weight of the gap along it
};

/// The ties of two maps.
struct TiedPair {
  std::size_t first = 0;  ///< less than `second`
  std::size_t second = 0;
  std::vector<WallTie> ties;
};

/// The pairs of maps with walls within `reach` metres of each other, of each map the few that have most;
/// ascending. O(maps^2) looks at a few walls.
std::vector<std::pair<std::size_t, std::size_t>> pairs_that_meet(const std::vector<ElasticMember>& members,
                                                                 double reach);

/// The walls of each pair, on the squares of the fold, that lie within `reach` metres of each other and face
/// alike: each to the nearest. The farther apart two are, the less they weigh (Geman and McClure 1985): half
/// of a reach is usual. Walls of a pair weigh the less, the more pairs its maps are in, and twice as much if
/// the fold has half of them. O(pairs).
std::vector<TiedPair> tie_walls(const std::vector<ElasticMember>& members,
                                const std::vector<std::pair<std::size_t, std::size_t>>& pairs, double reach,
                                double cell, const WallFold& fold);

/// How far the walls of a pair lie from each other.
struct PairMisfit {
  std::map<FloorSquare, double> on;  ///< sum over the walls on each square of the fold
  double met = 0.0;                  ///< walls that the other map has near
};

/// What a wall counts that lies so far from its partner, across [m]: 0.5 at 0.2 m (or two cells).
double misfit_of_gap(double gap, double cell);

/// Of each pair; a wall that the other map does not have near counts 1. O(pairs).
std::vector<PairMisfit> misfits_of(const std::vector<ElasticMember>& members,
                                   const std::vector<std::pair<std::size_t, std::size_t>>& pairs, double cell,
                                   const WallFold& fold);

}  // namespace gridmerge::internal
