// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "../../tests/similarity/literal_similarity.hpp"
#include "gridmerge/grid/resample.hpp"
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

/// What one measurement of a pose of a `side` x `side` map on itself reads and writes, by the passes of
/// SimilarityMeter. Distances are 2 bytes, cells 1.
std::int64_t bytes_touched(const OccupancyGrid& map, const SE2& pose) {
  const double side = map.width;
  const double turned = side * (std::abs(std::cos(pose.theta)) + std::abs(std::sin(pose.theta)));
  const double cells = side * side;
  const double box = turned * turned;        // of the turned map
  const double band = side * turned;         // its columns at the fixed map's rows
  const double drawing = box + 2.0 * cells;  // cleared; read and written
  const double comparing = 2.0 * cells;
  const double moving_to_fixed = (2.0 + 1.0) * cells + cells;    // summed, counted
  const double columns = box + (2.0 + 2.0) * band + 6.0 * band;  // there and back
  const double strips = (2.0 + 2.0) * band;
  const double rows = 4.0 * 0.5 * (band + cells) + 2.0 * 0.5 * (band + cells) + cells;
  return static_cast<std::int64_t>(drawing + comparing + 2.0 * (moving_to_fixed + columns + strips + rows));
}

/// The machine's own measure: memory is copied, 1 MiB (in cache) and 256 MiB (not).
void bm_copy(benchmark::State& state) {
  const std::vector<char> from(static_cast<std::size_t>(state.range(0)), 1);
  std::vector<char> to(from.size());
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(2 * state.iterations() * state.range(0));
}
BENCHMARK(bm_copy)->Arg(1 << 20)->Arg(1 << 28)->Unit(benchmark::kMicrosecond);

void bm_delta(benchmark::State& state) {
  const OccupancyGrid map = gridmerge::bench::make_full_office(static_cast<int>(state.range(0)));
  gridmerge::SimilarityMeter meter(map, map);
  const SE2 pose = pose_of(map);
  for (auto _ : state) benchmark::DoNotOptimize(meter(pose).delta(7.5));
  set_cells(state, map);
  state.SetBytesProcessed(state.iterations() * bytes_touched(map, pose));
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
