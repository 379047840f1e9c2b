// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "grid/spline.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// How hard it is to bend a map.
struct Stiffness {
  double bending = 0.0;  ///< of the integral of the shift's squared second derivatives [1]
  double strain =
      0.0;  ///< of the integral of its squared strain: the symmetric part of its derivative [1/m^2]
};

/// A map that is being bent: the lattice of a Deformation, whose shifts change, and the map's pose.
class ElasticSheet {
 public:
  /// Over the cells of `map`, with shifts `spacing` metres apart.
  ElasticSheet(const OccupancyGrid& map, double spacing, const SE2& T_group_map);

  std::size_t size() const { return shifts_.size(); }
  const std::vector<Point2>& shifts() const { return shifts_; }
  const SE2& T_group_map() const { return T_group_map_; }
  /// From the directions of the shifts to those of the group.
  double direction() const { return T_group_map_.theta + T_map_lattice_.theta; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double spacing() const { return spacing_; }  ///< [m]

  /// On which shifts a point of the map frame depends.
  SplineWeights weights_at(const Point2& in_map) const;
  /// Where a point of the map frame lies in the group's.
  Point2 to_group(const Point2& in_map) const;

  /// The matrix of the energy of a bent sheet, a quadratic form of the shifts (x of the first, y of the
  /// first,
  /// ...). A linear shift has no bending, a rigid one no strain but of its second order.
  Eigen::SparseMatrix<double> energy(const Stiffness& stiffness) const;

  /// Takes the step from the present shifts to these, or as much of it as keeps the strain bound at most
  /// `most_strain`.
  void step_to(const std::vector<Point2>& shifts, double most_strain);

  /// Another pose, with the shifts changed so that `change`, of the group's frame, is done to where each
  /// point lies.
  void move(const SE2& T_group_map, const Affine& change);

  /// The lattice as it is; shifts whose strain bound is too large are made smaller.
  Deformation deformation() const;

 private:
  SE2 T_map_lattice_;
  double spacing_;
  int columns_;
  int rows_;
  std::vector<Point2> shifts_;
  SE2 T_group_map_;
};

}  // namespace gridmerge::internal
