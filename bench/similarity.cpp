// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "../tests/similarity/literal_similarity.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/similarity/distance_map.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "office.hpp"

#ifdef GRIDMERGE_HAVE_OPENCV
#include <opencv2/imgproc.hpp>
#endif

namespace {

using gridmerge::Cell;
using gridmerge::OccupancyGrid;
using gridmerge::SE2;

/// About the maps' centre, so that they stay on each other.
SE2 about_centre(const OccupancyGrid& map, const SE2& T) {
  const SE2 centre{0.5 * map.width * map.resolution, 0.5 * map.height * map.resolution, 0.0};
  return centre * T * inverse(centre);
}

/// A pose that is not quite right, as most that a walk tries.
SE2 pose_of(const OccupancyGrid& map) {
  return about_centre(map, {0.4, -0.3, 0.6});
}

void set_cells(benchmark::State& state, const OccupancyGrid& map) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(map.cells.size()));
}

void bm_delta(benchmark::State& state) {
  const OccupancyGrid map = gridmerge::bench::make_full_office(static_cast<int>(state.range(0)));
  gridmerge::SimilarityMeter meter(map, map);
  const SE2 pose = pose_of(map);
  for (auto _ : state) benchmark::DoNotOptimize(meter(pose).delta(7.5));
  set_cells(state, map);
}
BENCHMARK(bm_delta)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_delta_literal(benchmark::State& state) {
  const OccupancyGrid map = gridmerge::bench::make_full_office(static_cast<int>(state.range(0)));
  const SE2 pose = pose_of(map);
  for (auto _ : state) {
    benchmark::DoNotOptimize(gridmerge::literal::measure(map, gridmerge::literal::draw_on(map, map, pose)));
  }
  set_cells(state, map);
}
BENCHMARK(bm_delta_literal)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_distance_map(benchmark::State& state) {
  const OccupancyGrid map = gridmerge::bench::make_full_office(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(gridmerge::make_distance_map(map, Cell::occupied));
  set_cells(state, map);
}
BENCHMARK(bm_distance_map)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

void bm_distance_map_literal(benchmark::State& state) {
  const OccupancyGrid map = gridmerge::bench::make_full_office(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(gridmerge::literal::distance_map(map, Cell::occupied));
  set_cells(state, map);
}
BENCHMARK(bm_distance_map_literal)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);

#ifdef GRIDMERGE_HAVE_OPENCV
/// OpenCV measures distances to zeros.
void bm_distance_map_opencv(benchmark::State& state) {
  const OccupancyGrid map = gridmerge::bench::make_full_office(static_cast<int>(state.range(0)));
  cv::setNumThreads(1);
  cv::Mat image(map.height, map.width, CV_8U);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column)
      image.at<std::uint8_t>(row, column) = map.at(column, row) == Cell::occupied ? 0 : 255;
  }
  cv::Mat distance;
  for (auto _ : state) {
    cv::distanceTransform(image, distance, cv::DIST_L1, 3);
    benchmark::DoNotOptimize(distance.data);
  }
  set_cells(state, map);
}
BENCHMARK(bm_distance_map_opencv)->Arg(400)->Arg(1000)->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
