// SPDX-License-Identifier: Apache-2.0
#include "similarity/distance_kernels.hpp"

#include <algorithm>

#include "grid/multiversion.hpp"
#include "grid/unaligned.hpp"
#include "gridmerge/similarity/image_similarity.hpp"

namespace gridmerge::internal {
inline namespace multiversion {

namespace {

// One strip column, and its halves: 16 and 8 lanes of 16 bits.
using Column = std::uint16_t __attribute__((vector_size(32)));
using Eight = std::uint16_t __attribute__((vector_size(16)));
using StripBytes = std::uint8_t __attribute__((vector_size(16)));
using Bytes = std::uint8_t __attribute__((vector_size(32)));
static_assert(sizeof(Column) == kStripRows * sizeof(std::uint16_t));

/// nearest = min(nearest + 1, the distances at `at`), stored there.
inline __attribute__((always_inline)) void relax_column(Column& nearest, std::uint16_t* at) {
  Column here;
  load(at, here);
  nearest += 1;
  nearest = nearest < here ? nearest : here;
  store(nearest, at);
}

/// Element (i, j) of the result is element (j, i) of `rows`. Each round interleaves rows that lie half the
/// tile apart; three rounds rotate the six bits of an element's address by half.
inline __attribute__((always_inline)) void transpose(Eight (&rows)[kTile]) {
  for (int round = 0; round < 3; ++round) {
    Eight mixed[kTile];
    for (std::size_t i = 0; i < kTile / 2; ++i) {
      mixed[2 * i] = __builtin_shufflevector(rows[i], rows[i + 4], 0, 8, 1, 9, 2, 10, 3, 11);
      mixed[2 * i + 1] = __builtin_shufflevector(rows[i], rows[i + 4], 4, 12, 5, 13, 6, 14, 7, 15);
    }
    for (std::size_t i = 0; i < kTile; ++i) rows[i] = mixed[i];
  }
}

}  // namespace

GRIDMERGE_MULTIVERSION
void pass_row(const std::uint8_t* cells, std::size_t count, std::uint8_t value,
              const std::uint16_t* neighbour, std::uint16_t* distances) {
  std::size_t i = 0;
  for (; i + kStripRows <= count; i += kStripRows) {
    StripBytes bytes;
    Column next;
    load(cells + i, bytes);
    load(neighbour + i, next);
    const Column cell = __builtin_convertvector(bytes, Column);
    next = (next + 1) & static_cast<Column>(cell != static_cast<std::uint16_t>(value));
    store(next, distances + i);
  }
  for (; i < count; ++i) distances[i] = cells[i] == value ? 0 : static_cast<std::uint16_t>(neighbour[i] + 1);
}

GRIDMERGE_MULTIVERSION
void pass_rows_without(int rows, std::size_t count, const std::uint16_t* neighbour,
                       std::uint16_t* distances) {
  for (std::size_t i = 0; i < count; ++i) distances[i] = static_cast<std::uint16_t>(neighbour[i] + rows);
}

GRIDMERGE_MULTIVERSION
void relax_row(std::uint16_t* row, const std::uint16_t* neighbour, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t next = static_cast<std::uint16_t>(neighbour[i] + 1);
    row[i] = next < row[i] ? next : row[i];
  }
}

GRIDMERGE_MULTIVERSION
void rows_to_strip(const std::uint16_t* rows, std::size_t stride, int columns, std::uint16_t* strip) {
  for (int x = 0; x < columns; x += kTile) {
    for (int half = 0; half < kStripRows; half += kTile) {
      Eight tile[kTile];
      for (int i = 0; i < kTile; ++i) load(rows + (half + i) * stride + x, tile[i]);
      transpose(tile);
      for (int i = 0; i < kTile; ++i)
        store(tile[i], strip + static_cast<std::size_t>(x + i) * kStripRows + half);
    }
  }
}

GRIDMERGE_MULTIVERSION
void strip_to_rows(const std::uint16_t* strip, int columns, std::uint16_t* rows, std::size_t stride) {
  for (int x = 0; x < columns; x += kTile) {
    for (int half = 0; half < kStripRows; half += kTile) {
      Eight tile[kTile];
      for (int i = 0; i < kTile; ++i)
        load(strip + static_cast<std::size_t>(x + i) * kStripRows + half, tile[i]);
      transpose(tile);
      for (int i = 0; i < kTile; ++i) store(tile[i], rows + (half + i) * stride + x);
    }
  }
}

GRIDMERGE_MULTIVERSION
void sweep_right(std::uint16_t* strip, int columns) {
  Column nearest;
  load(strip, nearest);
  for (int x = 1; x < columns; ++x) relax_column(nearest, strip + static_cast<std::size_t>(x) * kStripRows);
}

GRIDMERGE_MULTIVERSION
void sweep_left(std::uint16_t* strip, int columns) {
  Column nearest;
  load(strip + static_cast<std::size_t>(columns - 1) * kStripRows, nearest);
  for (int x = columns - 2; x >= 0; --x)
    relax_column(nearest, strip + static_cast<std::size_t>(x) * kStripRows);
}

namespace {

/// Adds up distances, the bytes of each apart, in 16 bits a lane: 256 columns at most.
struct ColumnSum {
  static constexpr int kMax = 256;

  inline __attribute__((always_inline)) void add(const Column& distance, const std::uint8_t* cells,
                                                 std::uint8_t value) {
    StripBytes bytes;
    load(cells, bytes);
    const Column cell = __builtin_convertvector(bytes, Column);
    const Column counted = distance & static_cast<Column>(cell == static_cast<std::uint16_t>(value));
    low += counted & 0xff;
    high += counted >> 8;
  }

  inline __attribute__((always_inline)) std::uint64_t total() const {
    std::uint16_t lows[kStripRows];
    std::uint16_t highs[kStripRows];
    store(low, lows);
    store(high, highs);
    std::uint32_t sum = 0;  // below 2^29
    for (int lane = 0; lane < kStripRows; ++lane) sum += lows[lane] + std::uint32_t{256} * highs[lane];
    return sum;
  }

  Column low{};
  Column high{};
};

}  // namespace

GRIDMERGE_MULTIVERSION
std::uint64_t sweep_left_and_sum(const std::uint16_t* strip, int columns, int first, int count,
                                 const std::uint8_t* cells, std::uint8_t value) {
  Column nearest = Column{} + kNoDistance - 1;
  const auto sweep_to = [&](int x) __attribute__((always_inline)) {
    Column here;
    load(strip + static_cast<std::size_t>(x) * kStripRows, here);
    nearest += 1;
    nearest = nearest < here ? nearest : here;
  };
  int x = columns - 1;
  for (; x >= first + count; --x) sweep_to(x);
  std::uint64_t sum = 0;
  while (x >= first) {
    ColumnSum block;
    for (const int last = std::max(first, x + 1 - ColumnSum::kMax); x >= last; --x) {
      sweep_to(x);
      block.add(nearest, cells + static_cast<std::size_t>(x - first) * kStripRows, value);
    }
    sum += block.total();
  }
  return sum;
}

GRIDMERGE_MULTIVERSION
std::uint64_t sum_where(const std::uint16_t* distances, const std::uint8_t* cells, std::size_t count,
                        std::uint8_t value) {
  std::uint64_t sum = 0;
  std::size_t i = 0;
  while (i + kStripRows <= count) {
    constexpr std::size_t kBlock = std::size_t{ColumnSum::kMax} * kStripRows;
    const std::size_t last = std::min(i + kBlock, count - (count - i) % kStripRows);
    ColumnSum block;
    for (; i < last; i += kStripRows) {
      Column distance;
      load(distances + i, distance);
      block.add(distance, cells + i, value);
    }
    sum += block.total();
  }
  for (; i < count; ++i) sum += cells[i] == value ? distances[i] : 0;
  return sum;
}

namespace {

/// Cells are compared this many at a time, and counted in 8 bits for as long as that fits.
constexpr std::size_t kLanes = 32;
constexpr std::size_t kCountedBlock = 255 * kLanes;

}  // namespace

GRIDMERGE_MULTIVERSION
std::int64_t count_where(const std::uint8_t* cells, std::size_t count, std::uint8_t value) {
  std::int64_t sum = 0;
  std::size_t i = 0;
  while (i + kLanes <= count) {
    const std::size_t last = std::min(i + kCountedBlock, count - (count - i) % kLanes);
    Bytes found{};
    for (; i < last; i += kLanes) {
      Bytes here;
      load(cells + i, here);
      found -= static_cast<Bytes>(here == value);  // true is -1
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) sum += found[lane];
  }
  for (; i < count; ++i) sum += cells[i] == value;
  return sum;
}

GRIDMERGE_MULTIVERSION
CommonCells count_common(const std::uint8_t* a, const std::uint8_t* b, std::size_t count) {
  CommonCells common;
  std::size_t i = 0;
  while (i + kLanes <= count) {
    const std::size_t last = std::min(i + kCountedBlock, count - (count - i) % kLanes);
    Bytes equal{};
    Bytes different{};
    for (; i < last; i += kLanes) {
      Bytes ours;
      Bytes theirs;
      load(a + i, ours);
      load(b + i, theirs);
      const Bytes known = static_cast<Bytes>((ours != 0) & (theirs != 0));
      const Bytes same = static_cast<Bytes>(ours == theirs);
      equal -= known & same;
      different -= known & ~same;
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      common.equal += equal[lane];
      common.different += different[lane];
    }
  }
  for (; i < count; ++i) {
    if (a[i] == 0 || b[i] == 0) continue;
    ++(a[i] == b[i] ? common.equal : common.different);
  }
  return common;
}

}  // namespace multiversion
}  // namespace gridmerge::internal
