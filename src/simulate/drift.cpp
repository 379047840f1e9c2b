// SPDX-License-Identifier: Apache-2.0
#include "simulate/drift.hpp"

#include <cmath>

namespace gridmerge::internal {

namespace {

// With a drift of 1:
constexpr double kBias = 0.0022;     // standard deviation of the heading's error [rad/m]...
constexpr double kBiasWay = 8.0;     // ...and the way along which it lasts [m]
constexpr double kTurnError = 0.01;  // of what the robot turns
constexpr double kScaleError = 0.01;
constexpr double kPull = 0.2;       // of the way back to what it remembers, at every scan
constexpr double kPlace = 1.5;      // side of a place [m]
constexpr double kForgetful = 6.0;  // way after which a place counts as visited again [m]
// What scan matching leaves, with no drift and with a drift of 1.
constexpr double kJitter = 0.008, kMoreJitter = 0.012;          // [m]
constexpr double kTurnJitter = 0.002, kMoreTurnJitter = 0.003;  // [rad]

long long place_of(const SE2& pose) {
  const auto x = static_cast<long long>(std::floor(pose.x / kPlace));
  const auto y = static_cast<long long>(std::floor(pose.y / kPlace));
  return (x << 32) ^ (y & 0xffffffff);
}

}  // namespace

DriftingPose::DriftingPose(double drift, Random random)
    : drift_(drift), random_(random), scale_(random_.normal(kScaleError * drift)) {}

void DriftingPose::wander(const SE2& from, const SE2& to) {
  const double dx = to.x - from.x, dy = to.y - from.y;
  const double step = std::hypot(dx, dy);
  const double turn = normalize_angle(to.theta - from.theta);
  bias_ += -bias_ * step / kBiasWay + random_.normal(drift_ * kBias * std::sqrt(2.0 * step / kBiasWay));
  offset_.theta += bias_ * step + random_.normal(drift_ * kTurnError * std::abs(turn));
  const double c = std::cos(offset_.theta), s = std::sin(offset_.theta);
  offset_.x += (1.0 + scale_) * (c * dx - s * dy) - dx;
  offset_.y += (1.0 + scale_) * (s * dx + c * dy) - dy;
  way_ += step;
}

void DriftingPose::recall(const SE2& place) {
  const auto [found, is_new] = places_.try_emplace(place_of(place), Remembered{offset_, way_});
  const Remembered& then = found->second;
  if (is_new || way_ - then.way < kForgetful) return;
  offset_.x += kPull * (then.offset.x - offset_.x);
  offset_.y += kPull * (then.offset.y - offset_.y);
  offset_.theta += kPull * (then.offset.theta - offset_.theta);
}

SE2 DriftingPose::follow(const SE2& T_building_robot) {
  if (!last_) {
    last_ = T_building_robot;
    return T_building_robot;
  }
  wander(*last_, T_building_robot);
  recall(T_building_robot);
  last_ = T_building_robot;
  const double jitter = kJitter + drift_ * kMoreJitter;
  return {T_building_robot.x + offset_.x + random_.normal(jitter),
          T_building_robot.y + offset_.y + random_.normal(jitter),
          normalize_angle(T_building_robot.theta + offset_.theta +
                          random_.normal(kTurnJitter + drift_ * kMoreTurnJitter))};
}

}  // namespace gridmerge::internal
