// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

// The measures of A. Birk and S. Carpin, "Merging occupancy grid maps from multiple robots", Proc. IEEE,
// 2006, which is "the paper" below.

/// In a DistanceMap: the grid has no cell of the value.
inline constexpr std::uint16_t kNoDistance = 0xffff;

/// Manhattan distances between cells are kept in 16 bits: width + height must not exceed this.
inline constexpr int kMaxDistanceMapSides = 32000;

/// d-map_c of Birk & Carpin 2006: for every cell of a grid the Manhattan distance [cells] to the nearest cell
/// of one value, row-major as the grid; kNoDistance everywhere if there is none.
struct DistanceMap {
  int width = 0;                         ///< columns
  int height = 0;                        ///< rows
  std::vector<std::uint16_t> distances;  ///< width * height values [cells]

  /// The distance at a cell, which has to be inside.
  std::uint16_t at(int column, int row) const {
    return distances[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column)];
  }
};

/// Algorithm 2 of the paper, with its two passes split by direction: both ways along the columns, then both
/// ways along the rows, sixteen of which go at a time. Throws std::invalid_argument if width + height >
/// kMaxDistanceMapSides. O(cells); vectorised.
GRIDMERGE_EXPORT DistanceMap make_distance_map(const OccupancyGrid& grid, Cell value);

/// Algorithm 2 of the paper to look at: what its two passes leave.
struct DistanceMapPasses {
  DistanceMap start;     ///< 0 at the cells of the value, kNoDistance elsewhere
  DistanceMap forward;   ///< after the pass from the upper left corner on: the left and the upper neighbour
  DistanceMap backward;  ///< after the pass from the lower right corner on: d-map_c
};

/// The passes as the paper writes them, cell by cell; `backward` equals make_distance_map(), which is ten
/// times as fast. The upper row is the last one: y points up. Throws as make_distance_map(). O(cells).
GRIDMERGE_EXPORT DistanceMapPasses trace_distance_map(const OccupancyGrid& grid, Cell value);

// They compare cells of maps that lie on one lattice. These functions lay maps at poses on
// the lattice of any grid: its size, resolution and origin count, its cells do not. Each cell takes the value
// of the map's cell in which its centre falls (nearest cell), and is unknown where there is none. A centre
// that falls on the edge between two cells, to about a millionth of a cell, may go to either.
//
// The first two throw std::invalid_argument for invalid grids, resolutions that differ by more than 100
// times, sides of more than a million cells, and a transform that is not finite or puts the map that far
// away.

/// T(m), the map that a transform makes of a map (definition 4 of the paper), on `lattice`: a grid of its
/// size, resolution and origin. `map.T_output_map` takes the map's frame to the lattice's [m, rad].
/// Probabilities are dropped. O(cells of the lattice).
GRIDMERGE_EXPORT OccupancyGrid draw_on_lattice(const OccupancyGrid& lattice, const PlacedMap& map);

/// omega for k maps at poses (eq. 3): cells of the lattice at which all of them have the same value, unknown
/// included. The order of the maps plays no part. Every cell counts for a single map, none for no map.
/// O(k * cells of the lattice).
GRIDMERGE_EXPORT std::int64_t count_equal_cells(const OccupancyGrid& lattice,
                                                std::span<const PlacedMap> maps);

/// Whether the rectangles that hold the maps' known cells share a cell of the fixed map's lattice: the maps
/// can have something in common only then. False for a transform that is not finite or puts the maps more
/// than a million cells apart. Throws std::invalid_argument for invalid grids, and resolutions that differ by
/// more than 100 times. O(cells of both).
GRIDMERGE_EXPORT bool lie_on_each_other(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                        const SE2& T_fixed_moving);

// Of two maps the lattice is the fixed map's, continued without end. Cells take their values as above.

/// omega (eq. 2): cells of the fixed map that have the same value, unknown included, as the moving map's
/// there. Symmetric for maps of one size and origin under the identity. Throws std::invalid_argument for
/// invalid grids, resolutions that differ by more than 100 times, sides of more than a million cells, and a
/// transform that is not finite or puts the maps that far apart. O(cells of the fixed map).
GRIDMERGE_EXPORT std::int64_t count_equal_cells(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                                const SE2& T_fixed_moving);

/// d(m1, m2, c) (algorithm 3, divided by the number of cells): the mean over the cells of m1 with value c of
/// the Manhattan distance to m2's nearest cell with value c.
struct DirectedDistance {
  std::int64_t sum = 0;    ///< [cells]
  std::int64_t count = 0;  ///< cells of m1 with the value; 0 as well when m2 has none of them

  /// A value that is missing in either map leaves the distance undefined: it counts as 0.
  bool defined() const { return count > 0; }
  /// d(m1, m2, c) [cells].
  double mean() const { return defined() ? static_cast<double>(sum) / static_cast<double>(count) : 0.0; }
};

/// What the paper measures of a pose.
struct ImageSimilarity {
  DirectedDistance fixed_to_moving_free;      ///< d(fixed, moving, free)
  DirectedDistance moving_to_fixed_free;      ///< d(moving, fixed, free)
  DirectedDistance fixed_to_moving_occupied;  ///< d(fixed, moving, occupied)
  DirectedDistance moving_to_fixed_occupied;  ///< d(moving, fixed, occupied)
  std::int64_t omega = 0;         ///< cells of the fixed map that have the same value, unknown included
  std::int64_t agreement = 0;     ///< agr: cells known in both maps and equal
  std::int64_t disagreement = 0;  ///< dis: cells known in both maps and different

  /// psi: the sum of the four mean distances; 0 for equal maps. Smaller is more similar.
  double psi() const {
    return fixed_to_moving_free.mean() + moving_to_fixed_free.mean() + fixed_to_moving_occupied.mean() +
           moving_to_fixed_occupied.mean();
  }
  /// How many of psi's four distances are undefined and count as 0.
  int undefined_terms() const {
    return !fixed_to_moving_free.defined() + !moving_to_fixed_free.defined() +
           !fixed_to_moving_occupied.defined() + !moving_to_fixed_occupied.defined();
  }
  /// Delta = psi + c_lock * (dis - agr), to be minimised.
  double delta(double c_lock) const { return psi() + c_lock * static_cast<double>(disagreement - agreement); }
  /// ai = agr / (agr + dis); 0 when nothing is known in common.
  double acceptance_index() const {
    const std::int64_t known = agreement + disagreement;
    return known == 0 ? 0.0 : static_cast<double>(agreement) / static_cast<double>(known);
  }
};

/// The cells known in both maps, by what the maps say of them.
struct CommonClasses {
  std::int64_t occupied_occupied = 0;  ///< occupied in both maps
  std::int64_t free_free = 0;          ///< free in both maps
  std::int64_t contradicting = 0;      ///< free in one map, occupied in the other
};

/// Whether `a` is the better pose of the two: fewer undefined distances (which count nothing, and would
/// reward a pose at which a class is lost), then the smaller Delta.
GRIDMERGE_EXPORT bool is_better(const ImageSimilarity& a, const ImageSimilarity& b, double c_lock);

/// Measures poses of one pair of maps. The fixed map's distance maps are made once; a pose then costs the
/// moving map's turning, its two distance maps and the sums, in memory that is kept from pose to pose. Only
/// the rectangle of known cells of either map is touched, which changes nothing in the results.
///
/// Copies share what belongs to the maps and have memory of their own: one copy a thread.
class GRIDMERGE_EXPORT SimilarityMeter {
 public:
  /// Copies what it needs of the maps. Throws std::invalid_argument for an invalid grid, for resolutions that
  /// differ by more than 100 times, and unless width + height of the fixed map's known rectangle and one and
  /// a half times that of the moving map's, in cells of the fixed one, are kMaxDistanceMapSides at most: a
  /// turned map is wider by the square root of 2 at most. O(cells).
  SimilarityMeter(const OccupancyGrid& fixed, const OccupancyGrid& moving);
  /// Shares what belongs to the maps, and has memory of its own.
  SimilarityMeter(const SimilarityMeter& other);
  SimilarityMeter& operator=(const SimilarityMeter&) = delete;
  ~SimilarityMeter();

  /// Whether the pose is finite, and width + height of the rectangle that holds both known rectangles is
  /// kMaxDistanceMapSides at most. O(1).
  bool can_measure(const SE2& T_fixed_moving) const;

  /// `T_fixed_moving` is between map frames [m, rad]. Throws std::invalid_argument unless can_measure() it.
  /// O(cells of the rectangle that holds both maps' known cells).
  ImageSimilarity operator()(const SE2& T_fixed_moving);

  /// agr and dis by class. Argument and errors as above. O(cells of the moving map).
  CommonClasses count_common(const SE2& T_fixed_moving);

 private:
  void draw(const SE2& T_fixed_moving);

  struct Maps;
  struct Scratch;
  std::shared_ptr<const Maps> maps_;
  std::unique_ptr<Scratch> scratch_;
};

/// The same for a single pose.
GRIDMERGE_EXPORT ImageSimilarity measure_similarity(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                                    const SE2& T_fixed_moving);

}  // namespace gridmerge
