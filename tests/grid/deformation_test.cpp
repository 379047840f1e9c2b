// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/deformation.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "grid/seen_from.hpp"

namespace gridmerge {
namespace {

/// A lattice of random shifts, made as small as the strain bound asks for.
struct AnyLattice {
  AnyLattice() {
    columns = *rc::gen::inRange(4, 9);
    rows = *rc::gen::inRange(4, 9);
    spacing = *rc::gen::inRange(1, 2000) / 100.0;
    frame = {*rc::gen::inRange(-500, 500) / 10.0, *rc::gen::inRange(-500, 500) / 10.0,
             normalize_angle(*rc::gen::inRange(-314, 314) / 100.0)};
    for (int i = 0; i < columns * rows; ++i)
      shifts.push_back({*rc::gen::inRange(-1000, 1001) / 1000.0, *rc::gen::inRange(-1000, 1001) / 1000.0});
    double along_x = 0.0, along_y = 0.0;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Point2& here = at(column, row);
        if (column + 1 < columns)
          along_x =
              std::max(along_x, std::hypot(at(column + 1, row).x - here.x, at(column + 1, row).y - here.y));
        if (row + 1 < rows)
          along_y =
              std::max(along_y, std::hypot(at(column, row + 1).x - here.x, at(column, row + 1).y - here.y));
      }
    }
    bound = std::hypot(along_x, along_y) / spacing;
    const double wanted = *rc::gen::inRange(1, 500) / 1000.0;
    const double factor = bound > 0.0 ? wanted / bound : 1.0;
    for (Point2& shift : shifts) shift = {factor * shift.x, factor * shift.y};
    bound = bound > 0.0 ? wanted : 0.0;
  }

  const Point2& at(int column, int row) const {
    return shifts[static_cast<std::size_t>(row * columns + column)];
  }
  Deformation deformation() const { return {frame, spacing, columns, rows, shifts}; }
  /// Inside of the lattice and around it.
  Point2 any_point() const {
    const auto along = [&](int points) {
      return (*rc::gen::inRange(-2000, 3001) / 1000.0) * spacing * (points - 3);
    };
    const double x = along(columns), y = along(rows);
    return frame * Point2{x, y};
  }

  int columns, rows;
  double spacing;
  SE2 frame;
  std::vector<Point2> shifts;
  double bound;
};

/// The basis function of degree 3 whose support begins at `first`, by Cox and de Boor's recursion.
double basis(int degree, double first, double x) {
  if (degree == 0) return x >= first && x < first + 1.0 ? 1.0 : 0.0;
  return (x - first) / degree * basis(degree - 1, first, x) +
         (first + degree + 1.0 - x) / degree * basis(degree - 1, first + 1.0, x);
}

RC_GTEST_PROP(Deformation, BendsAsTheSumOverAllShiftsSays, ()) {
  const AnyLattice any;
  const Point2 p = any.any_point(), q = inverse(any.frame) * p;
  const double x = std::min(std::max(q.x / any.spacing, 0.0), any.columns - 3 - 1e-12);
  const double y = std::min(std::max(q.y / any.spacing, 0.0), any.rows - 3 - 1e-12);
  Point2 expected = q;
  for (int row = 0; row < any.rows; ++row) {
    for (int column = 0; column < any.columns; ++column) {
      const double weight = basis(3, column - 3, x) * basis(3, row - 3, y);
      expected.x += weight * any.at(column, row).x;
      expected.y += weight * any.at(column, row).y;
    }
  }
  const Point2 bent = inverse(any.frame) * any.deformation().bend(p);
  RC_ASSERT(std::abs(bent.x - expected.x) < 1e-8 * any.spacing);
  RC_ASSERT(std::abs(bent.y - expected.y) < 1e-8 * any.spacing);
}

RC_GTEST_PROP(Deformation, IsUndoneByItsInverse, ()) {
  const AnyLattice any;
  const Deformation deformation = any.deformation();
  const Point2 p = any.any_point();
  const Point2 there = deformation.straighten(deformation.bend(p));
  const Point2 back = deformation.bend(deformation.straighten(p));
  const double close = 1e-9 * any.spacing * (any.columns + any.rows) + 1e-12;
  RC_ASSERT(std::hypot(there.x - p.x, there.y - p.y) < close);
  RC_ASSERT(std::hypot(back.x - p.x, back.y - p.y) < close);
}

// The shift changes by no more than the bound says: so no two points meet, and no triangle turns over.
RC_GTEST_PROP(Deformation, NeitherTearsNorFolds, ()) {
  const AnyLattice any;
  const Deformation deformation = any.deformation();
  RC_ASSERT(std::abs(deformation.strain_bound() - any.bound) < 1e-9);
  const Point2 a = any.any_point();
  const double step = 1e-4 * any.spacing, turn = *rc::gen::inRange(0, 628) / 100.0;
  const Point2 b{a.x + step * std::cos(turn), a.y + step * std::sin(turn)};
  const Point2 c{a.x - step * std::sin(turn), a.y + step * std::cos(turn)};
  const Point2 at_a = deformation.bend(a), at_b = deformation.bend(b), at_c = deformation.bend(c);
  const double change = std::hypot((at_b.x - b.x) - (at_a.x - a.x), (at_b.y - b.y) - (at_a.y - a.y));
  RC_ASSERT(change <= (any.bound + 1e-6) * step);
  const double area = (at_b.x - at_a.x) * (at_c.y - at_a.y) - (at_b.y - at_a.y) * (at_c.x - at_a.x);
  RC_ASSERT(area >= 0.2 * step * step);
  const Point2 far = any.any_point(), at_far = deformation.bend(far);
  const double apart = std::hypot(far.x - a.x, far.y - a.y);
  RC_ASSERT(std::hypot(at_far.x - at_a.x, at_far.y - at_a.y) >= (1.0 - any.bound - 1e-9) * apart);
}

RC_GTEST_PROP(Deformation, IsTheSameSeenFromAnotherFrame, ()) {
  const AnyLattice any;
  const Deformation deformation = any.deformation();
  const SE2 T_a_b{*rc::gen::inRange(-50, 50) / 3.0, *rc::gen::inRange(-50, 50) / 3.0,
                  *rc::gen::inRange(-31, 31) / 10.0};
  const Point2 p = any.any_point();
  const Point2 expected = T_a_b * deformation.bend(p),
               found = internal::seen_from(T_a_b, deformation).bend(T_a_b * p);
  RC_ASSERT(std::hypot(found.x - expected.x, found.y - expected.y) < 1e-8 * (1.0 + any.spacing));
}

TEST(Deformation, OfNoLatticeLeavesPointsWhereTheyAre) {
  const Deformation none;
  EXPECT_TRUE(none.is_identity());
  EXPECT_EQ(none.bend({1.5, -2.0}), (Point2{1.5, -2.0}));
  EXPECT_EQ(none.straighten({1.5, -2.0}), (Point2{1.5, -2.0}));
  EXPECT_EQ(none.strain_bound(), 0.0);
  EXPECT_EQ(internal::seen_from({1.0, 2.0, 3.0}, none), none);
}

TEST(Deformation, RefusesLatticesThatAreNone) {
  const std::vector<Point2> none(16);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(Deformation({}, 1.0, 4, 4, none));
  EXPECT_THROW(Deformation({}, 1.0, 3, 4, std::vector<Point2>(12)), std::invalid_argument);
  EXPECT_THROW(Deformation({}, 1.0, 4, 5, none), std::invalid_argument);
  EXPECT_THROW(Deformation({}, 1.0, -4, -4, none), std::invalid_argument);
  EXPECT_THROW(Deformation({}, 1.0, 4097, 4, std::vector<Point2>(4 * 4097)), std::invalid_argument);
  EXPECT_THROW(Deformation({}, 0.0, 4, 4, none), std::invalid_argument);
  EXPECT_THROW(Deformation({}, nan, 4, 4, none), std::invalid_argument);
  EXPECT_THROW(Deformation({nan, 0.0, 0.0}, 1.0, 4, 4, none), std::invalid_argument);
  std::vector<Point2> one = none;
  one[5].y = nan;
  EXPECT_THROW(Deformation({}, 1.0, 4, 4, one), std::invalid_argument);
  one[5].y = 0.4;  // a bound of 0.57
  EXPECT_THROW(Deformation({}, 1.0, 4, 4, one), std::invalid_argument);
  one[5].y = 0.35;
  EXPECT_NO_THROW(Deformation({}, 1.0, 4, 4, one));
}

// A lattice whose shifts are an affine function of their places is that function, seen from any frame.
RC_GTEST_PROP(Deformation, IsTheAffineFunctionThatItsShiftsAre, ()) {
  const auto entry = [] { return *rc::gen::inRange(-150, 151) / 1000.0; };
  const bool is_similar = *rc::gen::arbitrary<bool>();
  Affine change{entry(), entry(), entry(), entry(), {10.0 * entry(), 10.0 * entry()}};
  if (is_similar) change = {change.xx, -change.yx, change.yx, change.xx, change.shift};
  const int columns = *rc::gen::inRange(4, 8), rows = *rc::gen::inRange(4, 8);
  const double spacing = *rc::gen::inRange(10, 5000) / 100.0;
  const double far = *rc::gen::element(100.0, 1e7);  // as coordinates of a country are
  const SE2 frame{far * entry(), far * entry(), 20.0 * entry()};
  std::vector<Point2> shifts;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column)
      shifts.push_back(change * Point2{(column - 1) * spacing, (row - 1) * spacing});
  }
  const Deformation deformation(frame, spacing, columns, rows, shifts);
  const std::optional<Affine> affine = deformation.affine();
  RC_ASSERT(affine.has_value());
  RC_ASSERT(affine->determinant() > 0.0);
  const Point2 p = frame * Point2{*rc::gen::inRange(0, 1001) / 1000.0 * spacing * (columns - 3),
                                  *rc::gen::inRange(0, 1001) / 1000.0 * spacing * (rows - 3)};
  const Point2 expected = deformation.bend(p), found = *affine * p;
  RC_ASSERT(std::hypot(found.x - expected.x, found.y - expected.y) < 1e-9 * (1.0 + spacing) + 1e-14 * far);
  RC_ASSERT(std::abs((1.0 + change.xx) * (1.0 + change.yy) - change.xy * change.yx -
                     affine->scale() * affine->scale()) < 1e-9);
  const bool may_be_similar = std::abs(change.xx - change.yy) + std::abs(change.xy + change.yx) < 1e-9;
  RC_ASSERT(deformation.kind() == (may_be_similar ? MapTransform::similarity : MapTransform::affine));
  // One shift that is not of the function bends the map.
  shifts[static_cast<std::size_t>(*rc::gen::inRange(0, columns * rows))].y += 1e-3 * spacing;
  RC_ASSERT(Deformation(frame, spacing, columns, rows, shifts).kind() == MapTransform::elastic);
}

TEST(Deformation, OfNoLatticeIsRigid) {
  EXPECT_EQ(Deformation().kind(), MapTransform::rigid);
  EXPECT_EQ(Deformation().affine(), Affine{});
}

TEST(MapTransform, HasOneNameEach) {
  EXPECT_EQ(map_transforms().size(), 4u);
  for (const MapTransformName& one : map_transforms()) {
    EXPECT_EQ(name_of(one.transform), std::string(one.name));
    EXPECT_EQ(map_transform(one.name), one.transform);
  }
  EXPECT_EQ(map_transform("projective"), std::nullopt);
  EXPECT_EQ(map_transform(""), std::nullopt);
}

}  // namespace
}  // namespace gridmerge
