// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match.hpp"

#include <benchmark/benchmark.h>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "office.hpp"
#include "search/exhaustive.hpp"
#include "similarity/evidence.hpp"
#include "similarity/likelihood_field.hpp"

namespace {

using gridmerge::OccupancyGrid;
using gridmerge::internal::LikelihoodField;

/// One office twice, the second time turned and shifted.
struct Pair {
  explicit Pair(int side)
      : fixed(gridmerge::bench::make_office(side)),
        moving(gridmerge::transform_grid(fixed, {3.0, -1.0, 0.7}, fixed.resolution)) {}

  OccupancyGrid fixed;
  OccupancyGrid moving;
};

void bm_make_likelihood_field(benchmark::State& state) {
  const OccupancyGrid grid = gridmerge::bench::make_office(static_cast<int>(state.range(0)));
  for (auto _ : state)
    benchmark::DoNotOptimize(gridmerge::internal::make_likelihood_field(grid, grid.resolution));
}
BENCHMARK(bm_make_likelihood_field)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_wall_evidence(benchmark::State& state) {
  const Pair pair(400);
  const LikelihoodField fixed = gridmerge::internal::make_likelihood_field(pair.fixed, pair.fixed.resolution);
  const LikelihoodField moving =
      gridmerge::internal::make_likelihood_field(pair.moving, pair.moving.resolution);
  const gridmerge::internal::WallEvidence evidence(fixed, moving, static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(evidence({5.0, 3.0, 0.3}));
}
BENCHMARK(bm_wall_evidence)->Arg(150)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_search_all_poses(benchmark::State& state) {
  const Pair pair(static_cast<int>(state.range(0)));
  const LikelihoodField fixed = gridmerge::internal::make_likelihood_field(pair.fixed, pair.fixed.resolution);
  const LikelihoodField moving =
      gridmerge::internal::make_likelihood_field(pair.moving, pair.moving.resolution);
  for (auto _ : state) {
    gridmerge::with_threads(
        1, [&] { benchmark::DoNotOptimize(gridmerge::internal::search_all_poses(fixed, moving)); });
  }
}
BENCHMARK(bm_search_all_poses)->Arg(400)->Arg(800)->Unit(benchmark::kMillisecond);

void bm_match(benchmark::State& state) {
  const Pair pair(static_cast<int>(state.range(0)));
  gridmerge::MatchOptions options;
  options.threads = 1;
  for (auto _ : state) benchmark::DoNotOptimize(gridmerge::match(pair.fixed, pair.moving, options));
}
BENCHMARK(bm_match)->Arg(400)->Arg(1000)->Arg(4000)->Unit(benchmark::kMillisecond);

}  // namespace
