// SPDX-License-Identifier: Apache-2.0
// What the kinds that are hard to match promise: corridor, arena, maze, bare.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "simulate/arena.hpp"
#include "simulate/floor_plan.hpp"
#include "simulate/painted_floor.hpp"

namespace gridmerge {

using namespace internal;
namespace {

constexpr std::uint64_t kSeeds = 40;

double length_of(const Edge& edge) {
  return std::hypot(edge.b.x - edge.a.x, edge.b.y - edge.a.y);
}

/// The places of edges, sorted, whichever of their ends comes first.
std::vector<std::array<double, 4>> sorted(const std::vector<Edge>& edges) {
  std::vector<std::array<double, 4>> all;
  for (const Edge& edge : edges) {
    std::array<double, 2> low{edge.a.x, edge.a.y}, high{edge.b.x, edge.b.y};
    if (high < low) std::swap(low, high);
    all.push_back({low[0], low[1], high[0], high[1]});
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// About the origin by a quarter turn, `times` over.
std::vector<Edge> turned(std::vector<Edge> edges, int times) {
  for (Edge& edge : edges) {
    for (int i = 0; i < times; ++i) {
      edge.a = {-edge.a.y, edge.a.x};
      edge.b = {-edge.b.y, edge.b.x};
    }
  }
  return edges;
}

double distance_between(const std::vector<Edge>& a, const std::vector<Edge>& b) {
  double least = 1e9;
  for (const Edge& from : a) {
    for (const Edge& to : b) {
      for (int i = 0; i <= 20; ++i) {
        const Point2 p{to.a.x + i / 20.0 * (to.b.x - to.a.x), to.a.y + i / 20.0 * (to.b.y - to.a.y)};
        least = std::min(least, std::hypot(p.x - from.a.x, p.y - from.a.y));
      }
    }
  }
  return least;
}

TEST(Arena, LiesOnItselfWhenItIsTurnedExceptForItsLonePillars) {
  std::set<int> folds;
  std::set<std::size_t> lone;
  for (const auto& [width, height] : {std::pair{8.0, 8.0}, std::pair{25.0, 25.0}, std::pair{40.0, 25.0}}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(std::to_string(width) + " " + std::to_string(seed));
      Random random(seed);
      const Arena arena = make_arena(random, width, height);
      ASSERT_TRUE(arena.folds == 2 || arena.folds == 4);
      folds.insert(arena.folds);
      const int times = 4 / arena.folds;
      EXPECT_TRUE(sorted(arena.symmetric) == sorted(turned(arena.symmetric, times)));
      if (arena.folds == 2) {
        EXPECT_FALSE(sorted(arena.symmetric) == sorted(turned(arena.symmetric, 1)));
      }
      ASSERT_LE(arena.lone.size(), 5U);
      if (width > 8.0) lone.insert(arena.lone.size());
      for (const std::vector<Edge>& pillar : arena.lone) {
        for (int i = 1; i < arena.folds; ++i) {
          const std::vector<Edge> copy = turned(pillar, i * times);
          EXPECT_GT(distance_between(copy, arena.symmetric), 0.5);
          for (const std::vector<Edge>& other : arena.lone) EXPECT_GT(distance_between(copy, other), 0.5);
        }
      }
      // The building is the arena about its middle.
      const Building building = make_building(BuildingKind::arena, width, height, seed);
      std::vector<Edge> all = arena.symmetric;
      for (const std::vector<Edge>& pillar : arena.lone) all.insert(all.end(), pillar.begin(), pillar.end());
      ASSERT_EQ(building.edges.size(), all.size());
      for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_NEAR(building.edges[i].a.x, all[i].a.x + 0.5 * width, 1e-9);
        EXPECT_NEAR(building.edges[i].b.y, all[i].b.y + 0.5 * height, 1e-9);
      }
    }
  }
  EXPECT_EQ(folds, (std::set{2, 4}));
  EXPECT_EQ(lone, (std::set<std::size_t>{0, 1, 2, 3, 4, 5}));
}

TEST(Maze, WallsAreSingleEdgesAndWaysAsWideAsTheyShouldBe) {
  for (const auto& [width, height] : {std::pair{8.0, 8.0}, std::pair{40.0, 25.0}}) {
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(std::to_string(width) + " " + std::to_string(seed));
      const Building building = make_building(BuildingKind::maze, width, height, seed);
      for (const Edge& edge : building.edges) {
        const bool upright = edge.a.x == edge.b.x;
        ASSERT_TRUE(upright != (edge.a.y == edge.b.y));
        EXPECT_GE(length_of(edge), 1.2 - 1e-9);
        for (const Edge& other : building.edges) {
          if (&other == &edge || upright != (other.a.x == other.b.x)) continue;
          const double apart = upright ? other.a.x - edge.a.x : other.a.y - edge.a.y;
          const double before = upright ? other.a.y - edge.b.y : other.a.x - edge.b.x;
          const double after = upright ? edge.a.y - other.b.y : edge.a.x - other.b.x;
          // On one line they have a gap between them; side by side they leave a way.
          if (apart == 0.0) {
            EXPECT_GE(std::max(before, after), 1.2 - 1e-9);
          } else if (std::max(before, after) < 0.0) {
            EXPECT_GE(std::abs(apart), 1.2 - 1e-9);
          }
        }
      }
      if (width < 10.0) continue;
      // Lines of walls stand a way apart. In a small maze a line may have lost all its walls to loops.
      std::set<double> xs, ys;
      for (const Edge& edge : building.edges) {
        xs.insert({edge.a.x, edge.b.x});
        ys.insert({edge.a.y, edge.b.y});
      }
      for (const auto& [lines, side] : {std::pair{xs, width}, std::pair{ys, height}}) {
        EXPECT_EQ(*lines.begin(), 0.0);
        EXPECT_EQ(*lines.rbegin(), side);
        for (auto line = std::next(lines.begin()); line != lines.end(); ++line) {
          EXPECT_LE(*line - *std::prev(line), 2.5 + 1e-9);
          EXPECT_GE(*line - *std::prev(line), 1.2 - 1e-9);
        }
      }
    }
  }
}

/// Sizes of the places, in cells, where a robot could stand if it came there: all but the outside.
std::vector<int> places_to_stand(const Building& building, double robot_radius) {
  const double cell = FloorPlan::kCell;
  const int columns = static_cast<int>(building.width / cell) + 40;
  const int rows = static_cast<int>(building.height / cell) + 40;
  std::vector<int> part(static_cast<std::size_t>(columns) * rows, -1);  // -1 free, -2 near an edge
  const int reach = static_cast<int>(robot_radius / cell);
  for (const Edge& edge : building.edges) {
    const int pieces = std::max(1, static_cast<int>(length_of(edge) / (0.5 * cell)));
    for (int i = 0; i <= pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      const int x = static_cast<int>((edge.a.x + share * (edge.b.x - edge.a.x)) / cell + 20.0);
      const int y = static_cast<int>((edge.a.y + share * (edge.b.y - edge.a.y)) / cell + 20.0);
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx)
          part[static_cast<std::size_t>(y + dy) * columns + x + dx] = -2;
      }
    }
  }
  std::vector<int> sizes;
  for (std::size_t seed = 0; seed < part.size(); ++seed) {
    if (part[seed] != -1) continue;
    std::vector<std::size_t> todo{seed};
    part[seed] = static_cast<int>(sizes.size());
    int size = 0;
    while (!todo.empty()) {
      const std::size_t at = todo.back();
      todo.pop_back();
      ++size;
      const int x = static_cast<int>(at) % columns, y = static_cast<int>(at) / columns;
      for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
        if (x + dx < 0 || y + dy < 0 || x + dx >= columns || y + dy >= rows) continue;
        const std::size_t next = static_cast<std::size_t>(y + dy) * columns + x + dx;
        if (part[next] != -1) continue;
        part[next] = part[seed];
        todo.push_back(next);
      }
    }
    sizes.push_back(size);
  }
  sizes.erase(sizes.begin());  // the outside, which has the first cell
  return sizes;
}

TEST(PlainKinds, EveryPlaceCanBeReached) {
  for (const BuildingKind kind : {BuildingKind::corridor, BuildingKind::maze, BuildingKind::bare}) {
    for (const auto& [width, height] :
         {std::pair{8.0, 8.0}, std::pair{8.0, 30.0}, std::pair{40.0, 25.0}, std::pair{90.0, 20.0}}) {
      for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const Building building = make_building(kind, width, height, seed);
        const std::vector<int> places = places_to_stand(building, 0.2);
        // What is left of a pillar's inside is far smaller than a room.
        EXPECT_EQ(std::count_if(places.begin(), places.end(), [](int cells) { return cells > 60; }), 1)
            << name_of(kind) << " " << width << " x " << height << " " << seed;
      }
    }
  }
}

TEST(Corridor, GoesAlongTheLongerSideInLongBareWalls) {
  for (const auto& [width, height] : {std::pair{60.0, 20.0}, std::pair{20.0, 60.0}}) {
    const bool upright = height > width;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      SCOPED_TRACE(std::to_string(width) + " " + std::to_string(seed));
      const Building building = make_building(BuildingKind::corridor, width, height, seed);
      double low = 1e9, high = -1e9, bare = 0.0;
      for (const Edge& edge : building.edges) {
        for (const Point2& p : {edge.a, edge.b}) {
          low = std::min(low, upright ? p.y : p.x);
          high = std::max(high, upright ? p.y : p.x);
        }
        if (length_of(edge) > 4.0) bare += 0.5 * length_of(edge);  // walls have two faces
      }
      EXPECT_NEAR(low, 0.0, 0.1);
      EXPECT_NEAR(high, 60.0, 0.1);
      EXPECT_GT(bare, 60.0);  // of about 120 m on both sides
    }
  }
}

TEST(Bare, HoldsNoFurniture) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Building building = make_building(BuildingKind::bare, 40.0, 25.0, seed);
    const auto is_inside = [](Point2 p) { return p.x > 5.5 && p.x < 34.5 && p.y > 5.5 && p.y < 19.5; };
    for (const Edge& edge : building.edges) {
      if (is_inside(edge.a) && is_inside(edge.b)) {
        ASSERT_LT(length_of(edge), 0.31) << seed;  // one of eight sides of a pillar
      }
    }
  }
}

TEST(PaintedFloor, AddsOnlyWhereThereIsRoom) {
  PaintedFloor floor({0.0, 0.0, 20.0, 10.0});
  const Room hall{2.0, 2.0, 18.0, 8.0};
  floor.paint(hall, floor.new_space());
  const auto niche = floor.beside(hall, Side::top, 3.0, 2.0, 1.0);
  ASSERT_TRUE(niche);
  EXPECT_EQ(std::tuple(niche->left, niche->bottom, niche->right, niche->top), std::tuple(5.0, 8.0, 7.0, 9.0));
  floor.paint(*niche, 1);
  EXPECT_FALSE(floor.beside(hall, Side::top, 5.2, 2.0, 1.0));  // too near to it
  EXPECT_TRUE(floor.beside(hall, Side::top, 5.4, 2.0, 1.0));
  EXPECT_FALSE(floor.beside(hall, Side::left, 1.0, 2.0, 2.1));   // leaves the frame
  EXPECT_FALSE(floor.beside(hall, Side::right, 5.0, 2.0, 1.0));  // longer than the side
}

TEST(PaintedFloor, StandsWallsWhereSpacesMeet) {
  PaintedFloor floor({0.0, 0.0, 10.0, 10.0});
  const Room left{0.0, 0.0, 5.0, 4.0}, right{5.0, 0.0, 10.0, 4.0};
  const int space = floor.new_space();
  floor.paint(left, space);
  floor.paint(right, space);  // one space: no wall between
  const Room upper{0.0, 4.0, 10.0, 8.0};
  floor.paint(upper, floor.new_space());
  floor.open(left, Side::top, 1.0, 1.0);
  Draughtsman pen;
  floor.draw_walls(pen);
  EXPECT_EQ(pen.edges.size(), 4U * 6U);  // four outer walls, and two pieces with the opening between
  const FloorPlan plan(pen.edges, 0.2);
  const auto is_free = [&](double x, double y) { return plan.is_free(plan.cell_at({x, y})); };
  EXPECT_TRUE(is_free(5.0, 2.0));
  EXPECT_TRUE(is_free(1.5, 4.0));
  EXPECT_TRUE(is_free(5.0, 6.0));
  EXPECT_FALSE(is_free(5.0, 4.0));
}

}  // namespace
}  // namespace gridmerge
