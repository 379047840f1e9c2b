// SPDX-License-Identifier: Apache-2.0
#include "merge/elastic.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/merge/merge.hpp"
#include "merge/doubled_walls.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// A smooth deformation of a building of 18 m x 13 m that shifts its points by up to `amount` metres.
Deformation any_bend(unsigned seed, double amount) {
  std::mt19937 random(seed);
  const auto number = [&] { return amount * (2.0 * static_cast<double>(random() % 10001) / 10000.0 - 1.0); };
  std::vector<Point2> shifts;
  for (int i = 0; i < 6 * 6; ++i) {
    const double x = number(), y = number();
    shifts.push_back({x, y});
  }
  return {SE2{-1.0, -4.0, 0.1}, 7.0, 6, 6, shifts};
}

/// Bent maps of one building, all placed as if they were straight.
struct BentTeam {
  explicit BentTeam(double amount, std::size_t count = 3) {
    for (std::size_t i = 0; i < count; ++i) {
      bends.push_back(any_bend(static_cast<unsigned>(i), amount));
      maps.push_back(bent_map(building, bends.back()));
    }
    for (const OccupancyGrid& map : maps) prepared.push_back(std::make_unique<PreparedMap>(map));
    for (const auto& map : prepared) members.push_back({map.get(), {}, false});
  }

  /// How far off the places of the building lie in two maps that are bent back so [m, root mean square].
  double residual(const std::vector<BentMember>& bent, std::size_t a, std::size_t b) const {
    double sum = 0.0, count = 0.0;
    for (double x = 0.5; x < 18.0; x += 0.5) {
      for (double y = 0.5; y < 13.0; y += 0.5) {
        const Point2 in_a = bent[a].T_group_map * bent[a].deformation.bend(bends[a].bend({x, y}));
        const Point2 in_b = bent[b].T_group_map * bent[b].deformation.bend(bends[b].bend({x, y}));
        sum += std::pow(in_a.x - in_b.x, 2) + std::pow(in_a.y - in_b.y, 2);
        count += 1.0;
      }
    }
    return std::sqrt(sum / count);
  }

  std::vector<BentMember> straight() const {
    std::vector<BentMember> bent;
    for (const RigidMember& member : members) bent.push_back({member.T_group_map, {}});
    return bent;
  }

  OccupancyGrid building = test::draw_building(1);
  std::vector<Deformation> bends;
  std::vector<OccupancyGrid> maps;
  std::vector<std::unique_ptr<PreparedMap>> prepared;
  std::vector<RigidMember> members;
};

TEST(Bend, LaysBentMapsOnEachOther) {
  const BentTeam team(0.6);
  const std::vector<BentMember> bent = bend(team.members, 0.3);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = a + 1; b < 3; ++b) {
      const double before = team.residual(team.straight(), a, b), after = team.residual(bent, a, b);
      EXPECT_GT(before, 0.2);
      EXPECT_LT(after, 0.4 * before) << a << " and " << b << ": " << before;
    }
    EXPECT_GT(bent[a].deformation.strain_bound(), 0.0);
  }
}

// To the bit: there is nothing that walls held out of the fit would say better.
TEST(Bend, LeavesStraightMapsStraight) {
  BentTeam team(0.0);
  for (const double sd : {0.1, 0.5}) {
    const std::vector<BentMember> bent = bend(team.members, sd);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(bent[i].deformation.is_identity()) << sd;
      EXPECT_EQ(bent[i].T_group_map, team.members[i].T_group_map);
    }
  }
}

TEST(Bend, KeepsHeldMapsAndThoseThatMeetNothing) {
  BentTeam team(0.6);
  team.members[1].held = true;
  const PreparedMap far(test::draw_building(2)), blank(make_grid(4, 4, 0.05));
  team.members.push_back({&far, {500.0, 0.0, 0.3}, false});
  team.members.push_back({&blank, {1.0, 0.0, 0.3}, false});
  const std::vector<BentMember> bent = bend(team.members, 0.3);
  for (const std::size_t straight : {1U, 3U, 4U}) {
    EXPECT_EQ(bent[straight].T_group_map, team.members[straight].T_group_map);
    EXPECT_TRUE(bent[straight].deformation.is_identity());
  }
  for (const std::size_t i : {0U, 2U})
    EXPECT_LT(team.residual(bent, i, 1), 0.5 * team.residual(team.straight(), i, 1));
}

/// Each map's best linear fit of where its cells go, as strongly as it has cells: summed over the maps.
struct MeanLinear {
  double xx = 0.0, shear = 0.0, yy = 0.0;  // of the strain
  double turn = 0.0, x = 0.0, y = 0.0;     // the largest rigid part
};
MeanLinear mean_linear(const BentTeam& team, const std::vector<BentMember>& bent) {
  MeanLinear mean;
  double all = 0.0;
  for (std::size_t i = 0; i < bent.size(); ++i) {
    const OccupancyGrid& map = team.prepared[i]->known();
    double n = 0.0, sx = 0.0, sy = 0.0, ux = 0.0, uy = 0.0;
    std::vector<std::array<double, 4>> points;
    for (int row = 0; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        if (map.at(column, row) == Cell::unknown) continue;
        const Point2 p = map.cell_centre(column, row), s = bent[i].T_group_map * p,
                     b = bent[i].T_group_map * bent[i].deformation.bend(p);
        points.push_back({s.x, s.y, b.x - s.x, b.y - s.y});
        n += 1.0;
        sx += s.x;
        sy += s.y;
        ux += b.x - s.x;
        uy += b.y - s.y;
      }
    }
    double xx = 0.0, xy = 0.0, yy = 0.0, uxx = 0.0, uxy = 0.0, uyx = 0.0, uyy = 0.0;
    for (const auto& [x, y, u, v] : points) {
      const double dx = x - sx / n, dy = y - sy / n;
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
      uxx += u * dx;
      uxy += u * dy;
      uyx += v * dx;
      uyy += v * dy;
    }
    const double d = xx * yy - xy * xy;
    mean.xx += n * (uxx * yy - uxy * xy) / d;
    mean.yy += n * (uyy * xx - uyx * xy) / d;
    mean.shear += n * 0.5 * (uxy * xx - uxx * xy + uyx * yy - uyy * xy) / d;
    all += n;
    mean.x = std::max(mean.x, std::abs(ux / n));
    mean.y = std::max(mean.y, std::abs(uy / n));
    mean.turn = std::max(mean.turn, std::abs((uyx - uxy) / (xx + yy)));
  }
  mean.xx /= all;
  mean.yy /= all;
  mean.shear /= all;
  return mean;
}

TEST(Bend, HasNoMeanStrainAndNoRigidPart) {
  const BentTeam team(0.6);
  const MeanLinear mean = mean_linear(team, bend(team.members, 0.3));
  EXPECT_LT(std::abs(mean.xx), 1e-3);  // the poses' turns are taken out last
  EXPECT_LT(std::abs(mean.yy), 1e-3);
  EXPECT_LT(std::abs(mean.shear), 1e-3);
  EXPECT_LT(mean.turn, 1e-3);
  EXPECT_LT(mean.x, 0.01);
  EXPECT_LT(mean.y, 0.01);
}

TEST(Bend, IsTheSameForAnyNumberOfThreads) {
  const BentTeam team(0.6);
  std::vector<BentMember> one, several;
  with_threads(1, [&] { one = bend(team.members, 0.3); });
  with_threads(4, [&] { several = bend(team.members, 0.3); });
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(one[i].T_group_map, several[i].T_group_map);
    EXPECT_EQ(one[i].deformation, several[i].deformation);
  }
}

/// Where the members of a result put a point, by map.
std::vector<Point2> places(const MergeResult& result, const Point2& p, std::size_t maps) {
  std::vector<Point2> places(maps);
  for (const Member& member : result.components.at(0).members) places[member.map] = member.to_component(p);
  return places;
}

TEST(Merge, ElasticMakesOneSharpMapOfBentOnes) {
  const BentTeam team(0.5);
  MergeOptions options;
  const MergeResult rigid = merge(team.maps, options);
  options.transform = MapTransform::elastic;
  const MergeResult elastic = merge(team.maps, options);
  ASSERT_EQ(rigid.components.size(), 1u);
  ASSERT_EQ(elastic.components.size(), 1u);
  ASSERT_EQ(elastic.components[0].members.size(), 3u);
  EXPECT_EQ(elastic.components[0].members[0].T_component_map, SE2{});
  const double before = measure_doubled_walls(team.maps, rigid.components[0]).share();
  const double after = measure_doubled_walls(team.maps, elastic.components[0]).share();
  EXPECT_GT(before, 0.1);
  EXPECT_LT(after, 0.3 * before);
  EXPECT_LT(count_cells(elastic.components[0].fused.grid).occupied,
            count_cells(rigid.components[0].fused.grid).occupied);
  EXPECT_FALSE(elastic.components[0].fused.omega);
  // Which maps join, and how sure that is, stays.
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(elastic.components[0].members[i].probability, rigid.components[0].members[i].probability);
  for (const Member& member : elastic.components[0].members) {
    const Point2 p{7.0, 4.0}, back = member.to_map(member.to_component(p));
    EXPECT_LT(std::hypot(back.x - p.x, back.y - p.y), 1e-6);
  }
}

TEST(Merge, ElasticDoesNotDependOnTheOrderOfTheMaps) {
  const BentTeam team(0.5);
  MergeOptions options;
  options.transform = MapTransform::elastic;
  const std::vector<OccupancyGrid> turned{team.maps[2], team.maps[0], team.maps[1]};
  const std::vector<Point2> a = places(merge(team.maps, options), {6.0, 5.0}, 3);
  const std::vector<Point2> b = places(merge(turned, options), {6.0, 5.0}, 3);
  const auto apart = [](const Point2& p, const Point2& q) { return std::hypot(p.x - q.x, p.y - q.y); };
  EXPECT_NEAR(apart(a[0], a[1]), apart(b[1], b[2]), 1e-9);
  EXPECT_NEAR(apart(a[0], a[2]), apart(b[1], b[0]), 1e-9);
}

TEST(Merge, ElasticKeepsFixedMapsStraight) {
  const BentTeam team(0.5);
  MergeOptions options;
  options.transform = MapTransform::elastic;
  const SE2 T_world{3.0, -2.0, 0.4};
  const MergeResult result = merge(team.maps, options, {std::nullopt, KnownPose{T_world, 0.0, 0.0, true}});
  ASSERT_EQ(result.components.size(), 1u);
  const std::vector<Member>& members = result.components[0].members;
  EXPECT_EQ(members[1].T_component_map, T_world);
  EXPECT_TRUE(members[1].deformation.is_identity());
  EXPECT_FALSE(members[0].deformation.is_identity());
  EXPECT_LT(measure_doubled_walls(team.maps, result.components[0]).share(), 0.05);
}

// A copy lies on its original, however that is bent, from whatever frame it is seen.
TEST(Merge, ElasticBendsACopyAsItsOriginal) {
  BentTeam team(0.5);
  team.maps.push_back(team.maps[1]);
  const SE2 T_copy_original{4.0, 1.0, 0.9};
  team.maps.back().origin = T_copy_original * team.maps[1].origin;
  MergeOptions options;
  options.transform = MapTransform::elastic;
  const MergeResult result = merge(team.maps, options);
  ASSERT_EQ(result.components.size(), 1u);
  ASSERT_EQ(result.components[0].members.size(), 4u);
  const Member &original = result.components[0].members[1], &copy = result.components[0].members[3];
  ASSERT_FALSE(copy.deformation.is_identity());
  const Point2 p{5.0, 6.0}, a = original.to_component(p), b = copy.to_component(T_copy_original * p);
  EXPECT_LT(std::hypot(a.x - b.x, a.y - b.y), 1e-9);
}

}  // namespace
}  // namespace gridmerge
