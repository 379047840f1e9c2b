// SPDX-License-Identifier: Apache-2.0
#include "io/raw_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace gridmerge::internal {

namespace {

constexpr std::uint8_t kUnknownPixel = 255;

// The smallest and the largest probability of the cells of a kind; none yet: the range that holds nothing.
struct Range {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();

  void add(double probability) {
    least = std::min(least, probability);
    most = std::max(most, probability);
  }
  bool is_empty() const { return least > most; }
};

// Percentages up to `most_free` are free, and those from `least_occupied` on are occupied.
struct Split {
  int most_free = 0;
  int least_occupied = 100;
};

// A threshold between two probabilities, of which either may be missing: the usual one if it lies there.
double threshold_between(double below, double above, double usual) {
  const double least = std::max(below, 0.0), most = std::min(above, 1.0);
  return least <= usual && usual <= most ? usual : 0.5 * (least + most);
}

// The highest percentage that a probability may get, at most one off, and the lowest.
int highest_above(double probability) {
  return static_cast<int>(std::floor(100.0 * std::min(probability, 1.0))) + 1;
}
int lowest_below(double probability) {
  return static_cast<int>(std::ceil(100.0 * std::max(probability, 0.0))) - 1;
}

// Where the percentages change their meaning if they are to keep the cells; none if they cannot.
std::optional<Split> split_of(const Range& free, const Range& unknown, const Range& occupied) {
  const double above_free = std::min(unknown.least, occupied.least),
               below_occupied = std::max(unknown.most, free.most);
  if (free.most >= above_free || below_occupied >= occupied.least) return std::nullopt;
  const double free_threshold = threshold_between(free.most, above_free, kFreeThreshold),
               occupied_threshold = threshold_between(below_occupied, occupied.least, kOccupiedThreshold);
  Split split;
  split.most_free = std::min(99, static_cast<int>(std::floor(100.0 * free_threshold)));
  split.least_occupied =
      std::max(split.most_free + 1, static_cast<int>(std::ceil(100.0 * occupied_threshold)));
  if (unknown.is_empty() || split.least_occupied - split.most_free > 1) return split;
  // A percentage is to lie between: as far off as a percentage may be, there may be one.
  split.least_occupied = std::min({split.most_free + 2, 100, highest_above(occupied.least)});
  split.most_free = std::max({split.least_occupied - 2, 0, lowest_below(free.most)});
  return split.least_occupied - split.most_free > 1 ? std::optional(split) : std::nullopt;
}

double probability_at(const OccupancyGrid& grid, std::size_t index) {
  return std::clamp(static_cast<double>(grid.probability[index]), 0.0, 1.0);
}

std::optional<Split> split_of(const OccupancyGrid& grid) {
  Range ranges[3];  // by Cell
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    if (!std::isnan(grid.probability[i]))
      ranges[static_cast<std::size_t>(grid.cells[i])].add(probability_at(grid, i));
  const auto of = [&](Cell cell) { return ranges[static_cast<std::size_t>(cell)]; };
  return split_of(of(Cell::free), of(Cell::unknown), of(Cell::occupied));
}

std::uint8_t pixel_without_probability(Cell cell) {
  return cell == Cell::unknown ? kUnknownPixel : cell == Cell::free ? 0 : 100;
}

// The percentages that are such a cell.
std::pair<int, int> percentages_of(Cell cell, const Split& split) {
  switch (cell) {
    case Cell::free:
      return {0, split.most_free};
    case Cell::occupied:
      return {split.least_occupied, 100};
    case Cell::unknown:
      break;
  }
  return {split.most_free + 1, split.least_occupied - 1};
}

std::uint8_t pixel_of(const OccupancyGrid& grid, std::size_t index, const std::optional<Split>& split) {
  const Cell cell = grid.cells[index];
  if (std::isnan(grid.probability[index])) return pixel_without_probability(cell);
  const auto nearest = static_cast<int>(std::lround(100.0 * probability_at(grid, index)));
  const auto [least, most] = split ? percentages_of(cell, *split) : std::pair(0, 100);
  return static_cast<std::uint8_t>(std::clamp(nearest, least, most));
}

// A percentage is of a kind exactly if a number in a map's file says so: n / 100 is the same double in both.
OccupancyThresholds thresholds_of(const Split& split) {
  constexpr int kUsualMostFree = 19, kUsualLeastOccupied = 65;
  static_assert(kUsualMostFree <= 100 * kFreeThreshold && 100 * kFreeThreshold < kUsualMostFree + 1);
  static_assert(100 * kOccupiedThreshold == kUsualLeastOccupied);
  OccupancyThresholds thresholds;
  if (split.most_free != kUsualMostFree) thresholds.free = split.most_free / 100.0;
  thresholds.occupied = split.least_occupied / 100.0;
  return thresholds;
}

}  // namespace

RawPixels to_raw_pixels(const OccupancyGrid& grid) {
  const std::optional<Split> split = split_of(grid);
  RawPixels raw;
  if (split) raw.thresholds = thresholds_of(*split);
  raw.pixels.reserve(grid.cells.size());
  for (int row = grid.height - 1; row >= 0; --row)
    for (int column = 0; column < grid.width; ++column)
      raw.pixels.push_back(pixel_of(grid, grid.index(column, row), split));
  return raw;
}

}  // namespace gridmerge::internal
