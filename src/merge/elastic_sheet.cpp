// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_sheet.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gridmerge::internal {

namespace {

/// A squared linear form of shifts, as entries of a matrix.
class EnergyMatrix {
 public:
  struct Term {
    std::size_t unknown;
    double factor;
  };

  template <std::size_t N>
  void add(double weight, const std::array<Term, N>& form) {
    for (const Term& a : form) {
      for (const Term& b : form)
        entries_.emplace_back(static_cast<int>(a.unknown), static_cast<int>(b.unknown),
                              weight * a.factor * b.factor);
    }
  }

  Eigen::SparseMatrix<double> matrix(std::size_t unknowns) const {
    Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(unknowns),
                                       static_cast<Eigen::Index>(unknowns));
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
};

int points_along(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9))) + 3;
}

}  // namespace

ElasticSheet::ElasticSheet(const OccupancyGrid& map, double spacing, const SE2& T_group_map)
    : spacing_(spacing),
      columns_(points_along(map.width * map.resolution, spacing)),
      rows_(points_along(map.height * map.resolution, spacing)),
      shifts_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
      T_group_map_(T_group_map) {
  // In the middle of the map.
  const double beyond_x = 0.5 * ((columns_ - 3) * spacing - map.width * map.resolution);
  const double beyond_y = 0.5 * ((rows_ - 3) * spacing - map.height * map.resolution);
  T_map_lattice_ = map.origin * SE2{-beyond_x, -beyond_y, 0.0};
}

SplineWeights ElasticSheet::weights_at(const Point2& in_map) const {
  const Point2 q = inverse(T_map_lattice_) * in_map;
  return spline_weights({q.x / spacing_, q.y / spacing_}, columns_, rows_);
}

Point2 ElasticSheet::to_group(const Point2& in_map) const {
  const Point2 q = inverse(T_map_lattice_) * in_map;
  const Point2 shift = interpolated(spline_weights({q.x / spacing_, q.y / spacing_}, columns_, rows_),
                                    shifts_.data(), columns_);
  return T_group_map_ * (T_map_lattice_ * Point2{q.x + shift.x, q.y + shift.y});
}

Eigen::SparseMatrix<double> ElasticSheet::energy(const Stiffness& stiffness) const {
  EnergyMatrix energy;
  const auto unknown = [&](int column, int row, int axis) {
    return 2 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(column)) +
           static_cast<std::size_t>(axis);
  };
  // Second derivatives are second differences by the squared spacing; each stands for one squared spacing.
  const double bending = stiffness.bending / (spacing_ * spacing_);
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      for (const int axis : {0, 1}) {
        const auto at = [&](int right, int up) { return unknown(column + right, row + up, axis); };
        if (column + 2 < columns_)
          energy.add<3>(bending, {{{at(0, 0), 1.0}, {at(1, 0), -2.0}, {at(2, 0), 1.0}}});
        if (row + 2 < rows_) energy.add<3>(bending, {{{at(0, 0), 1.0}, {at(0, 1), -2.0}, {at(0, 2), 1.0}}});
        if (column + 1 < columns_ && row + 1 < rows_)
          energy.add<4>(2.0 * bending,
                        {{{at(0, 0), 1.0}, {at(1, 0), -1.0}, {at(0, 1), -1.0}, {at(1, 1), 1.0}}});
      }
      if (column + 1 == columns_ || row + 1 == rows_) continue;
      const auto at = [&](int right, int up, int axis) { return unknown(column + right, row + up, axis); };
      const auto derivative = [&](int axis, int along) {  // the mean one of the square's two sides
        const double u = along == 0 ? 0.5 : -0.5;
        return std::array<EnergyMatrix::Term, 4>{
            {{at(0, 0, axis), -0.5}, {at(1, 0, axis), u}, {at(0, 1, axis), -u}, {at(1, 1, axis), 0.5}}};
      };
      energy.add(stiffness.strain, derivative(0, 0));
      energy.add(stiffness.strain, derivative(1, 1));
      std::array<EnergyMatrix::Term, 8> shear;
      const auto by_y = derivative(0, 1), by_x = derivative(1, 0);
      std::copy(by_y.begin(), by_y.end(), shear.begin());
      std::copy(by_x.begin(), by_x.end(), shear.begin() + 4);
      energy.add(0.5 * stiffness.strain, shear);
    }
  }
  return energy.matrix(2 * size());
}

void ElasticSheet::step_to(const std::vector<Point2>& shifts, double most_strain) {
  constexpr int kMostHalvings = 20;
  if (!std::all_of(shifts.begin(), shifts.end(),
                   [](const Point2& shift) { return std::isfinite(shift.x) && std::isfinite(shift.y); }))
    return;
  std::vector<Point2> next = shifts;
  for (int halving = 0; strain_bound(next, columns_, rows_, spacing_) > most_strain; ++halving) {
    if (halving == kMostHalvings) return;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = {0.5 * (next[i].x + shifts_[i].x), 0.5 * (next[i].y + shifts_[i].y)};
  }
  shifts_ = std::move(next);
}

void ElasticSheet::move(const SE2& T_group_map, const Affine& change) {
  const SE2 T_group_lattice = T_group_map_ * T_map_lattice_;
  const SE2 T_lattice_group = inverse(T_group_map * T_map_lattice_);
  // A spline whose points are an affine function of their places (i - 1) * spacing is that function.
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      Point2& shift = shifts_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                              static_cast<std::size_t>(column)];
      const Point2 place{(column - 1) * spacing_, (row - 1) * spacing_};
      const Point2 now =
          T_lattice_group * (change * (T_group_lattice * Point2{place.x + shift.x, place.y + shift.y}));
      shift = {now.x - place.x, now.y - place.y};
    }
  }
  T_group_map_ = T_group_map;
}

Deformation ElasticSheet::deformation() const {
  std::vector<Point2> shifts = shifts_;
  const double bound = strain_bound(shifts, columns_, rows_, spacing_);
  if (bound > Deformation::kMostStrain) {
    const double factor = (1.0 - 1e-9) * Deformation::kMostStrain / bound;
    for (Point2& shift : shifts) shift = {factor * shift.x, factor * shift.y};
  }
  return {T_map_lattice_, spacing_, columns_, rows_, std::move(shifts)};
}

}  // namespace gridmerge::internal
