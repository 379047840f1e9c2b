// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_sheet.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace gridmerge::internal {
namespace {

/// A map of 9 m x 5 m in a frame that is turned and far off.
OccupancyGrid some_map() {
  return make_grid(90, 50, 0.1, {3.0, -7.0, 0.4});
}

/// The shifts of a sheet as a function of the place of each, in the lattice's frame.
std::vector<Point2> shifts_by(const ElasticSheet& sheet, const std::function<Point2(double, double)>& shift) {
  std::vector<Point2> shifts;
  const int rows = static_cast<int>(sheet.size()) / sheet.columns();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < sheet.columns(); ++column)
      shifts.push_back(shift((column - 1) * sheet.spacing(), (row - 1) * sheet.spacing()));
  }
  return shifts;
}

double energy_of(const ElasticSheet& sheet, const Stiffness& stiffness, const std::vector<Point2>& shifts) {
  Eigen::VectorXd values(2 * static_cast<Eigen::Index>(shifts.size()));
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    values[2 * static_cast<Eigen::Index>(i)] = shifts[i].x;
    values[2 * static_cast<Eigen::Index>(i) + 1] = shifts[i].y;
  }
  return values.dot(sheet.energy(stiffness) * values);
}

std::vector<Point2> random_shifts(const ElasticSheet& sheet, unsigned seed, double most) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-most, most);
  std::vector<Point2> shifts;
  for (std::size_t i = 0; i < sheet.size(); ++i) {
    const double x = shift(random), y = shift(random);
    shifts.push_back({x, y});
  }
  return shifts;
}

TEST(ElasticSheet, CoversItsMapWithALatticeInItsMiddle) {
  const ElasticSheet sheet(some_map(), 2.0, {});
  // 9 m take five spacings and 5 m three; a spline has three points more.
  EXPECT_EQ(sheet.columns(), 8);
  EXPECT_EQ(sheet.size(), 8U * 6U);
  // Half a metre is left on each side, of either axis.
  const Point2 corner = sheet.deformation().T_map_lattice() * Point2{0.5, 0.5};
  EXPECT_NEAR(corner.x, 3.0, 1e-9);
  EXPECT_NEAR(corner.y, -7.0, 1e-9);
  EXPECT_NEAR(sheet.deformation().T_map_lattice().theta, 0.4, 1e-12);
  // A map that is as long as spacings takes no more of them, and the least is one.
  EXPECT_EQ(ElasticSheet(make_grid(90, 5, 0.1), 3.0, {}).columns(), 6);
  EXPECT_EQ(ElasticSheet(make_grid(90, 5, 0.1), 3.0, {}).size(), 6U * 4U);
}

TEST(ElasticSheet, BendingIsTheIntegralOfSquaredSecondDerivatives) {
  const ElasticSheet sheet(some_map(), 2.0, {});
  const Stiffness stiffness{3.0, 0.0};
  const double across = sheet.columns(), up = static_cast<double>(sheet.size()) / across;
  const auto energy = [&](const std::function<Point2(double, double)>& shift) {
    return energy_of(sheet, stiffness, shifts_by(sheet, shift));
  };
  // No linear shift bends.
  EXPECT_NEAR(energy([](double x, double y) {
                return Point2{0.3 * x - 0.2 * y + 1.0, 0.7 * x + y};
              }),
              0.0, 1e-9);
  // a x^2 has 2 a everywhere: of a lattice with n points along x in n - 2 places, each of four square metres.
  const double a = 0.01, square = 4.0;
  EXPECT_NEAR(energy([&](double x, double) {
                return Point2{a * x * x, 0.0};
              }),
              3.0 * 4.0 * a * a * (across - 2.0) * up * square, 1e-9);
  EXPECT_NEAR(energy([&](double, double y) {
                return Point2{0.0, a * y * y};
              }),
              3.0 * 4.0 * a * a * (up - 2.0) * across * square, 1e-9);
  // a x y has the mixed ones, a each, twice.
  EXPECT_NEAR(energy([&](double x, double y) {
                return Point2{0.0, a * x * y};
              }),
              3.0 * 2.0 * a * a * (across - 1.0) * (up - 1.0) * square, 1e-9);
}

TEST(ElasticSheet, StrainIsTheIntegralOfItsSquare) {
  const ElasticSheet sheet(some_map(), 2.0, {});
  const Stiffness stiffness{0.0, 5.0};
  const double across = sheet.columns(), up = static_cast<double>(sheet.size()) / across;
  const double area = (across - 1.0) * (up - 1.0) * 4.0;
  const auto energy = [&](double xx, double xy, double yx, double yy) {
    return energy_of(sheet, stiffness, shifts_by(sheet, [&](double x, double y) {
                       return Point2{xx * x + xy * y + 0.3, yx * x + yy * y - 1.0};
                     }));
  };
  // The symmetric part of the derivative, squared, each off-diagonal one twice.
  EXPECT_NEAR(energy(0.1, 0.0, 0.0, 0.0), 5.0 * 0.01 * area, 1e-9);
  EXPECT_NEAR(energy(0.0, 0.0, 0.0, 0.2), 5.0 * 0.04 * area, 1e-9);
  EXPECT_NEAR(energy(0.0, 0.1, 0.0, 0.0), 5.0 * 2.0 * 0.05 * 0.05 * area, 1e-9);
  EXPECT_NEAR(energy(0.0, 0.1, 0.1, 0.0), 5.0 * 2.0 * 0.1 * 0.1 * area, 1e-9);
  EXPECT_NEAR(energy(0.0, 0.1, -0.1, 0.0), 0.0, 1e-9);  // a turn
  EXPECT_NEAR(energy(0.1, 0.0, 0.0, 0.2), 5.0 * 0.05 * area, 1e-9);
}

TEST(ElasticSheet, AStepIsTakenAsFarAsItStaysTame) {
  ElasticSheet sheet(some_map(), 2.0, {});
  const std::vector<Point2> little = random_shifts(sheet, 1, 0.05), much = random_shifts(sheet, 2, 2.0);
  sheet.step_to(little, 0.2);
  EXPECT_EQ(sheet.shifts(), little);
  sheet.step_to(much, 0.2);
  const int rows = static_cast<int>(sheet.size()) / sheet.columns();
  const double bound = strain_bound(sheet.shifts(), sheet.columns(), rows, sheet.spacing());
  EXPECT_LE(bound, 0.2);
  // It was halved no more often than it had to be, and by the same share for all.
  const double share = (sheet.shifts()[0].x - little[0].x) / (much[0].x - little[0].x);
  std::vector<Point2> twice;
  for (std::size_t i = 0; i < little.size(); ++i) {
    EXPECT_NEAR(sheet.shifts()[i].x, little[i].x + share * (much[i].x - little[i].x), 1e-9);
    EXPECT_NEAR(sheet.shifts()[i].y, little[i].y + share * (much[i].y - little[i].y), 1e-9);
    twice.push_back({little[i].x + 2.0 * share * (much[i].x - little[i].x),
                     little[i].y + 2.0 * share * (much[i].y - little[i].y)});
  }
  EXPECT_GT(share, 0.0);
  EXPECT_GT(strain_bound(twice, sheet.columns(), rows, sheet.spacing()), 0.2);
  // What is no number is no step.
  const std::vector<Point2> before = sheet.shifts();
  std::vector<Point2> broken = little;
  broken.back().y = std::numeric_limits<double>::quiet_NaN();
  sheet.step_to(broken, 0.2);
  EXPECT_EQ(sheet.shifts(), before);
}

TEST(ElasticSheet, AStepThatIsAMillionTimesTooFarIsNotTaken) {
  ElasticSheet sheet(some_map(), 2.0, {});
  const std::vector<Point2> tame = random_shifts(sheet, 1, 0.05);
  const double bound = strain_bound(tame, sheet.columns(), sheet.rows(), sheet.spacing());
  const auto step = [&](double factor) {
    std::vector<Point2> shifts = tame;
    for (Point2& shift : shifts) shift = {factor * shift.x, factor * shift.y};
    sheet.step_to(shifts, 1.5 * bound);
  };
  step(2.0 * (1 << 20));
  EXPECT_EQ(sheet.shifts(), std::vector<Point2>(tame.size()));
  step(1 << 20);
  EXPECT_EQ(sheet.shifts(), tame) << "halved so often, to the bit";
}

TEST(ElasticSheet, LiesWhereItsDeformationAndPoseSay) {
  const SE2 T_group_map{-2.0, 5.0, 1.1};
  ElasticSheet sheet(some_map(), 2.0, T_group_map);
  sheet.step_to(random_shifts(sheet, 3, 0.1), 0.4);
  const Deformation deformation = sheet.deformation();
  for (const Point2 in_grid : {Point2{0.0, 0.0}, Point2{4.4, 2.1}, Point2{9.0, 5.0}, Point2{-3.0, 8.0}}) {
    const Point2 p = some_map().origin * in_grid;
    const Point2 expected = T_group_map * deformation.bend(p), found = sheet.to_group(p);
    EXPECT_NEAR(found.x, expected.x, 1e-9);
    EXPECT_NEAR(found.y, expected.y, 1e-9);
    // And by the weights of a point.
    const SplineWeights weights = sheet.weights_at(p);
    const Point2 shift = interpolated(weights, sheet.shifts().data(), sheet.columns());
    const SE2 turn{0.0, 0.0, sheet.direction()};
    const Point2 straight = T_group_map * p, shifted = turn * shift;
    EXPECT_NEAR(straight.x + shifted.x, found.x, 1e-9);
    EXPECT_NEAR(straight.y + shifted.y, found.y, 1e-9);
  }
  // A lattice that is too wild for a deformation is made tamer.
  ElasticSheet wild(some_map(), 2.0, T_group_map);
  wild.step_to(random_shifts(wild, 4, 1.0), 0.9);
  const double bound = wild.deformation().strain_bound();
  EXPECT_LE(bound, Deformation::kMostStrain);
  EXPECT_GT(bound, 0.49);
}

RC_GTEST_PROP(ElasticSheet, AnotherPoseWithAnAffineChangeDoesThatChangeToEachPoint, (unsigned seed)) {
  ElasticSheet sheet(some_map(), 2.0, {-2.0, 5.0, 1.1});
  sheet.step_to(random_shifts(sheet, seed, 0.1), 0.4);
  const auto number = [] { return *rc::gen::inRange(-100, 101) / 1000.0; };
  Affine change;
  change.xx += number();
  change.xy += number();
  change.yx += number();
  change.yy += number();
  change.shift = {10.0 * number(), 10.0 * number()};
  const ElasticSheet before = sheet;
  const SE2 T_group_map{10.0 * number(), 10.0 * number(), 10.0 * number()};
  sheet.move(T_group_map, change);
  RC_ASSERT(sheet.T_group_map() == T_group_map);
  for (const Point2 in_grid : {Point2{0.3, 0.2}, Point2{4.4, 2.1}, Point2{8.7, 4.9}}) {
    const Point2 p = some_map().origin * in_grid;
    const Point2 expected = change * before.to_group(p), found = sheet.to_group(p);
    RC_ASSERT(std::hypot(found.x - expected.x, found.y - expected.y) < 1e-9);
  }
}

}  // namespace
}  // namespace gridmerge::internal
