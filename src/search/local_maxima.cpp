// SPDX-License-Identifier: Apache-2.0
#include "search/local_maxima.hpp"

#include <algorithm>
#include <cstring>

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

}  // namespace

int find_maximum(const ScoreImage& scores, int columns) {
  std::int16_t best = 0;
  for (int y = 0; y < scores.height; ++y)
    best = maximum_of(scores.values.data() + static_cast<std::size_t>(y) * scores.width, columns, best);
  return best;
}

std::vector<LocalMaximum> find_local_maxima(const ScoreImage& scores, int columns, int floor) {
  std::vector<LocalMaximum> maxima;
  std::vector<std::uint8_t> marks(scores.width, 0);
  for (int y = 1; y + 1 < scores.height; ++y) {
    const std::int16_t* row = scores.values.data() + static_cast<std::size_t>(y) * scores.width;
    mark_maxima(row, scores.width, columns, static_cast<std::int16_t>(floor), marks.data());
    for (int x = 1; x + 1 < columns; ++x) {
      const void* next = std::memchr(marks.data() + x, 1, static_cast<std::size_t>(columns - 1 - x));
      if (next == nullptr) break;
      x = static_cast<int>(static_cast<const std::uint8_t*>(next) - marks.data());
      maxima.push_back({x, y, row[x]});
    }
  }
  return maxima;
}

}  // namespace gridmerge::internal
