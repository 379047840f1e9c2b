// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/tree.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <stdexcept>

#include "merge/drawing.hpp"
#include "merge/maps_left_out.hpp"

namespace gridmerge {
namespace {

using test::map_from;

constexpr double kPi = std::numbers::pi;
using Maps = std::set<std::size_t>;
using Comparison = std::pair<Maps, Maps>;
using Sequence = std::vector<Comparison>;

/// A world in which any two groups of maps can be compared without a search. Map i knows 2^i cells of the
/// world, in row i, so that the number of cells that a grid knows tells which maps were fused to it. Every
/// map sees the world from its own pose, turned by a multiple of 90 degrees, so that drawing it elsewhere
/// loses no cell.
class World {
 public:
  explicit World(std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      const auto turns = static_cast<double>(i % 4);
      T_world_map_.push_back({10.0 * static_cast<double>(i), -3.0, normalize_angle(turns * kPi / 2)});
      const SE2 origin_in_world{0.0, static_cast<double>(i), 0.0};
      maps_.push_back(
          make_grid(1 << i, 1, 1.0, inverse(T_world_map_.back()) * origin_in_world, Cell::occupied));
    }
  }

  const std::vector<OccupancyGrid>& maps() const { return maps_; }
  SE2 T(std::size_t to, std::size_t from) const { return inverse(T_world_map_[to]) * T_world_map_[from]; }

  static Maps maps_in(const OccupancyGrid& grid) {
    Maps found;
    for (std::size_t rest = count_cells(grid).known(); rest != 0; rest &= rest - 1) {
      found.insert(static_cast<std::size_t>(std::countr_zero(rest)));
    }
    return found;
  }

  /// Merges all maps; `fits` says whether two groups are accepted. Checks what must hold whatever it says.
  MergeResult merge_if(const std::function<bool(const Maps&, const Maps&)>& fits, TreeOptions options = {}) {
    comparisons.clear();
    const MergeResult result = merge_up_tree(
        maps_,
        [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
          comparisons.emplace_back(maps_in(fixed), maps_in(moving));
          MatchResult match;
          match.verdict = fits(maps_in(fixed), maps_in(moving)) ? Verdict::accepted : Verdict::refused;
          // A refused pair has a best hypothesis too; it must not be used.
          match.T_fixed_moving = match.verdict == Verdict::accepted
                                     ? T(*maps_in(fixed).begin(), *maps_in(moving).begin())
                                     : SE2{99.0, 99.0, 1.0};
          return match;
        },
        options);
    check(result);
    return result;
  }

  Sequence comparisons;

 private:
  void check(const MergeResult& result) const {
    const std::vector<std::size_t> alone = test::maps_left_out(result);
    Maps seen(alone.begin(), alone.end());
    EXPECT_EQ(seen.size(), result.left_out.size());
    for (const Component& component : result.components) {
      ASSERT_GE(component.members.size(), 2u);
      const std::size_t first = component.members.front().map;
      EXPECT_EQ(component.members.front().T_component_map, SE2{});
      Maps members;
      for (const Member& member : component.members) {
        EXPECT_TRUE(members.empty() || *members.rbegin() < member.map) << "ascending";
        members.insert(member.map);
        EXPECT_TRUE(seen.insert(member.map).second) << "a map is in one place only";
        const SE2 expected = T(first, member.map);
        EXPECT_NEAR(member.T_component_map.x, expected.x, 1e-9);
        EXPECT_NEAR(member.T_component_map.y, expected.y, 1e-9);
        EXPECT_NEAR(normalize_angle(member.T_component_map.theta - expected.theta), 0.0, 1e-9);
      }
      EXPECT_EQ(maps_in(component.fused.grid), members);
    }
    EXPECT_EQ(seen.size(), maps_.size()) << "every map is somewhere";
    ASSERT_EQ(result.joins.size(), comparisons.size());
    for (std::size_t i = 0; i < comparisons.size(); ++i) {
      EXPECT_EQ(result.joins[i].fixed, *comparisons[i].first.begin());
      EXPECT_EQ(result.joins[i].moving, *comparisons[i].second.begin());
      EXPECT_LT(result.joins[i].fixed, result.joins[i].moving);
    }
    EXPECT_EQ(std::set(comparisons.begin(), comparisons.end()).size(), comparisons.size())
        << "none is made twice";
  }

  std::vector<SE2> T_world_map_;
  std::vector<OccupancyGrid> maps_;
};

bool always(const Maps&, const Maps&) {
  return true;
}
bool never(const Maps&, const Maps&) {
  return false;
}

TEST(MergeUpTree, TakesNoMoreThreadsThanItMay) {
  World world(3);
  int most = 0;
  const auto note_threads = [&](const Maps&, const Maps&) {
    most = std::max(most, tbb::this_task_arena::max_concurrency());
    return true;
  };
  TreeOptions options;
  options.threads = 1;
  world.merge_if(note_threads, options);
  EXPECT_EQ(most, 1);
  options.threads = -1;
  EXPECT_THROW(world.merge_if(note_threads, options), std::invalid_argument);
}

TEST(MergeUpTree, OfNothingIsNothing) {
  const MergeResult result = World(0).merge_if(always);
  EXPECT_TRUE(result.components.empty() && result.joins.empty() && result.left_out.empty());
}

TEST(MergeUpTree, OneMapIsLeftOut) {
  const MergeResult result = World(1).merge_if(always);
  EXPECT_TRUE(result.components.empty() && result.joins.empty());
  EXPECT_EQ(test::maps_left_out(result), std::vector<std::size_t>{0});
}

TEST(MergeUpTree, TwoMapsThatFit) {
  const MergeResult result = World(2).merge_if(always);
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_EQ(result.joins.size(), 1u);
  EXPECT_EQ(result.joins[0].match.verdict, Verdict::accepted);
  EXPECT_TRUE(result.left_out.empty());
}

TEST(MergeUpTree, TwoMapsThatDoNotFit) {
  const MergeResult result = World(2).merge_if(never);
  EXPECT_TRUE(result.components.empty());
  ASSERT_EQ(result.joins.size(), 1u);
  EXPECT_EQ(result.joins[0].match.verdict, Verdict::refused);
  EXPECT_EQ(test::maps_left_out(result), (std::vector<std::size_t>{0, 1}));
}

TEST(MergeUpTree, ClimbsABinaryTree) {
  World world(5);
  const MergeResult result = world.merge_if(always);
  EXPECT_EQ(world.comparisons, (Sequence{{{0}, {1}}, {{2}, {3}}, {{0, 1}, {2, 3}}, {{0, 1, 2, 3}, {4}}}));
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_EQ(result.components[0].members.size(), 5u);
}

TEST(MergeUpTree, TriesEveryPairOnceWhenNothingFits) {
  World world(5);
  EXPECT_EQ(world.merge_if(never).left_out.size(), 5u);
  EXPECT_EQ(world.comparisons.size(), 10u);
}

TEST(MergeUpTree, AMapThatIsRefusedJoinsLaterWhenItsNeighbourHas) {
  World world(3);  // a row of rooms in the order 0, 2, 1: 1 does not fit 0 alone
  const auto fits = [](const Maps& a, const Maps& b) { return a.contains(2) || b.contains(2); };
  const MergeResult result = world.merge_if(fits);
  EXPECT_EQ(world.comparisons, (Sequence{{{0}, {1}}, {{0}, {2}}, {{0, 2}, {1}}}));
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_TRUE(result.left_out.empty());
}

TEST(MergeUpTree, AGroupThatWasRefusedIsTriedAgainWhenItHasGrown) {
  // 3 fits nothing until 0, 1 and 2 are one: it is refused below as itself, and by each of the smaller
  // groups.
  World world(4);
  const auto fits = [](const Maps& a, const Maps& b) {
    return (!a.contains(3) && !b.contains(3)) || a.size() + b.size() == 4;
  };
  const MergeResult result = world.merge_if(fits);
  EXPECT_EQ(world.comparisons, (Sequence{{{0}, {1}}, {{2}, {3}}, {{0, 1}, {2}}, {{0, 1, 2}, {3}}}));
  EXPECT_TRUE(result.left_out.empty());
}

TEST(MergeUpTree, TwoBuildingsAreTwoComponentsAndAStrangerIsLeftOut) {
  World world(7);
  const auto building = [](const Maps& maps) {
    return *maps.begin() == 5 ? 2 : *maps.begin() % 3 == 0 && *maps.begin() < 6 ? 0 : 1;
  };
  const MergeResult result =
      world.merge_if([&](const Maps& a, const Maps& b) { return building(a) == building(b); });
  ASSERT_EQ(result.components.size(), 2u);
  EXPECT_EQ(result.components[0].members.size(), 4u) << "most members first";
  EXPECT_EQ(result.components[0].members[0].map, 1u);
  EXPECT_EQ(result.components[1].members.size(), 2u);
  EXPECT_EQ(result.components[1].members[0].map, 0u);
  EXPECT_EQ(test::maps_left_out(result), std::vector<std::size_t>{5});
}

TEST(MergeUpTree, SingleMapsAreComparedAsTheyCame) {
  World world(2);
  merge_up_tree(world.maps(), [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    EXPECT_EQ(&fixed, &world.maps()[0]);
    EXPECT_EQ(&moving, &world.maps()[1]);
    return MatchResult{};
  });
}

TEST(MergeUpTree, GroupsAreComparedAsTheFusionOfTheOriginals) {
  // Fused twice, the wall that 1, 2 and 3 do not see would have another probability.
  std::vector<OccupancyGrid> maps(5, map_from({"."}));
  maps[0] = map_from({"#"});
  maps[4] = map_from({"#."});
  const MergeResult result = merge_up_tree(maps, [&](const OccupancyGrid& fixed,
                                                     const OccupancyGrid& moving) {
    if (moving.width == 2) {
      const FusedMap expected = fuse({{&maps[0], {}}, {&maps[1], {}}, {&maps[2], {}}, {&maps[3], {}}}, 1.0);
      EXPECT_EQ(fixed.probability, expected.grid.probability);
    }
    MatchResult match;
    match.verdict = Verdict::accepted;
    return match;
  });
  ASSERT_EQ(result.components.size(), 1u);
  std::vector<PlacedMap> inputs;
  for (const OccupancyGrid& map : maps) inputs.push_back({&map, {}});
  EXPECT_EQ(result.components[0].fused.grid.probability, fuse(inputs, 1.0).grid.probability);
}

TEST(MergeUpTree, TheSameMapTwiceIsOneMapSeenTwice) {
  const OccupancyGrid map = map_from({"#..", ".##"}, 0.05, {1.0, 2.0, 0.4});
  MatchResult same;
  same.verdict = Verdict::accepted;
  const MergeResult result = merge_up_tree({map, map}, [&](const auto&, const auto&) { return same; });
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_EQ(result.components[0].fused.conflicting, 0u);
  EXPECT_EQ(result.components[0].fused.agreeing, count_cells(result.components[0].fused.grid).known());
}

TEST(MergeUpTree, ResolutionIsTheFinestOfTheMembersOrTheOneAskedFor) {
  std::vector<OccupancyGrid> maps{make_grid(8, 8, 0.1, {}, Cell::free), make_grid(8, 8, 0.2, {}, Cell::free),
                                  make_grid(8, 8, 0.05, {}, Cell::free)};
  const Matcher matcher = [](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    MatchResult match;  // the finest map is left out
    match.verdict =
        fixed.resolution == 0.05 || moving.resolution == 0.05 ? Verdict::refused : Verdict::accepted;
    return match;
  };
  EXPECT_EQ(merge_up_tree(maps, matcher).components.at(0).fused.grid.resolution, 0.1);
  TreeOptions options;
  options.resolution = 0.4;
  EXPECT_EQ(merge_up_tree(maps, matcher, options).components.at(0).fused.grid.resolution, 0.4);
}

TEST(MergeUpTree, ReportsProgress) {
  std::vector<std::pair<std::size_t, std::size_t>> reports;
  TreeOptions options;
  options.progress = [&](std::size_t done, std::size_t expected) { reports.emplace_back(done, expected); };
  using Reports = decltype(reports);
  World(4).merge_if(never, options);
  EXPECT_EQ(reports, (Reports{{1, 6}, {2, 6}, {3, 6}, {4, 6}, {5, 6}, {6, 6}}));
  reports.clear();
  World(4).merge_if(always, options);
  EXPECT_EQ(reports, (Reports{{1, 4}, {2, 3}, {3, 3}}));
}

TEST(MergeUpTree, NamesTheInvalidMap) {
  std::vector<OccupancyGrid> maps = World(3).maps();
  maps[2].resolution = -1.0;
  try {
    merge_up_tree(maps, [](const auto&, const auto&) { return MatchResult{}; });
    FAIL() << "must throw";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("map 2: "), std::string::npos) << error.what();
  }
}

TEST(MergeUpTree, RefusesAnInvalidResolution) {
  for (const double resolution : {-1.0, std::nan(""), HUGE_VAL}) {
    TreeOptions options;
    options.resolution = resolution;
    EXPECT_THROW(merge_up_tree(
                     {}, [](const auto&, const auto&) { return MatchResult{}; }, options),
                 std::invalid_argument)
        << resolution;
  }
}

// Two groups fit when a map of one and a map of the other do. Then what is joined must be what is connected.
RC_GTEST_PROP(MergeUpTree, FindsTheConnectedComponents, ()) {
  const auto size = static_cast<std::size_t>(*rc::gen::inRange(1, 10));
  const auto density = *rc::gen::inRange(0, 100);
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<std::vector<bool>> fits(size, std::vector<bool>(size));
  std::vector<std::size_t> label(size);
  for (std::size_t i = 0; i < size; ++i) label[i] = i;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (static_cast<int>(random() % 100) >= density) continue;
      fits[i][j] = fits[j][i] = true;
      const std::size_t from = label[i], to = label[j];
      for (std::size_t& l : label) l = l == from ? to : l;
    }
  }
  World world(size);
  const MergeResult result = world.merge_if([&](const Maps& a, const Maps& b) {
    for (const std::size_t i : a) {
      for (const std::size_t j : b) {
        if (fits[i][j]) return true;
      }
    }
    return false;
  });
  for (const Component& component : result.components) {
    const std::size_t of_first = label[component.members[0].map];
    for (std::size_t i = 0; i < size; ++i) {
      const bool is_member = std::any_of(component.members.begin(), component.members.end(),
                                         [&](const Member& member) { return member.map == i; });
      RC_ASSERT(is_member == (label[i] == of_first));
    }
  }
  for (const std::size_t alone : test::maps_left_out(result))
    RC_ASSERT(std::count(label.begin(), label.end(), label[alone]) == 1);
  RC_ASSERT(world.comparisons.size() <= std::max<std::size_t>(1, (size - 1) * (size - 1)));
}

}  // namespace
}  // namespace gridmerge
