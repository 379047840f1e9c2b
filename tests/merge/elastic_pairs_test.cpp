// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic_pairs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "merge/elastic_system.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

constexpr double kCell = 0.1;

/// Half of a building, as the map of a robot whose frame is the building's.
OccupancyGrid half(unsigned seed = 1) {
  return test::map_part(test::draw_building(seed), {0, 0, 10, 13}, {});
}

ElasticMember member_of(const OccupancyGrid& map, const SE2& T_group_map, bool held = false) {
  return {ElasticSheet(map, 3.0, T_group_map), ElasticWalls(make_likelihood_field(map, kCell)), held};
}

TEST(ElasticWalls, HaveNormalsAcrossTheirLinesTowardsTheFloor) {
  // A room that is turned by 0.3 rad: facings are parts of a turn of 0.2 rad, lines say more.
  const double theta = 0.3;
  OccupancyGrid map = make_grid(200, 200, 0.05, {-5.0, -5.0, 0.0});
  for (int row = 0; row < 200; ++row) {
    for (int column = 0; column < 200; ++column) {
      const Point2 p = map.cell_centre(column, row);
      const double u = std::abs(std::cos(theta) * p.x + std::sin(theta) * p.y);
      const double v = std::abs(-std::sin(theta) * p.x + std::cos(theta) * p.y);
      if (u < 3.1 && v < 2.1) map.at(column, row) = u < 3.0 && v < 2.0 ? Cell::free : Cell::occupied;
    }
  }
  const ElasticWalls walls(make_likelihood_field(map, kCell));
  ASSERT_GT(walls.walls().size(), 100U);
  for (const ElasticWall& wall : walls.walls()) {
    EXPECT_NEAR(std::hypot(wall.normal.x, wall.normal.y), 1.0, 1e-9);
    const double u = std::cos(theta) * wall.position.x + std::sin(theta) * wall.position.y;
    const double v = -std::sin(theta) * wall.position.x + std::cos(theta) * wall.position.y;
    if (std::abs(u) > 2.4 && std::abs(v) > 1.4) continue;  // near a corner
    const double nu = std::cos(theta) * wall.normal.x + std::sin(theta) * wall.normal.y;
    const double nv = -std::sin(theta) * wall.normal.x + std::cos(theta) * wall.normal.y;
    EXPECT_FALSE(wall.has_two_sides);
    if (std::abs(u) > 2.4) {
      EXPECT_LT(nu * u, -0.98 * std::abs(u)) << u << ' ' << v;
    } else {
      EXPECT_LT(nv * v, -0.98 * std::abs(v)) << u << ' ' << v;
    }
  }
}

TEST(ElasticWalls, FaceAlikeWithin37Degrees) {
  const auto facing = [](double degrees, bool has_two_sides) {
    const double angle = degrees / 180.0 * std::numbers::pi;
    return ElasticWall{{}, {std::cos(angle), std::sin(angle)}, has_two_sides};
  };
  for (const double turn : {0.0, 50.0, -130.0}) {
    EXPECT_TRUE(faces_alike(facing(turn, false), facing(turn + 36.0, false)));
    EXPECT_FALSE(faces_alike(facing(turn, false), facing(turn + 38.0, false)));
    EXPECT_FALSE(faces_alike(facing(turn, false), facing(turn + 180.0, false)));
    EXPECT_TRUE(faces_alike(facing(turn, true), facing(turn + 170.0, false)));
    EXPECT_TRUE(faces_alike(facing(turn, false), facing(turn + 170.0, true)));
    EXPECT_FALSE(faces_alike(facing(turn, true), facing(turn + 90.0, true)));
  }
}

TEST(ElasticWalls, TheNearestIsThatOfALookAtAll) {
  const ElasticWalls walls(make_likelihood_field(half(), kCell));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-1.0, 12.0), y(-1.0, 14.0), angle(-3.1, 3.1);
  int found = 0;
  for (int i = 0; i < 600; ++i) {
    const double turn = angle(random), at_x = x(random), at_y = y(random);
    const ElasticWall wall{{at_x, at_y}, {std::cos(turn), std::sin(turn)}, i % 3 == 0};
    for (const double reach : {0.2, 0.7, 2.0}) {
      // Distance squared, and twice the squared reach (half a metre at least) for a right angle between
      // normals.
      const double per_normal = std::max(reach, 0.5);
      double least = std::numeric_limits<double>::infinity();
      for (const ElasticWall& other : walls.walls()) {
        const double away = std::hypot(other.position.x - at_x, other.position.y - at_y);
        if (away > reach || !faces_alike(other, wall)) continue;
        const double cosine = std::abs(other.normal.x * wall.normal.x + other.normal.y * wall.normal.y);
        least = std::min(least, away * away + 2.0 * per_normal * per_normal * (1.0 - cosine));
      }
      const ElasticWall* const nearest = walls.nearest(wall, reach);
      ASSERT_EQ(nearest != nullptr, std::isfinite(least));
      if (nearest == nullptr) continue;
      ++found;
      const double away = std::hypot(nearest->position.x - at_x, nearest->position.y - at_y);
      const double cosine = std::abs(nearest->normal.x * wall.normal.x + nearest->normal.y * wall.normal.y);
      EXPECT_NEAR(away * away + 2.0 * per_normal * per_normal * (1.0 - cosine), least, 1e-12);
    }
  }
  EXPECT_GT(found, 300);
}

TEST(Misfit, IsHalfAtTwoDecimetresOrTwoCells) {
  EXPECT_EQ(misfit_of_gap(0.0, 0.05), 0.0);
  EXPECT_NEAR(misfit_of_gap(0.2, 0.05), 0.5, 1e-12);
  EXPECT_NEAR(misfit_of_gap(-0.2, 0.05), 0.5, 1e-12);
  EXPECT_NEAR(misfit_of_gap(0.2, 0.1), 0.5, 1e-12);
  EXPECT_NEAR(misfit_of_gap(0.6, 0.3), 0.5, 1e-12);
  EXPECT_NEAR(misfit_of_gap(0.4, 0.05), 0.8, 1e-12);
  EXPECT_GT(misfit_of_gap(5.0, 0.05), 0.99);
}

double sum_on(const PairMisfit& misfit) {
  double sum = 0.0;
  for (const auto& [square, part] : misfit.on) sum += part;
  return sum;
}

TEST(Misfits, OfAMapOnItselfAreNoneAndOfMapsApartAreOneAWall) {
  const OccupancyGrid map = half();
  const SE2 T{4.0, -3.0, 0.7};
  const std::vector<std::pair<std::size_t, std::size_t>> pairs{{0, 1}, {0, 2}};
  const std::vector<ElasticMember> members{member_of(map, T), member_of(map, T),
                                           member_of(map, {500.0, 0.0, 0.0})};
  const std::vector<PairMisfit> misfits = misfits_of(members, pairs, kCell, {});
  // 400 walls of each map are looked at, if it has as many.
  const double walls = 2.0 * std::min(400.0, static_cast<double>(members[0].walls.walls().size()));
  EXPECT_EQ(misfits[0].met, walls);
  EXPECT_NEAR(sum_on(misfits[0]), 0.0, 1e-9);
  EXPECT_EQ(misfits[1].met, 0.0);
  EXPECT_EQ(sum_on(misfits[1]), walls);
  // The two colours of a chessboard have all of it, each on squares of its own.
  double met = 0.0, apart = 0.0;
  for (const int colour : {0, 1}) {
    const WallFold fold{2.0, colour};
    const std::vector<PairMisfit> part = misfits_of(members, pairs, kCell, fold);
    met += part[0].met;
    apart += sum_on(part[1]);
    EXPECT_GT(part[0].met, 0.25 * walls);
    EXPECT_GT(part[0].on.size(), 5U);
    for (const auto& [square, sum] : part[0].on) {
      EXPECT_TRUE(fold.has(square));
      EXPECT_LE(std::abs(square.first), 12);  // of 2 m, about a building of 18 m
      EXPECT_LE(std::abs(square.second), 12);
    }
  }
  EXPECT_EQ(met, walls);
  EXPECT_EQ(apart, walls);
}

TEST(PairsThatMeet, AreThoseWithWallsInCommon) {
  const OccupancyGrid map = half();
  const SE2 T{4.0, -3.0, 0.7};
  std::vector<ElasticMember> members{member_of(map, T), member_of(map, {200.0, 0.0, 0.0}),
                                     member_of(map, T * SE2{0.1, 0.0, 0.0}),
                                     member_of(map, {200.3, 0.1, 0.0})};
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(pairs_that_meet(members, 0.5), (Pairs{{0, 2}, {1, 3}}));
  // Two that are held cannot be bent.
  members[0].held = members[2].held = members[1].held = true;
  EXPECT_EQ(pairs_that_meet(members, 0.5), (Pairs{{1, 3}}));
  members[3].held = true;
  EXPECT_TRUE(pairs_that_meet(members, 0.5).empty());
  // Of a dozen maps that all meet, each is tied to eight at least, and not to all.
  const std::vector<ElasticMember> crowd(14, member_of(map, T));
  const Pairs pairs = pairs_that_meet(crowd, 0.5);
  std::vector<int> count(crowd.size(), 0);
  for (const auto& [first, second] : pairs) {
    ++count[first];
    ++count[second];
  }
  EXPECT_GE(*std::min_element(count.begin(), count.end()), 8);
  EXPECT_LT(pairs.size(), 14U * 13U / 2U);
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
}

/// The place that weights are of [map frame]: a spline gives back the places of its points.
Point2 place_of(const ElasticSheet& sheet, const SplineWeights& weights) {
  Point2 place;
  for (int a = 0; a < 4; ++a) {
    place.x += weights.x[a] * (weights.column + a - 1) * sheet.spacing();
    place.y += weights.y[a] * (weights.row + a - 1) * sheet.spacing();
  }
  return sheet.deformation().T_map_lattice() * place;
}

TEST(TieWalls, GapsAreWhatThePosesAreOff) {
  const OccupancyGrid map = half();
  const SE2 T{4.0, -3.0, 0.7};
  const Point2 off{0.08, -0.05};
  const SE2 T_other{T.x + off.x, T.y + off.y, T.theta};
  const std::vector<ElasticMember> members{member_of(map, T), member_of(map, T_other)};
  const std::vector<TiedPair> tied = tie_walls(members, {{0, 1}}, 0.4, kCell, {});
  ASSERT_EQ(tied.size(), 1U);
  const std::size_t looked_at = std::min<std::size_t>(400, members[0].walls.walls().size());
  ASSERT_GT(tied[0].ties.size(), 2 * looked_at * 9 / 10);
  EXPECT_LE(tied[0].ties.size(), 2 * looked_at);
  double across = 0.0, expected = 0.0;
  for (const WallTie& tie : tied[0].ties) {
    EXPECT_NEAR(std::hypot(tie.normal.x, tie.normal.y), 1.0, 1e-9);
    EXPECT_LT(std::hypot(tie.gap.x, tie.gap.y), 0.4 + 1e-9);
    EXPECT_NEAR(tie.along, 0.05 * tie.across, 1e-12);
    // From the second map's wall to the first one's: the poses' difference, turned round.
    const double gap = tie.normal.x * tie.gap.x + tie.normal.y * tie.gap.y;
    const double of_poses = -(tie.normal.x * off.x + tie.normal.y * off.y);
    across += gap * of_poses;
    expected += of_poses * of_poses;
    // Both weights are of the place half-way between the walls, so that they differ by the poses' difference.
    const Point2 first = T * place_of(members[0].sheet, tie.at_first),
                 second = T_other * place_of(members[1].sheet, tie.at_second);
    EXPECT_NEAR(first.x, second.x, 1e-6);
    EXPECT_NEAR(first.y, second.y, 1e-6);
  }
  // Some walls have another one that is nearer than their own, as furniture has.
  EXPECT_GT(across, 0.5 * expected);
  EXPECT_LT(across, 1.05 * expected);
}

TEST(TieWalls, WeighLessFartherApartAndInMorePairs) {
  const OccupancyGrid map = half();
  const SE2 T{4.0, -3.0, 0.7};
  const std::vector<ElasticMember> members{member_of(map, T), member_of(map, T),
                                           member_of(map, T * SE2{0.0, 0.15, 0.0})};
  const auto weight = [](const TiedPair& pair) { return pair.ties.front().across; };
  const std::vector<TiedPair> alone = tie_walls(members, {{0, 1}}, 0.4, kCell, {});
  // A wall is as long as its cell, a metre is one observation, and it is known to a decimetre.
  const double walls = static_cast<double>(members[0].walls.walls().size());
  const double looked_at = std::min(400.0, walls);
  for (const WallTie& tie : alone[0].ties)
    EXPECT_NEAR(tie.across, 0.5 * kCell * walls / looked_at / (0.1 * 0.1), 1e-6);
  const std::vector<TiedPair> both = tie_walls(members, {{0, 1}, {0, 2}}, 0.4, kCell, {});
  EXPECT_NEAR(weight(both[0]), weight(alone[0]) * 2.0 / 3.0, 1e-6);
  const std::vector<TiedPair> folded = tie_walls(members, {{0, 1}}, 0.4, kCell, {2.0, 1});
  EXPECT_NEAR(weight(folded[0]), 2.0 * weight(alone[0]), 1e-6);
  EXPECT_LT(folded[0].ties.size(), 3 * alone[0].ties.size() / 4);
  // Half of the reach is usual (Geman and McClure): a gap of that weighs a quarter.
  const std::vector<TiedPair> apart = tie_walls(members, {{0, 2}}, 0.4, kCell, {});
  ASSERT_FALSE(apart[0].ties.empty());
  for (const WallTie& tie : apart[0].ties) {
    const double far = (tie.gap.x * tie.gap.x + tie.gap.y * tie.gap.y) / (0.2 * 0.2);
    EXPECT_NEAR(tie.across, weight(alone[0]) / ((1.0 + far) * (1.0 + far)), 1e-6);
  }
}

/// What solve_shifts() makes least, solved at once: the normal equations of all maps that are not held.
std::vector<std::vector<Point2>> solved_at_once(const std::vector<ElasticMember>& members,
                                                const std::vector<TiedPair>& pairs,
                                                const std::vector<Eigen::SparseMatrix<double>>& energies) {
  std::vector<Eigen::Index> begins;
  Eigen::Index unknowns = 0;
  for (const ElasticMember& member : members) {
    begins.push_back(unknowns);
    unknowns += 2 * static_cast<Eigen::Index>(member.sheet.size());
  }
  Eigen::VectorXd now(unknowns);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Eigen::Index size = 2 * static_cast<Eigen::Index>(members[i].sheet.size());
    matrix.block(begins[i], begins[i], size, size) += Eigen::MatrixXd(energies[i]);
    for (Eigen::Index k = 0; k < size; ++k) {
      const Point2& shift = members[i].sheet.shifts()[static_cast<std::size_t>(k / 2)];
      now[begins[i] + k] = k % 2 == 0 ? shift.x : shift.y;
    }
  }
  Eigen::VectorXd gradient = matrix * now;
  for (const TiedPair& pair : pairs) {
    for (const WallTie& tie : pair.ties) {
      for (const bool is_across : {true, false}) {
        const Point2 axis = is_across ? tie.normal : Point2{-tie.normal.y, tie.normal.x};
        const double weight = is_across ? tie.across : tie.along;
        // The gap along the axis is a linear form of all shifts.
        Eigen::VectorXd form = Eigen::VectorXd::Zero(unknowns);
        for (const bool is_first : {true, false}) {
          const std::size_t map = is_first ? pair.first : pair.second;
          const ElasticSheet& sheet = members[map].sheet;
          const SplineWeights& at = is_first ? tie.at_first : tie.at_second;
          const double c = std::cos(sheet.direction()), s = std::sin(sheet.direction());
          const double sign = is_first ? 1.0 : -1.0;
          for (int b = 0; b < 4; ++b) {
            for (int a = 0; a < 4; ++a) {
              const Eigen::Index k = begins[map] + 2 * ((at.row + b) * sheet.columns() + at.column + a);
              form[k] += sign * at.x[a] * at.y[b] * (c * axis.x + s * axis.y);
              form[k + 1] += sign * at.x[a] * at.y[b] * (-s * axis.x + c * axis.y);
            }
          }
        }
        const double gap = axis.x * tie.gap.x + axis.y * tie.gap.y;
        gradient += weight * gap * form;
        matrix += weight * form * form.transpose();
      }
    }
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!members[i].held) continue;
    const Eigen::Index size = 2 * static_cast<Eigen::Index>(members[i].sheet.size());
    matrix.middleRows(begins[i], size).setZero();
    matrix.middleCols(begins[i], size).setZero();
    matrix.block(begins[i], begins[i], size, size).setIdentity();
    gradient.segment(begins[i], size).setZero();
  }
  const Eigen::VectorXd solution = now - matrix.ldlt().solve(gradient);
  std::vector<std::vector<Point2>> shifts;
  for (std::size_t i = 0; i < members.size(); ++i) {
    std::vector<Point2>& of = shifts.emplace_back();
    for (std::size_t k = 0; k < members[i].sheet.size(); ++k) {
      const Eigen::Index at = begins[i] + 2 * static_cast<Eigen::Index>(k);
      of.push_back({solution[at], solution[at + 1]});
    }
  }
  return shifts;
}

TEST(SolveShifts, AreThoseOfTheNormalEquations) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto number = [&] { return any(random); };
  for (int run = 0; run < 6; ++run) {
    const OccupancyGrid map = make_grid(60, 45, 0.1, {1.0, 2.0, 0.3});
    std::vector<ElasticMember> members;
    std::vector<Eigen::SparseMatrix<double>> energies;
    for (int i = 0; i < 3; ++i) {
      members.push_back(member_of(map, {number(), number(), 3.0 * number()}, run % 2 == 1 && i == 1));
      ElasticSheet& sheet = members.back().sheet;
      std::vector<Point2> shifts;
      for (std::size_t k = 0; k < sheet.size(); ++k) {
        const double x = 0.1 * number(), y = 0.1 * number();
        shifts.push_back({x, y});
      }
      sheet.step_to(shifts, 0.5);
      Eigen::SparseMatrix<double> floor(2 * static_cast<Eigen::Index>(sheet.size()),
                                        2 * static_cast<Eigen::Index>(sheet.size()));
      floor.setIdentity();
      energies.push_back(sheet.energy({20.0, 5.0}) + 0.5 * floor);
    }
    std::vector<TiedPair> pairs;
    for (const auto& [first, second] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      TiedPair& pair = pairs.emplace_back();
      pair.first = first;
      pair.second = second;
      for (int i = 0; i < 15; ++i) {
        const auto at = [&](const ElasticSheet& sheet) {
          const double x = 3.0 + 3.0 * number(), y = 2.2 + 2.2 * number();
          return sheet.weights_at(map.origin * Point2{x, y});
        };
        WallTie tie;
        tie.at_first = at(members[first].sheet);
        tie.at_second = at(members[second].sheet);
        tie.gap.x = 0.2 * number();
        tie.gap.y = 0.2 * number();
        const double turn = 3.0 * number();
        tie.normal = {std::cos(turn), std::sin(turn)};
        tie.across = 20.0 + 10.0 * number();
        tie.along = 2.0 + number();
        pair.ties.push_back(tie);
      }
    }
    const auto found = solve_shifts(members, pairs, energies);
    const auto expected = solved_at_once(members, pairs, energies);
    ASSERT_EQ(found.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(found[i].size(), expected[i].size());
      for (std::size_t k = 0; k < found[i].size(); ++k) {
        EXPECT_NEAR(found[i][k].x, expected[i][k].x, 1e-3) << run << ' ' << i << ' ' << k;
        EXPECT_NEAR(found[i][k].y, expected[i][k].y, 1e-3) << run << ' ' << i << ' ' << k;
      }
      if (members[i].held) {
        EXPECT_EQ(found[i], members[i].sheet.shifts());
      }
    }
  }
}

}  // namespace
}  // namespace gridmerge::internal
