// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace gridmerge::internal {

/// A rectangle of cells.
struct CellBox {
  int left = 0;
  int bottom = 0;
  int right = 0;  ///< one past the last column
  int top = 0;    ///< one past the last row

  int width() const { return right - left; }
  int height() const { return top - bottom; }
  bool empty() const { return width() <= 0 || height() <= 0; }
};

/// The cells of both boxes; empty, but not negative in size, if there are none.
inline CellBox intersect(const CellBox& a, const CellBox& b) {
  CellBox common{std::max(a.left, b.left), std::max(a.bottom, b.bottom), std::min(a.right, b.right),
                 std::min(a.top, b.top)};
  common.right = std::max(common.left, common.right);
  common.top = std::max(common.bottom, common.top);
  return common;
}

/// The smallest box that holds the cells of both; an empty one holds none.
inline CellBox unite(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.bottom, b.bottom), std::max(a.right, b.right),
          std::max(a.top, b.top)};
}

}  // namespace gridmerge::internal
