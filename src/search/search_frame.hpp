// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <numbers>
#include <tuple>
#include <vector>

#include "search/correlate.hpp"
#include "search/exhaustive.hpp"
#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// A local maximum of a search's score, in steps of the search.
struct Peak {
  int rotation;
  int x;
  int y;
  int score;

  /// Best first; the rest of the order only has to be total, so that it does not depend on threads.
  friend bool operator<(const Peak& a, const Peak& b) {
    return std::tuple(-a.score, a.rotation, a.y, a.x) < std::tuple(-b.score, b.rotation, b.y, b.x);
  }
};

/// The frame of a search: the moving map turns about its centre inside a square box of coarse cells, and the
/// box slides over the fixed map from one touch to the last.
struct SearchFrame {
  double factor;  // cells to a coarse cell
  int rotations;
  Point2 centre;    // of the moving map [cells]
  int box;          // side of the box [coarse cells]
  int fixed_width;  // of the fixed map [coarse cells]
  int fixed_height;

  double angle(int rotation) const { return normalize_angle(2.0 * std::numbers::pi * rotation / rotations); }

  /// Grid frames, cells.
  SE2 pose(const Peak& peak) const;
};

SearchFrame make_search_frame(const LikelihoodField& fixed, const LikelihoodField& moving, int coarse_factor,
                              int rotations);

/// Throws std::invalid_argument for likelihood fields that do not go together and options that make no sense.
void check_search(const LikelihoodField& fixed, const LikelihoodField& moving,
                  const ExhaustiveSearchOptions& options, std::size_t most_samples);

/// The turned wall points, and the shifts at which enough of them can meet the fixed map.
struct TurnedWalls {
  std::vector<Sample> samples;  // in the fixed map's evidence, at the first shift; of plane 0
  int first_x = 0;              // shifts of the box, with one more on each side
  int first_y = 0;
  int shifts_x = 0;
  int shifts_y = 0;
};

/// Shifts at which fewer than `least` of the walls (at least 1) could lie on the fixed map are left out.
/// O(walls).
TurnedWalls turn_walls(const std::vector<WallPoint>& walls, const SearchFrame& frame, int rotation,
                       std::size_t least);

/// The best local maxima of a rotation's scores above 0, at most kPeaksPerRotation, in no order; those far
/// below the best one are no candidates. O(scores).
std::vector<Peak> best_peaks(const ScoreImage& scores, const TurnedWalls& turned, int rotation);

/// The same of those above `floor` (at least 0), where only the scores in the blocks are. O(scores in
/// blocks).
std::vector<Peak> best_peaks(const ScoreImage& scores, const std::vector<ScoreBlock>& looked_at,
                             const TurnedWalls& turned, int rotation, int floor);

/// The best ones, best first, without every peak that has a better one next to it. O(peaks log peaks).
std::vector<Peak> keep_distinct(std::vector<Peak> peaks, int rotations, std::size_t max_count);

/// The peaks of all rotations in one list.
std::vector<Peak> together(const std::vector<std::vector<Peak>>& by_rotation);

/// Fits `columns` and `rows` of scores, the width rounded up to whole blocks.
void resize(ScoreImage& scores, int columns, int rows);

}  // namespace gridmerge::internal
