// SPDX-License-Identifier: Apache-2.0
#include "preselect/tally.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "grid/multiversion.hpp"

namespace gridmerge::internal {

namespace {

/// For the facing of a wall: one bit for each facing that is, or may be, the same.
using AlikeTable = std::array<std::uint64_t, kFacingCodes>;

constexpr AlikeTable make_alike() {
  AlikeTable table{};
  for (std::uint8_t facing = 0; facing < kFacingCodes; ++facing) {
    for (std::uint8_t met = 0; met < kFacingCodes; ++met) {
      if (facing == kNoDirection || met == kNoDirection || steps_between(facing, met) <= kMostTurned)
        table[facing] |= std::uint64_t{1} << met;
    }
  }
  return table;
}

/// For a turn by so many steps and a facing: the facing after it.
using TurnedTable = std::array<std::array<std::uint8_t, kFacingCodes>, kDirections>;

constexpr TurnedTable make_turned() {
  TurnedTable table{};
  for (int steps = 0; steps < kDirections; ++steps) {
    for (std::uint8_t facing = 0; facing < kFacingCodes; ++facing)
      table[steps][facing] = turned(facing, steps);
  }
  return table;
}

constexpr AlikeTable kAlike = make_alike();
constexpr TurnedTable kTurned = make_turned();

struct Counts {
  int seen = 0, met = 0, open = 0;
};

/// Counts the walls of `on`, every `step`-th, by what they meet in `at`. First where the walls lie, for many
/// at once; then what they meet, without a branch that depends on a wall: that is as good as random, and a
/// wrong guess costs more than all else of a wall.
GRIDMERGE_MULTIVERSION Counts count_walls(const Signature& at, const Signature& on, const GridPose& T_at_on,
                                          std::size_t step) {
  constexpr std::size_t kBlock = 64;
  const GridPose T = T_at_on;  // copies, which nothing that is written here can change
  const Place* const places = at.places.data();
  const double cell = at.cell, width = at.width, height = at.height;
  const int columns = at.width, open_from = at.open_from, met_within = at.met_within;
  const auto& facing = kTurned[steps_of_turn(T.theta)];
  std::array<std::int32_t, kBlock> index;
  std::array<std::uint8_t, kBlock> is_inside;
  Counts counts;
  const std::size_t total = (on.walls.size() + step - 1) / step;
  for (std::size_t first = 0; first < total; first += kBlock) {
    const std::size_t count = std::min(kBlock, total - first);
    const SampledWall* const walls = on.walls.data() + first * step;
    for (std::size_t i = 0; i < count; ++i) {
      const Point2 point = T * walls[i * step].position;
      const double x = point.x / cell, y = point.y / cell;
      is_inside[i] = (x >= 0.0) & (y >= 0.0) & (x < width) & (y < height);
      index[i] = static_cast<std::int32_t>(std::min(std::max(0.0, y), height - 1.0)) * columns +
                 static_cast<std::int32_t>(std::min(std::max(0.0, x), width - 1.0));
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Place place = places[index[i]];
      const bool is_seen = (is_inside[i] != 0) & (place.distance != kUnseen);
      const bool is_open = is_seen & (place.distance >= open_from);
      const bool is_met = is_seen & !is_open & (place.distance <= met_within);
      const bool is_alike = (kAlike[facing[walls[i * step].facing]] >> place.facing & 1) != 0;
      counts.seen += is_seen;
      counts.open += is_open;
      counts.met += is_met & is_alike;
    }
  }
  return counts;
}

Tally tally(const Signature& at, const Signature& on, const GridPose& T_at_on, std::size_t step) {
  if (on.walls.empty() || at.places.empty()) return {};
  const Counts counts = count_walls(at, on, T_at_on, step);
  const double metres = on.wall_length / static_cast<double>(on.walls.size()) * static_cast<double>(step);
  return {counts.seen * metres, counts.met * metres, counts.open * metres,
          counts.seen * metres * at.chance_of_meeting};
}

}  // namespace

Tally tally_both(const Signature& fixed, const Signature& moving, const GridPose& T_fixed_moving,
                 std::size_t step) {
  const Tally a = tally(fixed, moving, T_fixed_moving, step),
              b = tally(moving, fixed, T_fixed_moving.inverted(), step);
  return {0.5 * (a.seen + b.seen), 0.5 * (a.met + b.met), 0.5 * (a.open + b.open),
          0.5 * (a.chance + b.chance)};
}

}  // namespace gridmerge::internal
