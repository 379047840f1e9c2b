// SPDX-License-Identifier: Apache-2.0
#include "similarity/wall_lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kMeetingDistance = 4;  // cells: bent maps meet no closer
constexpr int kFacingTolerance = 6;  // of kDirections

constexpr int kAngles = 128;  // normals of lines that are tried
constexpr int kAnglesPerDirection = kAngles / kDirections;
constexpr int kVotedAngles = 8;       // on either side of a point's facing
constexpr int kTakenAngles = 20;      // the same for the points that a line takes with it
constexpr float kOffsetBin = 4.0F;    // cells
constexpr float kTakenOffset = 6.0F;  // cells
constexpr std::size_t kMaxLines = 24;
constexpr int kShortestLine = 6;  // points

constexpr int kVotes = 2 * kVotedAngles + 1;  // of each point

struct MetPoint {
  float x;
  float y;
  int angle;                        // of its facing, in kAngles
  std::array<int, kVotes> votes{};  // where they are counted; LineTaker's
};

int turn_between(int a, int b, int full_turn) {
  const int turn = std::abs(a - b) % full_turn;
  return std::min(turn, full_turn - turn);
}

/// The moving map's walls that lie on walls of the fixed one which face the same side [cells, fixed grid
/// frame].
std::vector<MetPoint> find_met_walls(const LikelihoodField& fixed, const LikelihoodField& moving,
                                     const SE2& T) {
  const int turn = steps_of_turn(T.theta);
  const ManyPointsTransform T_points(T);
  std::vector<MetPoint> met;
  for (const WallPoint& wall : moving.walls) {
    const Point2 p = T_points * wall.position;
    const Place place = fixed.place_at(p);
    if (place.distance == kUnseen || place.distance > kMeetingDistance) continue;
    if (wall.facing == kNoDirection || place.facing == kNoDirection) continue;
    const std::uint8_t facing = turned(wall.facing, turn);
    const int full_turn = is_axis(facing) || is_axis(place.facing) ? kAxes : kDirections;
    if (turn_between(facing % kDirections, place.facing % kDirections, full_turn) > kFacingTolerance)
      continue;
    const int direction = is_axis(facing) ? facing - kDirections : facing;
    met.push_back({static_cast<float>(p.x), static_cast<float>(p.y), direction * kAnglesPerDirection, {}});
  }
  return met;
}

/// Takes lines off a set of points, the one with the most votes first.
class LineTaker {
 public:
  explicit LineTaker(double diagonal) : offsets_(2 * (static_cast<int>(diagonal / kOffsetBin) + 2)) {
    for (int angle = 0; angle < kAngles; ++angle) {
      const double radians = 2.0 * std::numbers::pi * angle / kAngles;
      cos_[angle] = static_cast<float>(std::cos(radians));
      sin_[angle] = static_cast<float>(std::sin(radians));
    }
  }

  /// Says where each point's votes are counted; before the first line is taken.
  void prepare(std::vector<MetPoint>& points) const {
    for (MetPoint& point : points) {
      for (int i = 0; i < kVotes; ++i) {
        const int angle = (point.angle + i - kVotedAngles + kAngles) % kAngles;
        const int offset = static_cast<int>(std::floor(distance(point, angle) / kOffsetBin)) + offsets_ / 2;
        point.votes[i] = angle * offsets_ + offset;
      }
    }
  }

  /// The number of points taken from `points`; 0 when no line is long enough.
  std::size_t take(std::vector<MetPoint>& points) {
    votes_.assign(static_cast<std::size_t>(kAngles) * offsets_, 0);
    int most = kShortestLine - 1;
    int best = -1;
    for (const MetPoint& point : points) {
      for (const int line : point.votes) {
        const int votes = ++votes_[line];
        if (votes <= most) continue;
        most = votes;
        best = line;
      }
    }
    if (best < 0) return 0;
    const int best_angle = best / offsets_;
    const int from_origin = best % offsets_ - offsets_ / 2;
    const float middle = (static_cast<float>(from_origin) + 0.5F) * kOffsetBin;
    return std::erase_if(points, [&](const MetPoint& point) {
      return turn_between(point.angle, best_angle, kAngles) <= kTakenAngles &&
             std::abs(distance(point, best_angle) - middle) <= kTakenOffset;
    });
  }

 private:
  float distance(const MetPoint& point, int angle) const {
    return cos_[angle] * point.x + sin_[angle] * point.y;
  }

  int offsets_;
  std::array<float, kAngles> cos_{};
  std::array<float, kAngles> sin_{};
  std::vector<int> votes_;  // by angle and offset
};

/// The standard deviation of the points in the direction in which it is least.
double least_spread(const std::vector<MetPoint>& points) {
  if (points.empty()) return 0.0;
  const double count = static_cast<double>(points.size());
  double x = 0.0, y = 0.0;
  for (const MetPoint& point : points) {
    x += point.x / count;
    y += point.y / count;
  }
  double xx = 0.0, yy = 0.0, xy = 0.0;
  for (const MetPoint& point : points) {
    xx += (point.x - x) * (point.x - x) / count;
    yy += (point.y - y) * (point.y - y) / count;
    xy += (point.x - x) * (point.y - y) / count;
  }
  const double smaller = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);  // eigenvalue
  return std::sqrt(std::max(0.0, smaller));
}

double count_lines(std::vector<MetPoint> points, double diagonal) {
  LineTaker taker(diagonal);
  taker.prepare(points);
  std::vector<std::size_t> lengths;
  double total = 0.0;
  while (lengths.size() < kMaxLines) {
    throw_if_cancelled();
    const std::size_t length = taker.take(points);
    if (length == 0) break;
    lengths.push_back(length);
    total += static_cast<double>(length);
  }
  if (lengths.empty()) return 0.0;
  double entropy = 0.0;
  for (const std::size_t length : lengths) {
    const double share = static_cast<double>(length) / total;
    entropy -= share * std::log(share);
  }
  return std::exp(entropy);
}

}  // namespace

WallSupport measure_wall_support(const LikelihoodField& fixed, const LikelihoodField& moving,
                                 const SE2& T_fixed_moving_cells) {
  const std::vector<MetPoint> points = find_met_walls(fixed, moving, T_fixed_moving_cells);
  return {count_lines(points, std::hypot(fixed.width, fixed.height)), static_cast<double>(points.size()),
          least_spread(points)};
}

}  // namespace gridmerge::internal
