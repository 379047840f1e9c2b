// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "search/correlate.hpp"

namespace gridmerge::internal {

struct LocalMaximum {
  int x;
  int y;
  int score;
};

/// The largest score in the first `columns` columns; 0 if none is positive. O(scores); vectorised.
int find_maximum(const ScoreImage& scores, int columns);

/// The same of the scores in the blocks. O(scores in blocks).
int find_maximum(const ScoreImage& scores, const std::vector<ScoreBlock>& blocks, int columns);

/// Scores above `floor` that none of their eight neighbours exceeds, in reading order, in the first `columns`
/// columns and without the image's rim. On a plateau the last cell in reading order stands for all.
/// O(scores); vectorised.
std::vector<LocalMaximum> find_local_maxima(const ScoreImage& scores, int columns, int floor);

/// The same of the scores in the blocks, block by block; their neighbours may lie in none. O(scores in
/// blocks).
std::vector<LocalMaximum> find_local_maxima(const ScoreImage& scores, const std::vector<ScoreBlock>& blocks,
                                            int columns, int floor);

}  // namespace gridmerge::internal
