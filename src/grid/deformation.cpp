// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/deformation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "grid/seen_from.hpp"
#include "grid/spline.hpp"

namespace gridmerge {

using namespace internal;

namespace internal {

double strain_bound(const std::vector<Point2>& shifts, int columns, int rows, double spacing) {
  double along_x = 0.0, along_y = 0.0;
  const auto at = [&](int column, int row) {
    return shifts[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(column)];
  };
  const auto apart = [](const Point2& a, const Point2& b) { return std::hypot(a.x - b.x, a.y - b.y); };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (column + 1 < columns) along_x = std::max(along_x, apart(at(column + 1, row), at(column, row)));
      if (row + 1 < rows) along_y = std::max(along_y, apart(at(column, row + 1), at(column, row)));
    }
  }
  return std::hypot(along_x, along_y) / spacing;
}

}  // namespace internal

Deformation::Deformation(const SE2& T_map_lattice, double spacing, int columns, int rows,
                         std::vector<Point2> shifts)
    : T_map_lattice_(T_map_lattice),
      spacing_(spacing),
      columns_(columns),
      rows_(rows),
      shifts_(std::move(shifts)) {
  const auto require = [](bool holds, const char* otherwise) {
    if (!holds) throw std::invalid_argument(otherwise);
  };
  const auto is_length = [](int points) { return points >= 4 && points <= kMostPoints; };
  require(is_length(columns) && is_length(rows), "a lattice must have 4 to 4096 columns and rows");
  require(shifts_.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
          "a lattice must have columns x rows shifts");
  require(std::isfinite(spacing) && spacing > 0.0, "a lattice's spacing must be a positive number of metres");
  require(is_finite(T_map_lattice), "a lattice's frame must be finite");
  for (const Point2& shift : shifts_) {
    require(std::isfinite(shift.x) && std::isfinite(shift.y), "a lattice's shifts must be finite");
  }
  strain_bound_ = internal::strain_bound(shifts_, columns, rows, spacing);
  require(strain_bound_ <= kMostStrain,
          "neighbouring shifts of a lattice must not differ so much that it may fold");
}

Point2 Deformation::shift_at(const Point2& in_lattice) const {
  return interpolated(spline_weights({in_lattice.x / spacing_, in_lattice.y / spacing_}, columns_, rows_),
                      shifts_.data(), columns_);
}

Point2 Deformation::bend(const Point2& straight) const {
  if (is_identity()) return straight;
  const Point2 q = inverse(T_map_lattice_) * straight, shift = shift_at(q);
  return T_map_lattice_ * Point2{q.x + shift.x, q.y + shift.y};
}

Point2 Deformation::straighten(const Point2& bent) const {
  if (is_identity()) return bent;
  constexpr int kMostSteps = 64;  // each halves the error at least
  const Point2 target = inverse(T_map_lattice_) * bent;
  const double close = 1e-10 * spacing_;
  Point2 q = target;
  for (int step = 0; step < kMostSteps; ++step) {
    const Point2 shift = shift_at(q), next{target.x - shift.x, target.y - shift.y};
    const bool is_close = std::abs(next.x - q.x) + std::abs(next.y - q.y) <= close;
    q = next;
    if (is_close) break;
  }
  return T_map_lattice_ * q;
}

std::optional<Affine> Deformation::affine() const {
  if (is_identity()) return Affine{};
  // Of the lattice: from one corner to the two next to it.
  const double tolerance = 1e-9 * spacing_;
  const Point2 corner = shifts_.front(), right = shifts_[static_cast<std::size_t>(columns_ - 1)],
               top = shifts_[shifts_.size() - static_cast<std::size_t>(columns_)];
  const double along_x = columns_ - 1, along_y = rows_ - 1;
  const Point2 by_column{(right.x - corner.x) / along_x, (right.y - corner.y) / along_x};
  const Point2 by_row{(top.x - corner.x) / along_y, (top.y - corner.y) / along_y};
  std::size_t i = 0;
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column, ++i) {
      const Point2 expected{corner.x + column * by_column.x + row * by_row.x,
                            corner.y + column * by_column.y + row * by_row.y};
      if (std::abs(shifts_[i].x - expected.x) > tolerance || std::abs(shifts_[i].y - expected.y) > tolerance)
        return std::nullopt;
    }
  }
  // The first point stands one spacing before the origin on both axes, and a spline whose points are an
  // affine function of their places is that function.
  const Affine in_lattice{1.0 + by_column.x / spacing_,
                          by_row.x / spacing_,
                          by_column.y / spacing_,
                          1.0 + by_row.y / spacing_,
                          {corner.x + by_column.x + by_row.x, corner.y + by_column.y + by_row.y}};
  // The turn apart from where the lattice stands: that may be far away.
  const SE2 turn{0.0, 0.0, T_map_lattice_.theta}, back = inverse(turn);
  const Affine linear{in_lattice.xx, in_lattice.xy, in_lattice.yx, in_lattice.yy, {}};
  const Point2 x = turn * (linear * (back * Point2{1.0, 0.0})),
               y = turn * (linear * (back * Point2{0.0, 1.0}));
  const Point2 origin = T_map_lattice_ * (in_lattice * (inverse(T_map_lattice_) * Point2{}));
  return Affine{x.x, y.x, x.y, y.y, origin};
}

MapTransform Deformation::kind() const {
  if (is_identity()) return MapTransform::rigid;
  const std::optional<Affine> as_affine = affine();
  if (!as_affine) return MapTransform::elastic;
  return as_affine->is_similarity() ? MapTransform::similarity : MapTransform::affine;
}

Deformation internal::seen_from(const SE2& T_a_b, const Deformation& deformation) {
  if (deformation.is_identity()) return deformation;
  return {T_a_b * deformation.T_map_lattice(), deformation.spacing(), deformation.columns(),
          deformation.rows(), deformation.shifts()};
}

}  // namespace gridmerge
