// SPDX-License-Identifier: Apache-2.0
#include "grid/changed_cells.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <iterator>

namespace gridmerge::internal {

namespace {

/// Adds what differs in a row, by its bits: a probability that is not known equals itself then.
template <typename Value>
void add_differences(const Value* before, const Value* after, int width, int row, CellBox& box) {
  const auto count = static_cast<std::size_t>(width);
  if (std::memcmp(before, after, count * sizeof(Value)) == 0) return;
  using Bits = std::array<std::byte, sizeof(Value)>;
  const auto same = [](Value a, Value b) { return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b); };
  const auto first = std::mismatch(before, before + count, after, same).first - before;
  const auto from_end =
      std::mismatch(std::make_reverse_iterator(before + count), std::make_reverse_iterator(before),
                    std::make_reverse_iterator(after + count), same)
          .first.base() -
      before;
  box = unite(box, {static_cast<int>(first), row, static_cast<int>(from_end), row + 1});
}

}  // namespace

std::optional<CellBox> changed_cells(const OccupancyGrid& before, const OccupancyGrid& after) {
  if (before.width != after.width || before.height != after.height || before.resolution != after.resolution ||
      before.origin != after.origin)
    return std::nullopt;
  if (before.probability.empty() != after.probability.empty()) return all_cells(after);
  CellBox changed;
  for (int row = 0; row < after.height; ++row) {
    const std::size_t begin = after.index(0, row);
    add_differences(before.cells.data() + begin, after.cells.data() + begin, after.width, row, changed);
    if (!after.probability.empty())
      add_differences(before.probability.data() + begin, after.probability.data() + begin, after.width, row,
                      changed);
  }
  return changed;
}

}  // namespace gridmerge::internal
