// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace gridmerge::internal {
inline namespace multiversion {

// Steps of the Manhattan distance transform. It splits by direction: first along the columns, one row after
// the other, then along the rows, for which kStripRows rows are laid side by side ("a strip": all rows' cells
// of the first column, then of the second, ...) so that they go at the same time.
//
// Distances are below kFarDistance, which stands for "no cell yet" and may grow by as many steps as it takes
// to cross the map without leaving 16 bits.

inline constexpr std::uint16_t kFarDistance = 0x7fff;
inline constexpr int kStripRows = 16;
inline constexpr int kTile = 8;  // columns of a strip are made in blocks of this many

/// The pass along the columns, one row: distances[i] = 0 where cells[i] is `value`, else neighbour[i] + 1.
/// `neighbour` may be `distances` itself.
void pass_row(const std::uint8_t* cells, std::size_t count, std::uint8_t value,
              const std::uint16_t* neighbour, std::uint16_t* distances);

/// The same for `rows` rows without the value: distances[i] = neighbour[i] + rows.
void pass_rows_without(int rows, std::size_t count, const std::uint16_t* neighbour, std::uint16_t* distances);

/// row[i] = min(row[i], neighbour[i] + 1).
void relax_row(std::uint16_t* row, const std::uint16_t* neighbour, std::size_t count);

/// Lays kStripRows rows of `columns` distances, `stride` apart, side by side. `columns` must be a multiple of
/// kTile.
void rows_to_strip(const std::uint16_t* rows, std::size_t stride, int columns, std::uint16_t* strip);

/// The inverse of rows_to_strip.
void strip_to_rows(const std::uint16_t* strip, int columns, std::uint16_t* rows, std::size_t stride);

/// Relaxes each column of the strip from the one before it, the first one excepted.
void sweep_right(std::uint16_t* strip, int columns);

/// Relaxes each column of the strip from the one after it, the last one excepted.
void sweep_left(std::uint16_t* strip, int columns);

/// The sum of the distances that sweep_left would leave in the `count` columns from `first` on, where `cells`
/// (a strip of those columns alone) is `value`. The strip stays as it is.
std::uint64_t sweep_left_and_sum(const std::uint16_t* strip, int columns, int first, int count,
                                 const std::uint8_t* cells, std::uint8_t value);

/// The sum of the distances at those of `count` places where the cell is `value`.
std::uint64_t sum_where(const std::uint16_t* distances, const std::uint8_t* cells, std::size_t count,
                        std::uint8_t value);

/// How many of `count` cells are `value`.
std::int64_t count_where(const std::uint8_t* cells, std::size_t count, std::uint8_t value);

struct CommonCells {
  std::int64_t equal = 0;
  std::int64_t different = 0;
};

/// Compares `count` cells of two maps where both are known (not 0).
CommonCells count_common(const std::uint8_t* a, const std::uint8_t* b, std::size_t count);

}  // namespace multiversion
}  // namespace gridmerge::internal
