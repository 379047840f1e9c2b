// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/image_similarity.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "gridmerge/grid/resample.hpp"
#include "similarity/distance_kernels.hpp"
#include "similarity/lattice_frames.hpp"
#include "similarity/nearest_cells.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr std::uint8_t kUnknown = static_cast<std::uint8_t>(Cell::unknown);
constexpr std::uint8_t kFree = static_cast<std::uint8_t>(Cell::free);
constexpr std::uint8_t kOccupied = static_cast<std::uint8_t>(Cell::occupied);

int round_up(int value, int multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

}  // namespace

/// What does not change from pose to pose. Boxes and rows are in cells of the fixed map's known rectangle.
struct SimilarityMeter::Maps {
  /// A value's cells in the fixed map.
  struct FixedClass {
    std::int64_t count = 0;
    DistanceMap distance;
  };

  Maps(const OccupancyGrid& fixed_map, const OccupancyGrid& moving_map)
      : fixed(crop_to_known(fixed_map)), moving(crop_to_known(moving_map)) {
    fixed.probability = {};
    moving.probability = {};
    // A turned map's box is at most sqrt(2) times as large, and need only touch the other map.
    const double moving_sides = (moving.width + moving.height) * moving.resolution / fixed.resolution;
    if (fixed.width + fixed.height + 1.5 * moving_sides > kMaxDistanceMapSides) {
      throw std::invalid_argument("the maps are too large for the image similarity: it takes about " +
                                  std::to_string(kMaxDistanceMapSides / 5) + " cells per side");
    }
    const Point2 corner = inverse(fixed.origin) * Point2{fixed_map.origin.x, fixed_map.origin.y};
    whole.left = static_cast<int>(std::lround(corner.x / fixed.resolution));
    whole.bottom = static_cast<int>(std::lround(corner.y / fixed.resolution));
    whole.right = whole.left + fixed_map.width;
    whole.top = whole.bottom + fixed_map.height;
    const auto* cells = reinterpret_cast<const std::uint8_t*>(fixed.cells.data());
    for (const std::uint8_t value : {kFree, kOccupied}) {
      FixedClass& of_value = classes[value - kFree];
      of_value.count = count_where(cells, fixed.cells.size(), value);
      of_value.distance = make_distance_map(fixed, static_cast<Cell>(value));
    }
    ramp.resize(static_cast<std::size_t>(moving_sides) + 3);  // no turned box is wider
    std::iota(ramp.begin(), ramp.end(), std::uint16_t{0});
    const int strips = round_up(fixed.height, kStripRows) / kStripRows;
    strip_cells.assign(static_cast<std::size_t>(strips) * fixed.width * kStripRows, 0);
    for (int row = 0; row < fixed.height; ++row) {
      std::uint8_t* strip =
          strip_cells.data() + static_cast<std::size_t>(row / kStripRows) * fixed.width * kStripRows;
      for (int column = 0; column < fixed.width; ++column) {
        strip[static_cast<std::size_t>(column) * kStripRows + row % kStripRows] =
            static_cast<std::uint8_t>(fixed.at(column, row));
      }
    }
  }

  const FixedClass& of(std::uint8_t value) const { return classes[value - kFree]; }

  /// Cells of the whole fixed map.
  std::int64_t size() const { return std::int64_t{whole.width()} * whole.height(); }

  CellBox whole;         // the whole fixed map
  OccupancyGrid fixed;   // the known rectangle
  OccupancyGrid moving;  // the known rectangle
  std::array<FixedClass, 2> classes;
  std::vector<std::uint8_t> strip_cells;  // the fixed map's cells in strips of kStripRows rows
  std::vector<std::uint16_t> ramp;        // 0, 1, 2, ...
};

/// Memory that is kept from pose to pose.
struct SimilarityMeter::Scratch {
  CellsOnLattice moving;
  std::vector<std::uint16_t> rows;   // distances to the moving map's cells of one value, along columns
  std::vector<std::uint16_t> strip;  // of kStripRows rows, along rows as well
};

namespace {

/// The sum over the fixed map's cells of one value of the distance to the nearest such cell of the moving
/// map, which must have one. Distances are made where the fixed map is, and no farther: what lies below,
/// above, left or right of it counts by the one row or column that the passes carry in.
class FixedToMoving {
 public:
  FixedToMoving(const CellsOnLattice& moving, int fixed_width, int fixed_height,
                std::vector<std::uint16_t>& rows, std::vector<std::uint16_t>& strip)
      : moving_(moving),
        fixed_width_(fixed_width),
        fixed_rows_(round_up(fixed_height, kStripRows)),
        left_(std::min(0, moving.box.left)),
        right_(std::max(fixed_width, moving.box.right)),
        rows_(rows),
        strip_(strip) {}

  std::int64_t sum(const std::vector<std::uint8_t>& strip_cells, std::uint8_t value) {
    pass_up(value);
    std::uint64_t sum = 0;
    const std::size_t strip_size = static_cast<std::size_t>(fixed_width_) * kStripRows;
    for (int row = fixed_rows_ - kStripRows; row >= 0; row -= kStripRows) {
      pass_down(row);
      make_strip(row);
      sweep_right(strip_.data(), fixed_width_ - left_);
      sum += sweep_left_and_sum(strip_.data(), right_ - left_, -left_, fixed_width_,
                                strip_cells.data() + static_cast<std::size_t>(row / kStripRows) * strip_size,
                                value);
    }
    return static_cast<std::int64_t>(sum);
  }

 private:
  std::uint16_t* row_at(int row) { return rows_.data() + static_cast<std::size_t>(row) * moving_.stride; }

  /// Distances to what lies below in each of the moving map's columns, for the fixed map's rows. The row
  /// beyond them is left with the distances to what lies above.
  void pass_up(std::uint8_t value) {
    const CellBox& box = moving_.box;
    const std::size_t columns = moving_.stride;
    rows_.resize(columns * static_cast<std::size_t>(fixed_rows_ + 1));
    std::uint16_t* const carried = row_at(fixed_rows_);
    const auto carry = [&](int row) { pass_row(moving_.row(row), columns, value, carried, carried); };

    std::fill_n(carried, columns, kFarDistance);
    for (int row = box.bottom; row < std::min(0, box.top); ++row) carry(row);
    if (box.top < 0) pass_rows_without(-box.top, columns, carried, carried);
    for (int row = 0; row < fixed_rows_; ++row) {
      const std::uint16_t* const below = row == 0 ? carried : row_at(row - 1);
      if (row >= box.bottom && row < box.top) {
        pass_row(moving_.row(row), columns, value, below, row_at(row));
      } else {
        pass_rows_without(1, columns, below, row_at(row));
      }
    }

    std::fill_n(carried, columns, kFarDistance);
    for (int row = box.top - 1; row >= std::max(fixed_rows_, box.bottom); --row) carry(row);
    if (box.bottom > fixed_rows_) pass_rows_without(box.bottom - fixed_rows_, columns, carried, carried);
  }

  /// Distances either way along the columns, for kStripRows rows; those above are done.
  void pass_down(int first) {
    for (int row = first + kStripRows - 1; row >= first; --row)
      relax_row(row_at(row), row_at(row + 1), moving_.stride);
  }

  /// Lays kStripRows rows side by side, in the columns of both maps.
  void make_strip(int first) {
    const std::size_t before = static_cast<std::size_t>(moving_.box.left - left_) * kStripRows;
    const std::size_t own = moving_.stride * kStripRows;
    strip_.resize(std::max(static_cast<std::size_t>(right_ - left_) * kStripRows, before + own));
    std::fill_n(strip_.begin(), before, kFarDistance);
    std::fill(strip_.begin() + static_cast<std::ptrdiff_t>(before + own), strip_.end(), kFarDistance);
    rows_to_strip(row_at(first), moving_.stride, static_cast<int>(moving_.stride), strip_.data() + before);
  }

  const CellsOnLattice& moving_;
  int fixed_width_;
  int fixed_rows_;  // whole strips
  int left_;        // of both maps' columns
  int right_;
  std::vector<std::uint16_t>& rows_;
  std::vector<std::uint16_t>& strip_;
};

/// The sum over the moving map's cells of one value of the distance to the nearest such cell of the fixed
/// map, which must have one. Beyond the fixed map's rectangle the distance is that of the nearest cell
/// inside, and the way there: exact for Manhattan distances, because each coordinate has to be crossed
/// anyway. `ramp` holds 0, 1, 2, ...
DirectedDistance measure_moving_to_fixed(const CellsOnLattice& moving, const DistanceMap& distance,
                                         std::uint8_t value, const std::vector<std::uint16_t>& ramp) {
  const int width = distance.width;
  DirectedDistance result;
  for (int row = moving.box.bottom; row < moving.box.top; ++row) {
    const CellsOnLattice::Span& span = moving.span(row);
    const int inside_row = std::clamp(row, 0, distance.height - 1);
    const std::uint16_t* const distances =
        distance.distances.data() + static_cast<std::size_t>(inside_row) * static_cast<std::size_t>(width);
    const auto count_cells = [&](int from, int to) {
      return count_where(moving.at(from, row), static_cast<std::size_t>(to - from), value);
    };
    const auto sum_cells = [&](int from, int to, const std::uint16_t* of_first) {
      return static_cast<std::int64_t>(
          sum_where(of_first, moving.at(from, row), static_cast<std::size_t>(to - from), value));
    };
    const int left = std::clamp(0, span.left, span.right);  // of the columns that both have
    const int right = std::clamp(width, left, span.right);
    if (left < right) result.sum += sum_cells(left, right, distances + left);
    if (span.left < left) {  // distances[0] - column
      result.sum +=
          count_cells(span.left, left) * (distances[0] - span.left) - sum_cells(span.left, left, ramp.data());
    }
    if (right < span.right) {  // distances[width - 1] + column - (width - 1)
      result.sum += count_cells(right, span.right) * (distances[width - 1] + right - (width - 1)) +
                    sum_cells(right, span.right, ramp.data());
    }
    const std::int64_t count = count_cells(span.left, span.right);
    result.sum += count * std::abs(row - inside_row);
    result.count += count;
  }
  return result;
}

/// How many of the lattice's cells in `box` the moving map knows.
std::int64_t count_known(const CellsOnLattice& moving, const CellBox& box) {
  std::int64_t known = 0;
  for (int row = std::max(box.bottom, moving.box.bottom); row < std::min(box.top, moving.box.top); ++row) {
    const int left = std::max(box.left, moving.span(row).left);
    const int right = std::min(box.right, moving.span(row).right);
    if (left >= right) continue;
    const auto count = static_cast<std::size_t>(right - left);
    known += static_cast<std::int64_t>(count) - count_where(moving.at(left, row), count, kUnknown);
  }
  return known;
}

CommonCells compare_cells(const CellsOnLattice& moving, const OccupancyGrid& fixed) {
  CommonCells common;
  for (int row = std::max(0, moving.box.bottom); row < std::min(fixed.height, moving.box.top); ++row) {
    const int left = std::max(0, moving.span(row).left);
    const int right = std::min(fixed.width, moving.span(row).right);
    if (left >= right) continue;
    const auto* fixed_cells =
        reinterpret_cast<const std::uint8_t*>(fixed.cells.data()) + fixed.index(left, row);
    const CommonCells of_row =
        count_common(fixed_cells, moving.at(left, row), static_cast<std::size_t>(right - left));
    common.equal += of_row.equal;
    common.different += of_row.different;
  }
  return common;
}

/// Whether distances across both maps stay within 16 bits.
bool fits(const OccupancyGrid& fixed, const CellBox& box) {
  return std::max(fixed.width, box.right) - std::min(0, box.left) + std::max(fixed.height, box.top) -
             std::min(0, box.bottom) <=
         kMaxDistanceMapSides;
}

}  // namespace

SimilarityMeter::SimilarityMeter(const OccupancyGrid& fixed, const OccupancyGrid& moving)
    : scratch_(std::make_unique<Scratch>()) {
  validate(fixed);
  validate(moving);
  check_resolutions(fixed, moving);
  maps_ = std::make_shared<Maps>(fixed, moving);
}

SimilarityMeter::SimilarityMeter(const SimilarityMeter& other)
    : maps_(other.maps_), scratch_(std::make_unique<Scratch>()) {}

SimilarityMeter::~SimilarityMeter() = default;

bool SimilarityMeter::can_measure(const SE2& T_fixed_moving) const {
  if (!is_finite(T_fixed_moving)) return false;
  const SE2 T_fixedgrid_movinggrid = between_grids(maps_->fixed, maps_->moving, T_fixed_moving);
  if (!is_within_lattice(maps_->moving, T_fixedgrid_movinggrid, maps_->fixed.resolution)) return false;
  return fits(maps_->fixed, box_on_lattice(maps_->moving, T_fixedgrid_movinggrid, maps_->fixed.resolution));
}

void SimilarityMeter::draw(const SE2& T_fixed_moving) {
  check_finite(T_fixed_moving);
  const Maps& maps = *maps_;
  const SE2 T_fixedgrid_movinggrid = between_grids(maps.fixed, maps.moving, T_fixed_moving);
  const double resolution = maps.fixed.resolution;
  const CellBox box = box_on_lattice(maps.moving, T_fixedgrid_movinggrid, resolution);
  if (!fits(maps.fixed, box)) throw std::invalid_argument("the transform puts the maps too far apart");
  draw_nearest_cells(maps.moving, T_fixedgrid_movinggrid, resolution, box, kStripRows, scratch_->moving);
}

ImageSimilarity SimilarityMeter::operator()(const SE2& T_fixed_moving) {
  draw(T_fixed_moving);
  const Maps& maps = *maps_;
  const CellsOnLattice& moving = scratch_->moving;
  ImageSimilarity result;
  const CommonCells common = compare_cells(moving, maps.fixed);
  result.agreement = common.equal;
  result.disagreement = common.different;
  const std::int64_t known = maps.of(kFree).count + maps.of(kOccupied).count +
                             count_known(moving, maps.whole) - common.equal - common.different;
  result.omega = common.equal + maps.size() - known;

  FixedToMoving fixed_to_moving(moving, maps.fixed.width, maps.fixed.height, scratch_->rows, scratch_->strip);
  const auto measure = [&](std::uint8_t value, DirectedDistance& from_fixed, DirectedDistance& from_moving) {
    const Maps::FixedClass& fixed_class = maps.of(value);
    if (fixed_class.count == 0) return;
    const DirectedDistance distance = measure_moving_to_fixed(moving, fixed_class.distance, value, maps.ramp);
    if (!distance.defined()) return;
    from_moving = distance;
    from_fixed = {fixed_to_moving.sum(maps.strip_cells, value), fixed_class.count};
  };
  measure(kFree, result.fixed_to_moving_free, result.moving_to_fixed_free);
  measure(kOccupied, result.fixed_to_moving_occupied, result.moving_to_fixed_occupied);
  return result;
}

CommonClasses SimilarityMeter::count_common(const SE2& T_fixed_moving) {
  draw(T_fixed_moving);
  const OccupancyGrid& fixed = maps_->fixed;
  const CellsOnLattice& moving = scratch_->moving;
  CommonClasses common;
  const CellBox box = intersect(moving.box, all_cells(fixed));
  for (int row = box.bottom; row < box.top; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      const auto ours = static_cast<std::uint8_t>(fixed.at(column, row));
      const std::uint8_t theirs = *moving.at(column, row);
      if (ours == kUnknown || theirs == kUnknown) continue;
      ++(ours != theirs      ? common.contradicting
         : ours == kOccupied ? common.occupied_occupied
                             : common.free_free);
    }
  }
  return common;
}

bool is_better(const ImageSimilarity& a, const ImageSimilarity& b, double c_lock) {
  if (a.undefined_terms() != b.undefined_terms()) return a.undefined_terms() < b.undefined_terms();
  return a.delta(c_lock) < b.delta(c_lock);
}

ImageSimilarity measure_similarity(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                   const SE2& T_fixed_moving) {
  return SimilarityMeter(fixed, moving)(T_fixed_moving);
}

std::int64_t count_equal_cells(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                               const SE2& T_fixed_moving) {
  const std::array<PlacedMap, 2> maps{{{&fixed, {}}, {&moving, T_fixed_moving}}};
  return count_equal_cells(fixed, maps);
}

}  // namespace gridmerge
