// SPDX-License-Identifier: Apache-2.0
#include "tiny_maps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "fuzz_target.hpp"
#include "gridmerge/grid/resample.hpp"

namespace gridmerge::fuzz {

namespace {

constexpr int kMaxSide = 40;    // [cells]
constexpr int kPlaceSide = 56;  // [cells]

// Fills a rectangle of cells, as far as it lies in the grid.
void stroke(OccupancyGrid& grid, FuzzedDataProvider& bytes) {
  const int column = bytes.ConsumeIntegralInRange(-8, kPlaceSide),
            row = bytes.ConsumeIntegralInRange(-8, kPlaceSide);
  const int width = bytes.ConsumeIntegralInRange(1, kPlaceSide),
            height = bytes.ConsumeIntegralInRange(1, kPlaceSide);
  const bool outlined = bytes.ConsumeBool();
  const auto cell = static_cast<Cell>(bytes.ConsumeIntegralInRange(0, 2));
  for (int y = std::max(0, row); y < std::min(grid.height, row + height); ++y) {
    for (int x = std::max(0, column); x < std::min(grid.width, column + width); ++x) {
      const bool on_edge = x == column || y == row || x == column + width - 1 || y == row + height - 1;
      grid.at(x, y) = outlined && on_edge ? Cell::occupied : cell;
    }
  }
}

void add_strokes(OccupancyGrid& grid, int most, FuzzedDataProvider& bytes) {
  for (int count = bytes.ConsumeIntegralInRange(0, most); count > 0; --count) stroke(grid, bytes);
}

// What a map of that lattice shows of the place, which is measured in its cells.
OccupancyGrid part_of(const OccupancyGrid& place, FuzzedDataProvider& bytes) {
  constexpr std::array kResolutions{0.05, 0.1, 0.0501, 0.02, 0.3, 1.0, 1e-3, 100.0};
  constexpr std::array kOrigins{0.0, 1.0, -7.25, 123.456, 1e-300, -1e5, 1e6};
  OccupancyGrid map =
      make_grid(bytes.ConsumeIntegralInRange(1, kMaxSide), bytes.ConsumeIntegralInRange(1, kMaxSide),
                bytes.PickValueInArray(kResolutions),
                {bytes.PickValueInArray(kOrigins), bytes.PickValueInArray(kOrigins),
                 bytes.ConsumeIntegralInRange(-3, 3) * 1.0});
  const double turn = bytes.ConsumeIntegralInRange(0, 23) * std::numbers::pi / 12.0;
  const SE2 T_place_map{bytes.ConsumeIntegralInRange(0, kPlaceSide) * 1.0,
                        bytes.ConsumeIntegralInRange(0, kPlaceSide) * 1.0, turn};
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const Point2 at = T_place_map * Point2{column + 0.5, row + 0.5};
      const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
      if (place.contains(x, y)) map.at(column, row) = place.at(x, y);
    }
  }
  return map;
}

void add_probability(OccupancyGrid& map, FuzzedDataProvider& bytes) {
  const float free = bytes.PickValueInArray({0.0f, 0.1f, 0.19f}),
              occupied = bytes.PickValueInArray({0.66f, 0.9f, 1.0f});
  map.probability.resize(map.cells.size());
  std::transform(map.cells.begin(), map.cells.end(), map.probability.begin(), [&](Cell cell) {
    return cell == Cell::free       ? free
           : cell == Cell::occupied ? occupied
                                    : std::numeric_limits<float>::quiet_NaN();
  });
}

// The circle around what is known of a map.
struct Circle {
  explicit Circle(const OccupancyGrid& map) {
    const OccupancyGrid known = crop_to_known(map);
    const double half_width = 0.5 * known.width * known.resolution,
                 half_height = 0.5 * known.height * known.resolution;
    middle = known.origin * Point2{half_width, half_height};
    radius = std::hypot(half_width, half_height);
  }

  Point2 middle;
  double radius;
};

bool is_probability(double value) {
  return value >= 0.0 && value <= 1.0;
}

}  // namespace

std::vector<OccupancyGrid> draw_maps(FuzzedDataProvider& bytes, std::size_t count) {
  OccupancyGrid place = make_grid(kPlaceSide, kPlaceSide, 1.0);
  add_strokes(place, 16, bytes);
  std::vector<OccupancyGrid> maps;
  while (maps.size() < count) {
    maps.push_back(part_of(place, bytes));
    add_strokes(maps.back(), 3, bytes);
    if (bytes.ConsumeBool()) add_probability(maps.back(), bytes);
  }
  return maps;
}

void require_sound(const MatchResult& result, const OccupancyGrid& fixed, const OccupancyGrid& moving,
                   double accept_probability) {
  require(is_finite(result.T_fixed_moving) && is_probability(result.probability));
  require(is_probability(result.acceptance_index) && is_probability(result.overlap));
  require(result.agreement >= 0 && result.disagreement >= 0 && result.seconds >= 0.0);
  const bool accepted = !result.hypotheses.empty() && result.probability >= accept_probability;
  require((result.verdict == Verdict::accepted) == accepted);

  const Circle around_fixed(fixed), around_moving(moving);
  // A pose is refined by some cells after it was found.
  const double slack = 32.0 * std::max(fixed.resolution, moving.resolution);
  double before = 1.0;
  for (const Hypothesis& hypothesis : result.hypotheses) {
    const SE2& T = hypothesis.T_fixed_moving;
    require(is_finite(T) && std::abs(T.theta) <= std::numbers::pi);
    require(std::isfinite(hypothesis.score) && is_probability(hypothesis.probability));
    require(hypothesis.probability <= before);
    before = hypothesis.probability;
    for (const PoseFigure& figure : pose_figures()) require(std::isfinite(hypothesis.figures.*figure.value));
    const double scale = hypothesis.scale;
    require(std::isfinite(scale) && scale > 0.0);
    const Point2 middle = T * Point2{scale * around_moving.middle.x, scale * around_moving.middle.y};
    const double distance = std::hypot(middle.x - around_fixed.middle.x, middle.y - around_fixed.middle.y);
    require(distance <= around_fixed.radius + scale * around_moving.radius + std::max(1.0, scale) * slack);
  }
}

bool are_same(const MatchResult& a, const MatchResult& b) {
  const auto same_hypothesis = [](const Hypothesis& one, const Hypothesis& other) {
    return one.T_fixed_moving == other.T_fixed_moving && one.scale == other.scale &&
           one.score == other.score && one.probability == other.probability &&
           std::ranges::all_of(pose_figures(), [&](const PoseFigure& figure) {
             return one.figures.*figure.value == other.figures.*figure.value;
           });
  };
  return a.verdict == b.verdict && a.reason == b.reason && a.T_fixed_moving == b.T_fixed_moving &&
         a.scale == b.scale && a.probability == b.probability && a.acceptance_index == b.acceptance_index &&
         a.agreement == b.agreement && a.disagreement == b.disagreement && a.overlap == b.overlap &&
         std::ranges::equal(a.hypotheses, b.hypotheses, same_hypothesis);
}

}  // namespace gridmerge::fuzz
