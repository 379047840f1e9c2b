// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <stdexcept>

#include "gridmerge/match/match_result.hpp"
#include "match/bytes.hpp"

namespace gridmerge::internal {

/// Throws std::invalid_argument for what no match can have found.
inline void check_pose(const SE2& T, double probability) {
  const bool is_sound = is_finite(T) && probability >= 0.0 && probability <= 1.0;
  if (!is_sound) throw std::invalid_argument("holds a pose that no match has");
}

inline void write_pair_pose(const PairPose& pose, ByteWriter& writer) {
  writer.pose(pose.T_fixed_moving);
  writer.number(pose.probability);
  writer.number(pose.acceptance_index);
  writer.whole(static_cast<std::uint64_t>(pose.agreement));
  writer.whole(static_cast<std::uint64_t>(pose.disagreement));
  writer.number(pose.overlap);
}

inline void read_pair_pose(ByteReader& reader, PairPose& pose) {
  pose.T_fixed_moving = reader.pose();
  pose.probability = reader.number();
  pose.acceptance_index = reader.number();
  pose.agreement = static_cast<std::int64_t>(reader.whole());
  pose.disagreement = static_cast<std::int64_t>(reader.whole());
  pose.overlap = reader.number();
  check_pose(pose.T_fixed_moving, pose.probability);
  if (!(std::isfinite(pose.acceptance_index) && pose.agreement >= 0 && pose.disagreement >= 0 &&
        pose.overlap >= 0.0 && std::isfinite(pose.overlap)))
    throw std::invalid_argument("holds a comparison that no match has");
}

}  // namespace gridmerge::internal
