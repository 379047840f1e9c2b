// SPDX-License-Identifier: Apache-2.0
#include "merge/stretch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/merge/merge.hpp"
#include "merge/doubled_walls.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

const Point2 kMiddle{9.0, 6.5};  // of the building
// Walls are drawn in cells of 0.1 m, and all maps have the same rows: half a cell on 9 m.
constexpr double kHalfCell = 0.05;  // [m]
constexpr double kClose = 8e-3;     // of a scale

/// The linear function with these entries that leaves the building's middle where it is.
Affine about_middle(double xx, double xy, double yx, double yy) {
  Affine affine{xx, xy, yx, yy, {}};
  const Point2 moved = affine * kMiddle;
  affine.shift = {kMiddle.x - moved.x, kMiddle.y - moved.y};
  return affine;
}
Affine scaled(double scale) {
  return about_middle(scale, 0.0, 0.0, scale);
}

/// The same on a lattice that is wider than the building.
Deformation lattice_of(const Affine& affine) {
  constexpr double kSpacing = 60.0;
  const SE2 frame{kMiddle.x - 0.5 * kSpacing, kMiddle.y - 0.5 * kSpacing, 0.0};
  std::vector<Point2> shifts;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const Point2 at = frame * Point2{(column - 1) * kSpacing, (row - 1) * kSpacing}, moved = affine * at;
      shifts.push_back({moved.x - at.x, moved.y - at.y});
    }
  }
  return {frame, kSpacing, 4, 4, shifts};
}

/// Maps of one building, each drawn by another affine function and placed as if it were not.
struct StretchedTeam {
  explicit StretchedTeam(std::vector<Affine> of_maps) : drawn(std::move(of_maps)) {
    for (const Affine& affine : drawn) maps.push_back(bent_map(building, lattice_of(affine)));
    for (const OccupancyGrid& map : maps) prepared.push_back(std::make_unique<PreparedMap>(map));
    for (const auto& map : prepared) members.push_back({map.get(), {}, false});
  }

  /// How far off the places of the building lie in two maps, once stretched so [m, root mean square].
  double residual(const std::vector<BentMember>& stretched, std::size_t a, std::size_t b) const {
    double sum = 0.0, count = 0.0;
    for (double x = 0.5; x < 18.0; x += 0.5) {
      for (double y = 0.5; y < 13.0; y += 0.5) {
        const auto at = [&](std::size_t map) {
          return stretched[map].T_group_map * stretched[map].deformation.bend(drawn[map] * Point2{x, y});
        };
        sum += std::pow(at(a).x - at(b).x, 2) + std::pow(at(a).y - at(b).y, 2);
        count += 1.0;
      }
    }
    return std::sqrt(sum / count);
  }

  std::vector<BentMember> as_drawn() const {
    return std::vector<BentMember>(maps.size(), BentMember{{}, {}});
  }

  OccupancyGrid building = test::draw_building(1);
  std::vector<Affine> drawn;
  std::vector<OccupancyGrid> maps;
  std::vector<std::unique_ptr<PreparedMap>> prepared;
  std::vector<RigidMember> members;
};

double scale_of(const BentMember& member) {
  return member.deformation.affine()->scale();
}

// Whatever scales the maps were drawn at, within a few per cent: they are found, but for one that all share.
TEST(Stretch, FindsTheScalesOfMaps) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 random(seed);
    const auto any_scale = [&] { return 0.97 + 0.06 * static_cast<double>(random() % 10001) / 10000.0; };
    const double one = any_scale(), two = any_scale();
    const StretchedTeam team({scaled(one), scaled(two), scaled(0.97), scaled(1.03)});
    const std::vector<BentMember> stretched = stretch(team.members, 0.15, MapTransform::similarity);
    double sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(stretched[i].deformation.kind(), MapTransform::similarity);
      EXPECT_NEAR(scale_of(stretched[i]) * team.drawn[i].scale(),
                  scale_of(stretched[0]) * team.drawn[0].scale(), kClose)
          << seed << ": " << one << ", " << two;
      sum += std::log(scale_of(stretched[i]));
      EXPECT_LT(team.residual(stretched, 0, i), kHalfCell) << seed;
    }
    EXPECT_NEAR(sum, 0.0, 1e-9);
  }
}

// Shear and scales along two axes, which no similarity has.
TEST(Stretch, FindsShear) {
  const StretchedTeam team(
      {scaled(1.0), about_middle(1.0, 0.03, 0.01, 1.0), about_middle(1.02, 0.0, 0.0, 0.985)});
  const std::vector<BentMember> similar = stretch(team.members, 0.15, MapTransform::similarity);
  const std::vector<BentMember> affine = stretch(team.members, 0.15, MapTransform::affine);
  double xx = 0.0, yy = 0.0, shear = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t other = (i + 1) % 3;
    EXPECT_EQ(affine[i].deformation.kind(), MapTransform::affine);
    EXPECT_GT(team.residual(team.as_drawn(), i, other), 0.1);
    EXPECT_GT(team.residual(similar, i, other), 0.05);
    EXPECT_LT(team.residual(affine, i, other), kHalfCell);
    // To first order the logarithm of the stretch.
    const Affine in_map = *affine[i].deformation.affine();
    xx += in_map.xx - 1.0;
    yy += in_map.yy - 1.0;
    shear += in_map.xy + in_map.yx;
    EXPECT_GT(in_map.determinant(), 0.0);
  }
  EXPECT_NEAR(xx, 0.0, 1e-3);
  EXPECT_NEAR(yy, 0.0, 1e-3);
  EXPECT_NEAR(shear, 0.0, 1e-3);
}

// To the bit: no walls that were held out of the fit would come nearer to each other.
TEST(Stretch, LeavesMapsOfOneScaleAsTheyAre) {
  for (const double scale : {1.0, 1.04}) {
    const StretchedTeam team({scaled(scale), scaled(scale), scaled(scale)});
    for (const MapTransform transform : {MapTransform::similarity, MapTransform::affine}) {
      for (const double sd : {0.1, 0.5}) {
        for (const BentMember& member : stretch(team.members, sd, transform)) {
          EXPECT_TRUE(member.deformation.is_identity()) << scale << ", " << sd;
          EXPECT_EQ(member.T_group_map, SE2{});
        }
      }
    }
  }
}

TEST(Stretch, HeldMapsHaveTheScaleOfTheirPart) {
  StretchedTeam team({scaled(1.02), scaled(1.0), scaled(0.98)});
  team.members[0].held = true;
  const PreparedMap far(test::draw_building(2)), blank(make_grid(4, 4, 0.05));
  team.members.push_back({&far, {500.0, 0.0, 0.3}, false});
  team.members.push_back({&blank, {1.0, 0.0, 0.3}, false});
  const std::vector<BentMember> stretched = stretch(team.members, 0.15, MapTransform::similarity);
  for (const std::size_t same : {0U, 3U, 4U}) {
    EXPECT_EQ(stretched[same].T_group_map, team.members[same].T_group_map);
    EXPECT_TRUE(stretched[same].deformation.is_identity());
  }
  EXPECT_NEAR(scale_of(stretched[1]), 1.02, kClose);
  EXPECT_NEAR(scale_of(stretched[2]), 1.02 / 0.98, kClose);
}

// Each part by itself: far from each other, they have no walls in common.
TEST(Stretch, PartsHaveScalesOfTheirOwn) {
  StretchedTeam team({scaled(1.03), scaled(1.0), scaled(1.0), scaled(1.0)});
  for (const std::size_t i : {2U, 3U}) team.members[i].T_group_map = {300.0, 0.0, 1.0};
  const std::vector<BentMember> stretched = stretch(team.members, 0.15, MapTransform::similarity);
  EXPECT_NEAR(scale_of(stretched[0]), 1.0 / std::sqrt(1.03), kClose);
  EXPECT_NEAR(scale_of(stretched[1]), std::sqrt(1.03), kClose);
  for (const std::size_t i : {2U, 3U}) {
    EXPECT_TRUE(stretched[i].deformation.is_identity());
    EXPECT_EQ(stretched[i].T_group_map, team.members[i].T_group_map);
  }
}

// However walls lie: maps of unrelated buildings on each other, and far too large a difference.
TEST(Stretch, NeverStretchesByMoreThanItMay) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    StretchedTeam team({scaled(1.0), scaled(1.25), about_middle(0.8, 0.2, -0.1, 1.1)});
    const PreparedMap other(test::draw_building(seed + 1));
    team.members.push_back({&other, {0.3 * seed, -0.2, 0.1 * seed}, false});
    for (const MapTransform transform : {MapTransform::similarity, MapTransform::affine}) {
      for (const BentMember& member : stretch(team.members, 0.5, transform)) {
        const Affine affine = *member.deformation.affine();
        const double mean = std::hypot(affine.xx + affine.yy, affine.yx - affine.xy) / 2.0;
        const double apart = std::hypot(affine.xx - affine.yy, affine.yx + affine.xy) / 2.0;
        EXPECT_LE(mean + apart, kMostStretch + 1e-9);
        EXPECT_GE(mean - apart, 1.0 / kMostStretch - 1e-9);
      }
    }
  }
}

TEST(Stretch, IsTheSameForAnyNumberOfThreads) {
  const StretchedTeam team({scaled(1.03), scaled(1.0), scaled(0.99)});
  for (const MapTransform transform : {MapTransform::similarity, MapTransform::affine}) {
    std::vector<BentMember> one, several;
    with_threads(1, [&] { one = stretch(team.members, 0.15, transform); });
    with_threads(4, [&] { several = stretch(team.members, 0.15, transform); });
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(one[i].T_group_map, several[i].T_group_map);
      EXPECT_EQ(one[i].deformation, several[i].deformation);
    }
  }
}

TEST(Stretch, IsForTwoTransforms) {
  EXPECT_THROW(stretch({}, 0.1, MapTransform::rigid), std::invalid_argument);
  EXPECT_THROW(stretch({}, 0.1, MapTransform::elastic), std::invalid_argument);
  EXPECT_TRUE(stretch({}, 0.1, MapTransform::affine).empty());
}

TEST(Merge, SimilarityMakesOneSharpMapOfMapsOfTwoScales) {
  const StretchedTeam team({scaled(1.0), scaled(1.04), scaled(1.0)});
  MergeOptions options;
  const MergeResult rigid = merge(team.maps, options);
  options.transform = MapTransform::similarity;
  const MergeResult similar = merge(team.maps, options);
  ASSERT_EQ(rigid.components.size(), 1u);
  ASSERT_EQ(rigid.components[0].members.size(), 3u);
  ASSERT_EQ(similar.components.size(), 1u);
  const std::vector<Member>& members = similar.components[0].members;
  ASSERT_EQ(members.size(), 3u);
  EXPECT_EQ(members[0].T_component_map, SE2{});
  const double before = measure_doubled_walls(team.maps, rigid.components[0]).share();
  EXPECT_GT(before, 0.05);
  EXPECT_LT(measure_doubled_walls(team.maps, similar.components[0]).share(), 0.2 * before);
  EXPECT_LT(count_cells(similar.components[0].fused.grid).occupied,
            count_cells(rigid.components[0].fused.grid).occupied);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(rigid.components[0].members[i].deformation.is_identity());
    EXPECT_EQ(members[i].probability, rigid.components[0].members[i].probability);
    EXPECT_EQ(members[i].deformation.kind(), MapTransform::similarity);
  }
  EXPECT_NEAR(members[0].deformation.affine()->scale() / members[1].deformation.affine()->scale(), 1.04,
              kClose);
}

TEST(Merge, AffineKeepsFixedMapsAndGivesCopiesTheStretchOfTheirOriginals) {
  StretchedTeam team({scaled(1.0), about_middle(1.03, 0.01, 0.0, 0.99)});
  team.maps.push_back(team.maps[1]);
  const SE2 T_copy_original{4.0, 1.0, 0.9};
  team.maps.back().origin = T_copy_original * team.maps[1].origin;
  MergeOptions options;
  options.transform = MapTransform::affine;
  const SE2 T_world{3.0, -2.0, 0.4};
  const MergeResult result = merge(team.maps, options, {KnownPose{T_world, 0.0, 0.0, true}});
  ASSERT_EQ(result.components.size(), 1u);
  const std::vector<Member>& members = result.components[0].members;
  ASSERT_EQ(members.size(), 3u);
  EXPECT_EQ(members[0].T_component_map, T_world);
  EXPECT_TRUE(members[0].deformation.is_identity());
  for (const Point2& p : {Point2{1.0, 1.0}, Point2{17.0, 12.0}}) {
    const Point2 drawn = team.drawn[1] * p, in_world = T_world * p;
    const Point2 a = members[1].to_component(drawn), b = members[2].to_component(T_copy_original * drawn);
    EXPECT_LT(std::hypot(a.x - in_world.x, a.y - in_world.y), 0.05);
    EXPECT_LT(std::hypot(a.x - b.x, a.y - b.y), 1e-9);
    const Point2 back = members[1].to_map(a);
    EXPECT_LT(std::hypot(back.x - drawn.x, back.y - drawn.y), 1e-8);
  }
}

}  // namespace
}  // namespace gridmerge
