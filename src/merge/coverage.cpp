// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/coverage.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

namespace {

constexpr double kCellsAlongSide = 100.0;
constexpr std::size_t kMostCentres = 500;

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
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      if (known_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(column)] != 0)
        centres.push_back(grid.origin * Point2{(column + 0.5) * cell_, (row + 0.5) * cell_});
    }
  }
  const std::size_t drawn = std::min(centres.size(), kMostCentres);
  for (std::size_t i = 0; i < drawn; ++i) centres_.push_back(centres[i * centres.size() / drawn]);
}

MapExtent Coverage::extent() const {
  return extent_;
}

bool Coverage::knows(const Point2& at) const {
  const Point2 p = T_grid_map_ * at;
  const double x = p.x / cell_, y = p.y / cell_;
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return false;
  return known_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(x)] != 0;
}

std::vector<Point2> Coverage::in_common(const Coverage& other, const SE2& T_this_other) const {
  std::vector<Point2> common;
  if (other.area_ <= area_) {
    for (const Point2& centre : other.centres_) {
      const Point2 here = T_this_other * centre;
      if (knows(here)) common.push_back(here);
    }
  } else {
    const SE2 T_other_this = inverse(T_this_other);
    for (const Point2& centre : centres_) {
      if (other.knows(T_other_this * centre)) common.push_back(centre);
    }
  }
  return common;
}

double Coverage::share_in_common(const Coverage& other, const SE2& T_this_other) const {
  const std::size_t all = other.area_ <= area_ ? other.centres_.size() : centres_.size();
  return all == 0 ? 0.0
                  : static_cast<double>(in_common(other, T_this_other).size()) / static_cast<double>(all);
}

}  // namespace gridmerge
