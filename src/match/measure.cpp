// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/measure.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "match/refine_pose.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// Nothing can be said of a map that touches no other one: all its figures would be those of the empty place
/// where it lies.
void check_contact(std::span<const PlacedMap> maps) {
  for (const PlacedMap& map : maps) validate(map);
  for (std::size_t i = 1; i < maps.size(); ++i) {
    bool touches = false;
    for (std::size_t j = 0; j < maps.size() && !touches; ++j) {
      touches = j != i && lie_on_each_other(*maps[j].map, *maps[i].map,
                                            inverse(maps[j].T_output_map) * maps[i].T_output_map);
    }
    if (touches) continue;
    std::string message = "the pose of the moving map";
    if (maps.size() > 2) message += ' ' + std::to_string(i);
    throw std::invalid_argument(message + " puts the maps apart: no cell of theirs lies on another's");
  }
}

PoseMeasure measure(const OccupancyGrid& fixed, const PreparedMap& prepared_fixed, const PlacedMap& moving) {
  SimilarityMeter meter(fixed, *moving.map);
  PoseMeasure measure;
  measure.T_fixed_moving = moving.T_output_map;
  measure.cells = static_cast<std::int64_t>(fixed.cells.size());
  measure.similarity = meter(moving.T_output_map);
  measure.common = meter.count_common(moving.T_output_map);
  measure.engine = judge_pose(prepared_fixed, PreparedMap(*moving.map), moving.T_output_map);
  return measure;
}

}  // namespace

JointMeasure measure_maps(const OccupancyGrid& fixed, std::span<const PlacedMap> moving, int threads) {
  if (moving.empty()) throw std::invalid_argument("there is no map to lay on the fixed one");
  if (threads < 0) throw std::invalid_argument("threads must not be negative");
  std::vector<PlacedMap> all{{&fixed, {}}};
  all.insert(all.end(), moving.begin(), moving.end());
  check_contact(all);
  JointMeasure joint;
  joint.cells = static_cast<std::int64_t>(fixed.cells.size());
  with_threads(threads, [&] {
    const PreparedMap prepared(fixed);
    for (const PlacedMap& map : moving) joint.pairs.push_back(measure(fixed, prepared, map));
  });
  joint.omega = moving.size() == 1 ? joint.pairs.front().similarity.omega : count_equal_cells(fixed, all);
  return joint;
}

PoseMeasure measure_pose(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_fixed_moving,
                         int threads) {
  const PlacedMap placed{&moving, T_fixed_moving};
  return measure_maps(fixed, {&placed, 1}, threads).pairs.front();
}

}  // namespace gridmerge
