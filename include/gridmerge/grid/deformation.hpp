// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// What may be done to a map so that it fits others.
enum class MapTransform {
  rigid,       ///< it is turned and shifted
  similarity,  ///< it has a scale of its own, too
  affine,      ///< it has scales along two axes, and shear
  elastic,     ///< it is bent
};

/// A transform: the one place where its name and meaning stand.
struct MapTransformName {
  MapTransform transform;  ///< which one
  const char* name;        ///< as the command line, Python and outputs spell it
  const char* meaning;     ///< in a few words
};

/// All of them, each with more freedom than the one before it.
GRIDMERGE_EXPORT std::span<const MapTransformName> map_transforms();

/// "rigid", ...
GRIDMERGE_EXPORT const char* name_of(MapTransform transform);

/// The transform of that name; none if there is none.
GRIDMERGE_EXPORT std::optional<MapTransform> map_transform(std::string_view name);

/// An affine function of the plane: p goes to (xx * p.x + xy * p.y + shift.x, yx * p.x + yy * p.y + shift.y).
struct Affine {
  double xx = 1.0;  ///< of x in x
  double xy = 0.0;  ///< of y in x
  double yx = 0.0;  ///< of x in y
  double yy = 1.0;  ///< of y in y
  Point2 shift;     ///< where the origin goes [m]

  /// Where a point goes [m].
  Point2 operator*(const Point2& p) const {
    return {xx * p.x + xy * p.y + shift.x, yx * p.x + yy * p.y + shift.y};
  }
  /// By how much it enlarges areas; negative if it mirrors.
  double determinant() const { return xx * yy - xy * yx; }
  /// By how much it enlarges lengths, in the geometric mean over its two axes: the root of the determinant,
  /// which must not be negative.
  double scale() const { return std::sqrt(determinant()); }
  /// Whether it turns, shifts and enlarges alone: no entry is farther than `tolerance` from such a
  /// function's.
  bool is_similarity(double tolerance = 1e-9) const {
    return std::abs(xx - yy) <= 2.0 * tolerance && std::abs(xy + yx) <= 2.0 * tolerance;
  }

  /// Whether both are the same, to the bit.
  friend bool operator==(const Affine&, const Affine&) = default;
};

/// A smooth deformation of a map that neither tears nor folds it: every point is shifted, and no two points
/// become one.
///
/// Shifts stand at the points of a square lattice, and between them a uniform cubic B-spline interpolates.
/// With q = T_lattice_map * p for a point p of the map frame, x = q.x / spacing clamped to
/// [0, columns - 3], i = min(floor(x), columns - 4), u = x - i, and y, j, v likewise of the rows:
///
///     bend(p) = T_map_lattice * (q + sum over a, b in 0..3 of B_a(u) B_b(v) shift(i + a, j + b))
///
/// with B_0(t) = (1 - t)^3 / 6, B_1(t) = (3 t^3 - 6 t^2 + 4) / 6, B_2(t) = (-3 t^3 + 3 t^2 + 3 t + 1) / 6 and
/// B_3(t) = t^3 / 6. Beyond the lattice the shift of its rim goes on. The derivatives of the shift are
/// weighted means of the differences of neighbouring shifts, so these bound them everywhere: strain_bound().
/// Up to kMostStrain, which is below 1, the deformation has an inverse on the whole plane (Banach's
/// fixed-point theorem).
class GRIDMERGE_EXPORT Deformation {
 public:
  /// No lattice is less tame.
  static constexpr double kMostStrain = 0.5;
  /// Columns and rows that a lattice may have.
  static constexpr int kMostPoints = 4096;

  /// The one that leaves every point where it is; it has no lattice.
  Deformation() = default;

  /// By a lattice of `columns` x `rows` shifts [m, in the lattice's directions], row by row, `spacing` metres
  /// apart. `T_map_lattice` takes the lattice's frame to the map's: the origin is where x = y = 0 above,
  /// which is between the first four shifts. Throws std::invalid_argument, saying what is wrong, unless there
  /// are 4 to kMostPoints columns and rows, their product is the number of shifts, all numbers are finite,
  /// the spacing is positive and the strain bound at most kMostStrain.
  Deformation(const SE2& T_map_lattice, double spacing, int columns, int rows, std::vector<Point2> shifts);

  /// Whether it has no lattice.
  bool is_identity() const { return shifts_.empty(); }
  /// Where a point goes, both in the map frame [m]. O(1).
  Point2 bend(const Point2& straight) const;
  /// Where a point comes from: bend(straighten(p)) is p to 10^-9 of the lattice's size. O(1): some ten times
  /// bend().
  Point2 straighten(const Point2& bent) const;

  /// The affine function of the map frame that it is on its lattice, as the lattices of maps that have a
  /// scale or shear alone are; none if it bends. The identity without a lattice. O(shifts).
  std::optional<Affine> affine() const;
  /// What it does to a map: rigid without a lattice, similarity or affine if it has that form on its lattice,
  /// elastic otherwise. O(shifts).
  MapTransform kind() const;

  /// An upper bound of the shift's derivative (Frobenius norm of its Jacobian matrix); 0 without a lattice.
  double strain_bound() const { return strain_bound_; }

  const SE2& T_map_lattice() const { return T_map_lattice_; }    ///< of the lattice in the map frame
  double spacing() const { return spacing_; }                    ///< [m]; 0 without a lattice
  int columns() const { return columns_; }                       ///< 0 without a lattice
  int rows() const { return rows_; }                             ///< 0 without a lattice
  const std::vector<Point2>& shifts() const { return shifts_; }  ///< row-major [m]

  /// Whether both have the same lattice.
  friend bool operator==(const Deformation&, const Deformation&) = default;

 private:
  Point2 shift_at(const Point2& in_lattice) const;

  SE2 T_map_lattice_;
  double spacing_ = 0.0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Point2> shifts_;
  double strain_bound_ = 0.0;
};

}  // namespace gridmerge
