// SPDX-License-Identifier: Apache-2.0
#include "preselect/profiles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "preselect/dot_products.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2.0;
constexpr double kMinCoherence = 0.35;  // of the directions of walls: 1 if all are at right angles
constexpr int kUsualWithin = 5;         // steps on each side that say how much wall is usual
constexpr int kMaxLength = 400;         // steps of a profile; longer maps say nothing
constexpr std::size_t kPeaks = 3;       // shifts along an axis that are tried
constexpr int kPeakSpacing = 2;         // steps between them

/// A shift of one profile on another [steps], and the correlation there.
struct Shift {
  int by;
  double correlation;
};

/// Correlations of two profiles for all shifts, from -(size of `moving` - 1) on.
std::vector<std::int32_t> correlate_all(const std::vector<std::int16_t>& fixed,
                                        const std::vector<std::int16_t>& moving) {
  const int shifts = static_cast<int>(fixed.size() + moving.size()) - 1;
  std::vector<std::int32_t> sums(static_cast<std::size_t>(shifts));
  for (int i = 0; i < shifts; ++i) {
    const int by = i - (static_cast<int>(moving.size()) - 1);
    const int from = std::max(0, by);
    const int to = std::min(static_cast<int>(fixed.size()), static_cast<int>(moving.size()) + by);
    sums[i] =
        dot_product(fixed.data() + from, moving.data() + (from - by), static_cast<std::size_t>(to - from));
  }
  return sums;
}

/// The best shifts along a side, by the walls that face it and those that face away. Both begin with the
/// shift by -`zero` steps. What shifts the former by n steps shifts the latter by `mirror` - n.
std::vector<Shift> best_shifts(const std::vector<std::int32_t>& facing, const std::vector<std::int32_t>& away,
                               int zero, int mirror) {
  std::vector<double> sums(facing.begin(), facing.end());
  for (int i = 0; i < std::ssize(facing); ++i) {
    const int mirrored = 2 * zero + mirror - i;
    if (mirrored >= 0 && mirrored < std::ssize(away)) sums[i] += away[mirrored];
  }
  std::vector<Shift> kept;
  while (kept.size() < kPeaks) {
    const auto best = std::max_element(sums.begin(), sums.end());
    if (best == sums.end() || !(*best > 0.0)) break;
    const auto at = static_cast<int>(best - sums.begin());
    kept.push_back({at - zero, *best});
    for (int i = std::max(0, at - kPeakSpacing + 1);
         i < std::min(at + kPeakSpacing, static_cast<int>(sums.size())); ++i)
      sums[i] = 0.0;
  }
  return kept;
}

}  // namespace

WallProfiles make_profiles(const LikelihoodField& field) {
  WallProfiles profiles;
  double c = 0.0, s = 0.0;
  std::size_t count = 0;
  for (const WallPoint& wall : field.walls) {
    if (wall.facing == kNoDirection) continue;
    c += std::cos(4.0 * angle_of(wall.facing));
    s += std::sin(4.0 * angle_of(wall.facing));
    ++count;
  }
  if (count == 0 || std::hypot(c, s) < kMinCoherence * static_cast<double>(count)) return profiles;
  profiles.theta = std::atan2(s, c) / 4.0;
  // Whole steps, so that profiles of two maps begin whole steps apart.
  const double steps = std::ceil(std::hypot(field.width, field.height) * field.cell / kProfileStep);
  if (steps >= kMaxLength) return profiles;  // before the cast: it may be more than an int holds
  const int reach = static_cast<int>(steps), length = 2 * reach + 1;
  std::array<std::vector<double>, 4> sums;
  for (std::vector<double>& side : sums) side.assign(static_cast<std::size_t>(length), 0.0);
  int lowest = length, highest = -1;
  for (const WallPoint& wall : field.walls) {
    if (wall.facing == kNoDirection) continue;
    const double turned = angle_of(wall.facing) - profiles.theta;
    const double quarters = std::round(turned / kQuarterTurn);
    if (std::abs(turned - quarters * kQuarterTurn) > kQuarterTurn / 3.0) continue;
    for (int half = 0; half < (is_axis(wall.facing) ? 2 : 1); ++half) {
      const int side = ((static_cast<int>(quarters) + 2 * half) % 4 + 4) % 4;
      const double angle = profiles.theta + side * kQuarterTurn;
      const double along =
          field.cell * (wall.position.x * std::cos(angle) + wall.position.y * std::sin(angle));
      const double at = along / kProfileStep + reach;
      const int low = static_cast<int>(at);
      const double part = at - low;
      sums[side][low] += 1.0 - part;
      sums[side][low + 1] += part;
      lowest = std::min(lowest, low);
      highest = std::max(highest, low + 1);
    }
  }
  if (highest < lowest) return profiles;
  profiles.first = (lowest - reach) * kProfileStep;
  for (int side = 0; side < 4; ++side) {
    std::vector<double> lengths;  // square roots: one long wall is not worth many short ones
    for (int i = lowest; i <= highest; ++i) lengths.push_back(std::sqrt(sums[side][i] * field.cell));
    for (int i = 0; i < std::ssize(lengths); ++i) {
      double usual = 0.0;
      for (int k = i - kUsualWithin; k <= i + kUsualWithin; ++k)
        usual += k >= 0 && k < std::ssize(lengths) ? lengths[k] : 0.0;
      const double more = lengths[i] - usual / (2 * kUsualWithin + 1);
      profiles.sides[side].push_back(
          static_cast<std::int16_t>(std::lround(std::clamp(128.0 * more, -1000.0, 1000.0))));
    }
  }
  return profiles;
}

std::vector<ProfilePose> align_profiles(const WallProfiles& fixed, const WallProfiles& moving,
                                        std::size_t most) {
  std::vector<ProfilePose> poses;
  if (fixed.sides[0].empty() || moving.sides[0].empty()) return poses;
  const int zero = static_cast<int>(moving.sides[0].size()) - 1;
  // Opposite sides are measured in opposite directions, from beginnings that are not the same in both maps.
  const int mirror = static_cast<int>(std::lround(2.0 * (moving.first - fixed.first) / kProfileStep));
  for (int quarters = 0; quarters < 4; ++quarters) {
    // Side `a` of the moving map faces the fixed map's side `a + quarters`.
    const auto of_side = [&](int side) {
      return correlate_all(fixed.sides[side], moving.sides[(side - quarters + 4) % 4]);
    };
    const std::vector<Shift> along = best_shifts(of_side(0), of_side(2), zero, mirror);
    const std::vector<Shift> across = best_shifts(of_side(1), of_side(3), zero, mirror);
    const double turn = fixed.theta + quarters * kQuarterTurn - moving.theta;
    for (const Shift& u : along) {
      for (const Shift& v : across) {
        // Profiles begin at `first` in either map: that is in the shift.
        const double du = u.by * kProfileStep + fixed.first - moving.first;
        const double dv = v.by * kProfileStep + fixed.first - moving.first;
        const double cos = std::cos(fixed.theta), sin = std::sin(fixed.theta);
        poses.push_back({{cos * du - sin * dv, sin * du + cos * dv, normalize_angle(turn)},
                         u.correlation + v.correlation});
      }
    }
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ProfilePose& a, const ProfilePose& b) { return a.likeness > b.likeness; });
  poses.resize(std::min(most, poses.size()));
  return poses;
}

}  // namespace gridmerge::internal
