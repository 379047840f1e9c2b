// SPDX-License-Identifier: Apache-2.0
#include "merge/map_extent.hpp"

#include <algorithm>

#include "grid/displacement.hpp"

namespace gridmerge::internal {

namespace {

/// The least is ten cells of the usual size: straight maps that lie right are nearer.
constexpr double kMinTolerance = 0.5;  // [m]
/// Bent maps close cycles of three within 0.029 of the larger map's side in 95 of 100 cases. Of 368 cycles of
/// hand-held maps, with sides of 24 to 78 m, all but two close within this share.
constexpr double kToleranceShare = 0.045;

}  // namespace

double agreement_tolerance(const MapExtent& a, const MapExtent& b) {
  return std::max(kMinTolerance, kToleranceShare * std::max(a.side, b.side));
}

double displacement(const MapExtent& moving, const SE2& a, const SE2& b) {
  return displacement(moving.centre, moving.radius, a, b);
}

double difference(const MapExtent& a, const MapExtent& b, const SE2& T_a_b, const SE2& T_a_b_other) {
  return std::min(displacement(b, T_a_b, T_a_b_other), displacement(a, inverse(T_a_b), inverse(T_a_b_other)));
}

}  // namespace gridmerge::internal
