// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/simulate/simulate.hpp"
#include "simulate/floor_plan.hpp"
#include "simulate/visit.hpp"

namespace gridmerge {

using namespace internal;
namespace {

TEST(Building, KindsHaveNames) {
  for (const BuildingKind kind : building_kinds()) EXPECT_EQ(building_kind(name_of(kind)), kind);
  // Kinds are looked up by their number.
  for (std::size_t i = 0; i < building_kinds().size(); ++i)
    EXPECT_EQ(static_cast<std::size_t>(building_kinds()[i]), i);
  EXPECT_EQ(building_kinds().back(), BuildingKind::bare);
  EXPECT_FALSE(building_kind("castle"));
}

bool same(const Building& a, const Building& b) {
  return std::equal(
      a.edges.begin(), a.edges.end(), b.edges.begin(), b.edges.end(),
      [](const Edge& x, const Edge& y) { return x.a == y.a && x.b == y.b && x.echo == y.echo; });
}

/// How much floor a building can have at most, roughly [m^2].
double fillable(BuildingKind kind, double width, double height) {
  if (kind == BuildingKind::curved) return std::pow(std::min(0.5 * width, height), 2);  // half a circle
  if (kind == BuildingKind::arena) return std::pow(std::min(width, height), 2);         // some are square
  if (kind == BuildingKind::corridor) return 2.5 * std::max(width, height);
  return width * height;
}

TEST(Building, EveryKindAndSizeHasAFloorToWalkOnAndFollowsItsSeed) {
  for (const BuildingKind kind : building_kinds()) {
    for (const auto& [width, height] : {std::pair{8.0, 8.0}, std::pair{40.0, 25.0}, std::pair{12.0, 60.0}}) {
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(std::string(name_of(kind)) + " " + std::to_string(width) + " " + std::to_string(seed));
        const Building building = make_building(kind, width, height, seed);
        const FloorPlan plan(building.edges, 0.2);
        const double floor = plan.count_free() * FloorPlan::kCell * FloorPlan::kCell;
        const double fills = fillable(kind, width, height);
        EXPECT_GT(floor, std::min(width, height) < 20.0 ? 0.08 * fills : 0.3 * fills);
        EXPECT_LT(floor, width * height);
        EXPECT_TRUE(same(building, make_building(kind, width, height, seed)));
        if (width > 8.0) {
          EXPECT_FALSE(same(building, make_building(kind, width, height, seed + 100)));
        }
        for (const Edge& edge : building.edges) {
          ASSERT_TRUE(std::isfinite(edge.a.x + edge.a.y + edge.b.x + edge.b.y));
          ASSERT_TRUE(edge.echo > 0.0 && edge.echo <= 1.0);
        }
      }
    }
  }
}

double checksum(const std::vector<Edge>& edges) {
  double sum = 0.0;
  for (const Edge& edge : edges) sum += edge.a.x + 2.0 * edge.a.y + 3.0 * edge.b.x + 5.0 * edge.b.y;
  return sum;
}

// What these seeds have drawn so far: a seed in a report has to go on meaning the same building.
TEST(Building, EveryCompilerDrawsTheSame) {
  struct Drawn {
    BuildingKind kind;
    std::size_t edges;
    double checksum, cluttered;  // the latter with what is scattered over the floor
    // Of small, tall and large buildings of other seeds. Not linear: half a turn leaves linear sums as they
    // are.
    double others;
  };
  const Drawn drawn[] = {{BuildingKind::office, 1756, 286084.1796, 311216.2196, 7392808.8156},
                         {BuildingKind::hall, 796, 115577.5845, 147100.2645, 2025659.1645},
                         {BuildingKind::warehouse, 860, 142085.4581, 173039.1781, 6046034.4638},
                         {BuildingKind::apartment, 2196, 341421.5495, 359695.6695, 11314207.7623},
                         {BuildingKind::symmetric, 1360, 247476.0649, 271304.2649, 6200694.6379},
                         {BuildingKind::loop, 1396, 214707.5545, 258186.3545, 5357918.8117},
                         {BuildingKind::curved, 832, 122439.3296, 131723.4422, 1941252.4343},
                         {BuildingKind::outdoor, 392, 59168.7579, 89316.6980, 1874755.3219},
                         {BuildingKind::corridor, 132, 25394.6449, 28894.3862, 680945.1888},
                         {BuildingKind::arena, 224, 37998.1588, 55829.4388, 837799.1241},
                         {BuildingKind::maze, 250, 42486.7445, 86797.7445, 810420.9979},
                         {BuildingKind::bare, 96, 17161.9408, 49051.0289, 645211.8500}};
  EXPECT_EQ(std::size(drawn), building_kinds().size());
  for (const Drawn& expected : drawn) {
    SCOPED_TRACE(name_of(expected.kind));
    const std::vector<Edge> edges = make_building(expected.kind, 40.0, 25.0, 3).edges;
    EXPECT_EQ(edges.size(), expected.edges);
    EXPECT_NEAR(checksum(edges), expected.checksum, 1e-3);
    const FloorPlan plan(edges, 0.2);
    Random random(4);
    const Visit visit = make_visit(edges, plan, 0.2, plan.free_cells().front(), 1.0, random);
    EXPECT_NEAR(checksum(visit.caster.edges()), expected.cluttered, 1e-3);
    double others = 0.0;
    for (const auto& [width, height] : {std::pair{8.0, 8.0}, std::pair{12.0, 60.0}, std::pair{70.0, 45.0}}) {
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        for (const Edge& edge : make_building(expected.kind, width, height, seed).edges)
          others += edge.echo * std::hypot(edge.a.x + 2.0 * edge.b.x, 3.0 * edge.a.y + 5.0 * edge.b.y);
      }
    }
    EXPECT_NEAR(others, expected.others, 1e-2);
  }
}

TEST(Building, RefusesKindsThatAreNone) {
  EXPECT_THROW(make_building(static_cast<BuildingKind>(99), 20.0, 20.0, 1), std::invalid_argument);
}

TEST(Building, CanBeCancelled) {
  const std::atomic<bool> cancelled{true};
  const Building building = make_building(BuildingKind::office, 40.0, 25.0, 3);
  EXPECT_THROW(with_cancellation(cancelled, [] { make_building(BuildingKind::office, 40.0, 25.0, 3); }),
               Cancelled);
  EXPECT_THROW(with_cancellation(cancelled, [&] { draw_building(building, 0.1); }), Cancelled);
}

TEST(Building, RefusesSidesThatAreNone) {
  for (const double side : {0.0, -3.0, 7.9, 501.0, std::nan("")}) {
    EXPECT_THROW(make_building(BuildingKind::hall, side, 20.0, 1), std::invalid_argument);
    EXPECT_THROW(make_building(BuildingKind::hall, 20.0, side, 1), std::invalid_argument);
  }
}

TEST(Building, RefusesToBeDrawnIfItCannotBe) {
  const Building good = make_building(BuildingKind::bare, 24.0, 16.0, 5);
  EXPECT_NO_THROW(draw_building(good, 0.1));
  const auto refused = [&](auto change) {
    Building building = good;
    change(building);
    EXPECT_THROW(validate(building), std::invalid_argument);
    EXPECT_THROW(draw_building(building, 0.1), std::invalid_argument);
    const std::vector<Point2> stays{{10.0, 8.0}};
    EXPECT_THROW(simulate_way(building, stays, {}), std::invalid_argument);
  };
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double side : {kNaN, -1.0, 0.0, 501.0, 1e12}) {
    refused([&](Building& building) { building.width = side; });
    refused([&](Building& building) { building.height = side; });
  }
  for (const Point2 end : {Point2{kNaN, 0.0}, Point2{0.0, 1e7}, Point2{-501.0, 0.0}, Point2{0.0, HUGE_VAL}}) {
    refused([&](Building& building) { building.edges.push_back({{1.0, 1.0}, end}); });
    refused([&](Building& building) { building.edges.push_back({end, {1.0, 1.0}}); });
  }
  for (const double echo : {kNaN, -0.1, 1.1})
    refused([&](Building& building) { building.edges.push_back({{1.0, 1.0}, {2.0, 1.0}, echo}); });
  // 50,000 x 50,000 cells.
  EXPECT_THROW(draw_building({BuildingKind::bare, 500.0, 500.0, {}}, 0.01), std::invalid_argument);
}

TEST(Building, TheSymmetricOneIsItselfTurnedByHalfATurnInItsWalls) {
  const Building building = make_building(BuildingKind::symmetric, 40.0, 20.0, 3);
  const OccupancyGrid map = draw_building(building, 0.1);
  std::size_t walls = 0, met = 0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) != Cell::occupied) continue;
      ++walls;
      for (int k = 0; k < 9; ++k) {
        const int x = map.width - 1 - column + k % 3 - 1, y = map.height - 1 - row + k / 3 - 1;
        if (!map.contains(x, y) || map.at(x, y) != Cell::occupied) continue;
        ++met;
        break;
      }
    }
  }
  EXPECT_GT(static_cast<double>(met), 0.75 * static_cast<double>(walls));  // the rest is furniture
}

}  // namespace
}  // namespace gridmerge
