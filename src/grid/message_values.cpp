// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/message_values.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace gridmerge {

namespace {

constexpr int kAllOccupied = 100;

bool is_percentage(int value) {
  return value >= 0 && value <= kAllOccupied;
}

// What one of 256 values means: values are few, cells many.
template <typename Meaning, typename Make>
std::array<Meaning, 256> meanings(const Make& make) {
  std::array<Meaning, 256> table;
  for (int value = -128; value < 128; ++value) table[static_cast<std::uint8_t>(value)] = make(value);
  return table;
}

}  // namespace

// map_saver compares percentages with `<=` and `>=`; so must we, or 0 with a threshold of 0 would get lost.
Cell cell_of_percentage(int percentage, const OccupancyThresholds& thresholds) {
  if (!is_percentage(percentage)) return Cell::unknown;
  const double occupancy = percentage / 100.0;
  if (occupancy >= thresholds.occupied) return Cell::occupied;
  return occupancy <= thresholds.free ? Cell::free : Cell::unknown;
}

float probability_of_percentage(int percentage) {
  return is_percentage(percentage) ? static_cast<float>(percentage / 100.0)
                                   : std::numeric_limits<float>::quiet_NaN();
}

OccupancyGrid grid_of_percentages(int width, int height, double resolution, const SE2& origin,
                                  std::span<const std::int8_t> values) {
  OccupancyGrid grid;
  grid.width = width;
  grid.height = height;
  grid.resolution = resolution;
  grid.origin = {origin.x, origin.y, normalize_angle(origin.theta)};
  const auto cells = meanings<Cell>([](int value) { return cell_of_percentage(value); });
  grid.cells.resize(values.size());
  std::ranges::transform(values, grid.cells.begin(),
                         [&](std::int8_t value) { return cells[static_cast<std::uint8_t>(value)]; });
  const auto is_plain = [](std::int8_t value) {
    return value == 0 || value == kAllOccupied || !is_percentage(value);
  };
  if (!std::ranges::all_of(values, is_plain)) {
    const auto probabilities = meanings<float>(probability_of_percentage);
    grid.probability.resize(values.size());
    std::ranges::transform(values, grid.probability.begin(), [&](std::int8_t value) {
      return probabilities[static_cast<std::uint8_t>(value)];
    });
  }
  validate(grid);
  return grid;
}

double decimal_of(float value) {
  if (!std::isfinite(value)) return value;
  std::array<char, 32> digits;  // the longest shortest form of a float has 15 characters
  const auto written = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  double decimal = 0.0;
  std::from_chars(digits.data(), written.ptr, decimal);
  return decimal;
}

Yaw yaw_of(const Quaternion& rotation) {
  constexpr double kUnit = 1e-3;
  constexpr double kMinUpright = 1.0 - 4e-7;  // cosine of a twentieth of a degree
  const auto [x, y, z, w] = rotation;
  if (x == 0.0 && y == 0.0 && z == 0.0 && w == 0.0) return {Rotation::missing, 0.0};
  const double squared = x * x + y * y + z * z + w * w;  // infinite where a part is very large
  if (!(std::abs(std::sqrt(squared) - 1.0) <= kUnit)) return {Rotation::not_unit, 0.0};
  if (1.0 - 2.0 * (x * x + y * y) / squared < kMinUpright) return {Rotation::tilted, 0.0};
  return {Rotation::about_z, normalize_angle(2.0 * std::atan2(z, w))};
}

}  // namespace gridmerge
