// SPDX-License-Identifier: Apache-2.0
#include "similarity/chamfer.hpp"

#include <algorithm>
#include <cstddef>

#include "grid/multiversion.hpp"
#include "grid/unaligned.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

constexpr LabelledDistance kStraight = kChamferStep * kDistanceLabels;
constexpr LabelledDistance kDiagonal = kChamferDiagonal * kDistanceLabels;

// Eight neighbouring distances of a row.
using Lanes = LabelledDistance __attribute__((vector_size(32)));
constexpr int kLanes = sizeof(Lanes) / sizeof(LabelledDistance);

/// What lies `before` them lets no distance be more than one cell farther, and so on through the lanes. Three
/// steps of one, two and four lanes do what would otherwise take eight, one after the other.
inline __attribute__((always_inline)) void relax_upwards(Lanes& lanes, const Lanes& before) {
  const Lanes far = Lanes{} + kFarDistance;
  Lanes from = __builtin_shufflevector(lanes, far, 8, 0, 1, 2, 3, 4, 5, 6) + kStraight;
  lanes = lanes < from ? lanes : from;
  from = __builtin_shufflevector(lanes, far, 8, 9, 0, 1, 2, 3, 4, 5) + 2 * kStraight;
  lanes = lanes < from ? lanes : from;
  from = __builtin_shufflevector(lanes, far, 8, 9, 10, 11, 0, 1, 2, 3) + 4 * kStraight;
  lanes = lanes < from ? lanes : from;
  from = before + Lanes{1, 2, 3, 4, 5, 6, 7, 8} * kStraight;
  lanes = lanes < from ? lanes : from;
}

inline __attribute__((always_inline)) void reverse(Lanes& lanes) {
  lanes = __builtin_shufflevector(lanes, lanes, 7, 6, 5, 4, 3, 2, 1, 0);
}

/// row[x] = min(row[x], row[x - 1] + kStraight), for x from 1 to `count` - 1, in this order.
GRIDMERGE_MULTIVERSION
void relax_to_the_right(LabelledDistance* row, int count) {
  int x = 1;
  Lanes before = Lanes{} + row[0];
  for (; x + kLanes <= count; x += kLanes) {
    Lanes lanes;
    load(row + x, lanes);
    relax_upwards(lanes, before);
    store(lanes, row + x);
    before = __builtin_shufflevector(lanes, lanes, 7, 7, 7, 7, 7, 7, 7, 7);
  }
  for (; x < count; ++x) row[x] = std::min(row[x], row[x - 1] + kStraight);
}

/// row[x] = min(row[x], row[x + 1] + kStraight), for x from `count` - 2 to 0, in this order.
GRIDMERGE_MULTIVERSION
void relax_to_the_left(LabelledDistance* row, int count) {
  int left = count - 1;  // where the done ones begin
  Lanes before = Lanes{} + row[left];
  for (; left >= kLanes; left -= kLanes) {
    Lanes lanes;
    load(row + left - kLanes, lanes);
    reverse(lanes);
    relax_upwards(lanes, before);
    before = __builtin_shufflevector(lanes, lanes, 7, 7, 7, 7, 7, 7, 7, 7);
    reverse(lanes);
    store(lanes, row + left - kLanes);
  }
  for (int x = left - 1; x >= 0; --x) row[x] = std::min(row[x], row[x + 1] + kStraight);
}

/// row[x] = what is nearest of itself and of its three neighbours in the row beside it.
GRIDMERGE_MULTIVERSION
void relax_from_row(LabelledDistance* row, const LabelledDistance* beside, int count) {
  for (int x = 1; x + 1 < count; ++x) {
    const LabelledDistance diagonal = std::min(beside[x - 1], beside[x + 1]) + kDiagonal;
    row[x] = std::min(row[x], std::min(beside[x] + kStraight, diagonal));
  }
}

}  // namespace

void chamfer_distance(std::vector<LabelledDistance>& distance, int width, int height) {
  const auto row_at = [&](int y) { return distance.data() + static_cast<std::size_t>(y) * width; };
  for (int y = 1; y < height; ++y) {
    throw_if_cancelled();
    relax_from_row(row_at(y), row_at(y - 1), width);
    relax_to_the_right(row_at(y), width - 1);
  }
  for (int y = height - 2; y >= 0; --y) {
    throw_if_cancelled();
    relax_from_row(row_at(y), row_at(y + 1), width);
    relax_to_the_left(row_at(y) + 1, width - 1);
  }
}

}  // namespace gridmerge::internal
