// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstddef>
#include <numbers>
#include <random>

#include "gridmerge/grid/execution.hpp"
#include "merge/consistent_set.hpp"

namespace gridmerge::internal {
namespace {

struct Dice {
  std::mt19937 random{1};

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
};

/// A campus: buildings of five maps, of which most pairs are found, and for each map three pairs with maps of
/// other buildings, which propose poses that are not believed.
JoinProblem campus(std::size_t maps) {
  Dice dice;
  JoinProblem problem;
  std::vector<SE2> T_world_map;
  for (std::size_t i = 0; i < maps; ++i) {
    problem.maps.push_back({{{0.0, 0.0}, 10.0, 30.0}});
    T_world_map.push_back({dice.uniform(-20.0, 20.0), dice.uniform(-20.0, 20.0), dice.uniform(-3.0, 3.0)});
  }
  for (std::size_t a = 0; a < maps; ++a) {
    const std::size_t end = std::min(maps, (a / 5 + 1) * 5);
    for (std::size_t b = a + 1; b < end; ++b) {
      if (dice.random() % 4 != 0)
        problem.pairs.push_back(
            {a, b, {{inverse(T_world_map[a]) * T_world_map[b], dice.uniform(3.0, 9.0), 0.2}}});
    }
    if (end == maps) continue;
    std::size_t b = end;
    for (int i = 0; i < 3; ++i) {
      b += 1 + dice.random() % (1 + (maps - end) / 4);
      if (b >= maps) break;
      problem.pairs.push_back(
          {a,
           b,
           {{{dice.uniform(-20.0, 20.0), dice.uniform(-20.0, 20.0), dice.uniform(-3.0, 3.0)},
             dice.uniform(-7.0, 1.0),
             0.2}}});
    }
  }
  return problem;
}

/// Buildings of five maps that all look alike: every pair of maps that overlap agrees with where they lie in
/// their buildings, and half a turn about the middle of the building nearly as well.
JoinProblem look_alikes(std::size_t maps) {
  Dice dice;
  JoinProblem problem;
  std::vector<SE2> T_building_map;
  for (std::size_t i = 0; i < maps; ++i) {
    problem.maps.push_back({{{0.0, 0.0}, 8.0, 20.0}});
    T_building_map.push_back({dice.uniform(-20.0, 20.0), dice.uniform(-12.0, 12.0), dice.uniform(-3.0, 3.0)});
  }
  const SE2 half_turn{0.0, 0.0, std::numbers::pi};
  for (std::size_t a = 0; a < maps; ++a) {
    for (std::size_t b = a + 1; b < maps; ++b) {
      const bool is_one_building = a / 5 == b / 5;
      if (!is_one_building && dice.random() % 4 != 0) continue;
      const SE2 off{dice.uniform(-0.8, 0.8), dice.uniform(-0.8, 0.8), dice.uniform(-0.02, 0.02)};
      const double so = is_one_building ? dice.uniform(0.0, 5.0) : dice.uniform(-5.0, 3.0);
      problem.pairs.push_back({a,
                               b,
                               {{inverse(T_building_map[a]) * off * T_building_map[b], so, 0.2},
                                {inverse(T_building_map[a]) * half_turn * off * T_building_map[b],
                                 dice.uniform(-6.0, -1.0), 0.2}}});
    }
  }
  return problem;
}

void BM_ConsistentSetOfLookAlikes(benchmark::State& state) {
  const JoinProblem problem = look_alikes(static_cast<std::size_t>(state.range(0)));
  with_threads(1, [&] {
    for (auto _ : state) benchmark::DoNotOptimize(find_consistent_set_within(problem, 0.95, 0.05));
  });
}
BENCHMARK(BM_ConsistentSetOfLookAlikes)->Arg(25)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);

void BM_ConsistentSetOfACampus(benchmark::State& state) {
  const JoinProblem problem = campus(static_cast<std::size_t>(state.range(0)));
  with_threads(1, [&] {
    for (auto _ : state) benchmark::DoNotOptimize(find_consistent_set_within(problem, 0.95, 0.05));
  });
  state.SetComplexityN(state.range(0));
}
BENCHMARK(BM_ConsistentSetOfACampus)
    ->Arg(100)
    ->Arg(300)
    ->Arg(1000)
    ->Arg(3000)
    ->Arg(10000)
    ->Unit(benchmark::kMillisecond)
    ->Complexity();

}  // namespace
}  // namespace gridmerge::internal
