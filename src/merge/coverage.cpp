// SPDX-License-Identifier: Apache-2.0
#include "merge/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kCellsAlongSide = 100.0;
constexpr std::size_t kMaxCentres = 200;

}  // namespace

Coverage::Coverage(const OccupancyGrid& grid)
    : T_grid_map_(inverse(grid.origin)),
      cell_(std::max(1.0, std::ceil(std::max(grid.width, grid.height) / kCellsAlongSide)) * grid.resolution),
      width_(static_cast<int>(grid.width * grid.resolution / cell_) + 1),
      height_(static_cast<int>(grid.height * grid.resolution / cell_) + 1),
      known_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0) {
  std::vector<int> counts(known_.size(), 0);
  double count = 0.0, sum_x = 0.0, sum_y = 0.0, squares = 0.0;  // [cells, grid frame]
  int left = grid.width, right = -1, bottom = grid.height, top = -1;
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) == Cell::unknown) continue;
      const int x = static_cast<int>((column + 0.5) * grid.resolution / cell_);
      const int y = static_cast<int>((row + 0.5) * grid.resolution / cell_);
      ++counts[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
      count += 1.0;
      sum_x += column + 0.5;
      sum_y += row + 0.5;
      squares += (column + 0.5) * (column + 0.5) + (row + 0.5) * (row + 0.5);
      left = std::min(left, column);
      right = std::max(right, column);
      bottom = std::min(bottom, row);
      top = std::max(top, row);
    }
  }
  if (count == 0.0) return;
  const double half = 0.5 * std::pow(cell_ / grid.resolution, 2);
  std::transform(counts.begin(), counts.end(), known_.begin(),
                 [&](int cells) { return static_cast<std::uint8_t>(cells >= half ? 1 : 0); });
  const double x = sum_x / count, y = sum_y / count;
  extent_.centre = grid.origin * Point2{x * grid.resolution, y * grid.resolution};
  extent_.radius = grid.resolution * std::sqrt(std::max(0.0, squares / count - x * x - y * y));
  extent_.side = grid.resolution * (std::max(right - left, top - bottom) + 1);
  area_ = count * grid.resolution * grid.resolution;

  std::vector<Point2> centres;
  const ManyPointsTransform T_map_grid(grid.origin);
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      if (known_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(column)] != 0)
        centres.push_back(T_map_grid * Point2{(column + 0.5) * cell_, (row + 0.5) * cell_});
    }
  }
  for (const Point2& centre : centres)
    reach_ = std::max(reach_, std::hypot(centre.x - extent_.centre.x, centre.y - extent_.centre.y));
  reach_ += 0.5 * std::numbers::sqrt2 * cell_;  // to the corners of the cells
  const std::size_t drawn = std::min(centres.size(), kMaxCentres);
  for (std::size_t i = 0; i < drawn; ++i) centres_.push_back(centres[i * centres.size() / drawn]);
}

MapExtent Coverage::extent() const {
  return extent_;
}

template <typename Visit>
void Coverage::visit_common(const Coverage& other, const ManyPointsTransform& T_this_other,
                            Visit visit) const {
  const bool other_is_smaller = other.area_ <= area_;
  const Coverage& smaller = other_is_smaller ? other : *this;
  const Coverage& larger = other_is_smaller ? *this : other;
  const Point2 there = T_this_other * other.extent_.centre;
  if (std::hypot(there.x - extent_.centre.x, there.y - extent_.centre.y) > reach_ + other.reach_) return;
  const ManyPointsTransform to_grid =
      larger.T_grid_map_ * (other_is_smaller ? T_this_other : T_this_other.inverse());
  const double cells_per_metre = 1.0 / larger.cell_;
  for (const Point2& centre : smaller.centres_) {
    const Point2 p = to_grid * centre;
    const double x = p.x * cells_per_metre, y = p.y * cells_per_metre;
    if (!(x >= 0.0 && y >= 0.0 && x < larger.width_ && y < larger.height_)) continue;
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(larger.width_) + static_cast<std::size_t>(x);
    if (larger.known_[at] != 0) visit(centre, other_is_smaller);
  }
}

double Coverage::share_in_common(const Coverage& other, const ManyPointsTransform& T_this_other) const {
  std::size_t common = 0;
  visit_common(other, T_this_other, [&](const Point2&, bool) { ++common; });
  const std::size_t all = (other.area_ <= area_ ? other : *this).centres_.size();
  return all == 0 ? 0.0 : static_cast<double>(common) / static_cast<double>(all);
}

std::vector<Point2> Coverage::places_in_common(const Coverage& other, const ManyPointsTransform& T_this_other,
                                               const ManyPointsTransform& T_frame_this) const {
  const ManyPointsTransform T_frame_other = T_frame_this * T_this_other;
  std::vector<Point2> places;
  visit_common(other, T_this_other, [&](const Point2& centre, bool of_other) {
    places.push_back((of_other ? T_frame_other : T_frame_this) * centre);
  });
  return places;
}

}  // namespace gridmerge::internal
