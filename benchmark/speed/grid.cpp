// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/resample.hpp"
#include "office.hpp"

namespace {

using gridmerge::OccupancyGrid;

void report_cells(benchmark::State& state, const OccupancyGrid& grid) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(grid.cells.size()));
}

void bm_crop_to_known(benchmark::State& state) {
  const OccupancyGrid grid = gridmerge::bench::make_office(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(gridmerge::crop_to_known(grid));
  report_cells(state, grid);
}
BENCHMARK(bm_crop_to_known)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_downsample(benchmark::State& state) {
  const OccupancyGrid grid = gridmerge::bench::make_office(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(gridmerge::downsample(grid, 4));
  report_cells(state, grid);
}
BENCHMARK(bm_downsample)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_transform_grid(benchmark::State& state) {
  const OccupancyGrid grid = gridmerge::bench::make_office(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(gridmerge::transform_grid(grid, {1.0, -2.0, 0.5}, 0.05));
  report_cells(state, grid);
}
BENCHMARK(bm_transform_grid)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
