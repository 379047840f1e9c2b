// SPDX-License-Identifier: Apache-2.0
#include "search/local_maxima.hpp"

#include <algorithm>

#include "grid/for_each_equal.hpp"
#include "grid/multiversion.hpp"

namespace gridmerge::internal {

namespace {

GRIDMERGE_MULTIVERSION
std::int16_t maximum_of(const std::int16_t* row, int columns, std::int16_t least) {
  for (int x = 0; x < columns; ++x) least = row[x] > least ? row[x] : least;
  return least;
}

/// marks[x] = 1 where row[x] is a local maximum, for x in [1, columns - 1). No branches: most cells are none,
/// and where they are cannot be foreseen.
GRIDMERGE_MULTIVERSION
void mark_maxima(const std::int16_t* row, int width, int columns, std::int16_t floor, std::uint8_t* marks) {
  const std::int16_t* before = row - width;
  const std::int16_t* after = row + width;
  for (int x = 1; x < columns - 1; ++x) {
    const std::int16_t score = row[x];
    const std::int16_t not_less =  // what a maximum must reach
        std::max(std::max(before[x - 1], before[x]), std::max(before[x + 1], row[x - 1]));
    const std::int16_t less =  // what it must exceed
        std::max(std::max(after[x - 1], after[x]), std::max(std::max(after[x + 1], row[x + 1]), floor));
    marks[x] = static_cast<std::uint8_t>((score >= not_less) & (score > less));
  }
}

/// Adds the maxima of a row in the columns from `first` (1 or more) on, `count` of them. `marks` has a place
/// for one more on either side.
void add_maxima(const ScoreImage& scores, int y, int first, int count, int floor,
                std::vector<std::uint8_t>& marks, std::vector<LocalMaximum>& maxima) {
  const std::int16_t* const row = scores.values.data() + static_cast<std::size_t>(y) * scores.width;
  mark_maxima(row + first - 1, scores.width, count + 2, static_cast<std::int16_t>(floor), marks.data());
  for_each_equal(marks.data() + 1, static_cast<std::size_t>(count), std::uint8_t{1}, [&](std::size_t i) {
    const int x = first + static_cast<int>(i);
    maxima.push_back({x, y, row[x]});
  });
}

/// The columns of a block that are among the first ones.
int columns_of(const ScoreBlock& block, int columns) {
  return std::min(columns - block.x, ScoreBlock::kColumns);
}

}  // namespace

int find_maximum(const ScoreImage& scores, int columns) {
  std::int16_t best = 0;
  for (int y = 0; y < scores.height; ++y)
    best = maximum_of(scores.values.data() + static_cast<std::size_t>(y) * scores.width, columns, best);
  return best;
}

int find_maximum(const ScoreImage& scores, const std::vector<ScoreBlock>& blocks, int columns) {
  std::int16_t best = 0;
  for (const ScoreBlock& block : blocks) {
    for (int y = block.y; y < std::min(block.y + ScoreBlock::kRows, scores.height); ++y)
      best = maximum_of(scores.values.data() + static_cast<std::size_t>(y) * scores.width + block.x,
                        columns_of(block, columns), best);
  }
  return best;
}

std::vector<LocalMaximum> find_local_maxima(const ScoreImage& scores, int columns, int floor) {
  std::vector<LocalMaximum> maxima;
  if (columns < 3) return maxima;
  std::vector<std::uint8_t> marks(scores.width, 0);
  for (int y = 1; y + 1 < scores.height; ++y) add_maxima(scores, y, 1, columns - 2, floor, marks, maxima);
  return maxima;
}

std::vector<LocalMaximum> find_local_maxima(const ScoreImage& scores, const std::vector<ScoreBlock>& blocks,
                                            int columns, int floor) {
  std::vector<LocalMaximum> maxima;
  std::vector<std::uint8_t> marks(ScoreBlock::kColumns + 2, 0);
  for (const ScoreBlock& block : blocks) {
    const int first = std::max(block.x, 1);
    const int last = std::min(block.x + columns_of(block, columns), columns - 1);  // one behind it
    for (int y = std::max(block.y, 1); y < std::min(block.y + ScoreBlock::kRows, scores.height - 1); ++y)
      if (first < last) add_maxima(scores, y, first, last - first, floor, marks, maxima);
  }
  return maxima;
}

}  // namespace gridmerge::internal
